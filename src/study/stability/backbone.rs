//! Backbone curve: at each value of a number of the case, the cycle at the resonance of the drive.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::cycles::{CycleMember, CyclePath, PathPoint, PathRequest, point};
use crate::case::parameter::{self, Parameter};
use crate::case::schema::Case;
use crate::error::{Error, Result};
use crate::onestep::step_map::StepError;
use crate::run::modes::{self, ModeOptions};
use crate::run::periodic::PeriodicScene;
use crate::run::periodic::family::{CycleFamily, FamilyMember, FamilyState};
use crate::run::periodic::parameter_scale::ParameterScale;
use crate::run::periodic::resonance::PhaseCondition;
use crate::run::stop::{INTERRUPTED, StopFlag};
use crate::study::evaluations::Evaluations;

/// Number of modes among which the one nearest to the frequency of the case is chosen.
const MODES: usize = 8;
/// Damping ratio below which a mode has a resonance.
const DAMPED: f64 = 0.2;
/// Largest distance of the first resonance from the mode, as the logarithm of the ratio of frequencies.
const FARTHEST: f64 = 0.1;
/// Smallest part of the distance of two values in which a resonance is followed.
const SHORTEST: f64 = 1.0 / 64.0;

/// First resonance of a backbone, with the condition that defines it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct BackboneStart {
    condition: PhaseCondition,
    point: PathPoint,
}

/// Follows the resonance of a drive over values of a number. At each value the frequency at `pointer` is the one at which drive and motion
/// are a quarter period apart [E100]; at the first value it is near the mode nearest to the frequency of the case. Values that are not
/// reached are missing, with the reason; those after them, too.
///
/// # Errors
/// There is no frequency at the pointer, its drive has a phase, or the case has no such mode; those of
/// [`along`](super::along).
pub fn backbone(
    request: &PathRequest,
    pointer: &str,
    evaluations: &Evaluations,
    stop: &StopFlag,
    report: &dyn Fn(usize),
) -> Result<CyclePath> {
    let mut found = CyclePath::begin(request)?;
    let Some((value, case)) = request.cases.first() else {
        return Ok(found);
    };
    found.resonance = Some(pointer.into());
    if request.pointer == pointer {
        let what = "--sweep varies the same number; sweep an amplitude";
        return Err(Error::Usage(format!("--resonance {pointer}: {what}")));
    }
    let drive = zero_phase(case, pointer)?;
    let linear = mode(case, drive.value)?;
    let near = parameter::with(case, &[(pointer, linear)])?;
    let reference = PeriodicScene::new(&near, None).map_err(|error| match PeriodicScene::new(case, None) {
        // the frequency of the mode and those of other drives have no common period
        Ok(_) => Error::Usage(format!(
            "--resonance {pointer}: another signal is periodic, too; only one may be"
        )),
        Err(_) => error,
    })?;
    let reference = reference.heeding(stop);
    reference.held(&case.name)?;
    found.warnings.extend(reference.trapped.clone());
    let follower = BackboneFollower {
        request,
        pointer,
        scale: ParameterScale {
            from: linear,
            step: 1.0,
            logarithmic: true,
        },
        reference,
    };
    let first = evaluations.try_get(&("resonance", 0), &|| stop.raised(), || follower.start(*value, case))?;
    let start = match first {
        Ok(start) => start,
        Err(why) => {
            found.missing.push((*value, why));
            let others = request.cases[1..].iter();
            found
                .missing
                .extend(others.map(|(value, _)| (*value, "the first value has no resonance".into())));
            return Ok(found);
        }
    };
    let mut open = vec![];
    add(&mut found, &mut open, *value, &start.point);
    report(1);
    // coordinates along the values, counted from the first, with the states there
    let mut before: Vec<(f64, FamilyState)> = vec![(0.0, start.point.state)];
    let values: Vec<f64> = request.cases.iter().map(|(value, _)| *value).collect();
    let scale = ParameterScale::new(&values, request.logarithmic);
    for (k, (value, _)) in request.cases.iter().enumerate().skip(1) {
        let mut step = 1.0;
        let mut lost = None;
        while lost.is_none() {
            let Some((at, _)) = before.last() else { break };
            let next = (k as f64).min(at + step);
            let next = if k as f64 - next < 1e-9 { k as f64 } else { next };
            let number = if next == k as f64 { *value } else { scale.value(next) };
            let key = ("resonance", next.to_bits());
            let compute = || follower.step(&start.condition, &before, (next, number));
            match evaluations.try_get(&key, &|| stop.raised(), compute)? {
                Ok(there) => {
                    before.push((next, there.state.clone()));
                    if next == k as f64 {
                        add(&mut found, &mut open, *value, &there);
                        break;
                    }
                }
                Err(_) if step > SHORTEST && !stop.raised() => step *= 0.5,
                Err(why) => lost = Some(why),
            }
        }
        report(k + 1);
        if let Some(why) = lost {
            let why = if stop.raised() { INTERRUPTED.into() } else { why };
            let rest = request.cases[k..].iter().map(|(value, _)| *value);
            found.missing.extend(rest.zip([why].into_iter().cycle()));
            break;
        }
    }
    found.warn_open(&open);
    Ok(found)
}

/// Adds a member, or the reason why it is missing.
fn add(found: &mut CyclePath, open: &mut Vec<(f64, String)>, value: f64, there: &PathPoint) {
    open.extend(there.open.clone().map(|warning| (value, warning)));
    match &there.found {
        Ok(member) => found.members.push(CycleMember {
            value,
            ..member.clone()
        }),
        Err(why) => found.missing.push((value, why.clone())),
    }
}

/// Parameter of the drive's frequency.
fn zero_phase(case: &Case, pointer: &str) -> Result<Parameter> {
    let usage = |what: &str| Err(Error::Usage(format!("--resonance {pointer}: {what}")));
    let Some(sine) = pointer.strip_suffix("/frequency_hz") else {
        return usage("expected the frequency of the drive, such as /loads/0/force_x_n/signal/sine/frequency_hz");
    };
    if sine.contains("/slope_rad") {
        return usage(
            "the drive turns an end, so that the motion relative to it is not defined; move the end, or use a load",
        );
    }
    let found = Parameter::find_as("--resonance", case, pointer)?;
    let phase = Parameter::number("--resonance", case, &format!("{sine}/phase_rad"))?;
    match phase.value == 0.0 {
        true => Ok(found),
        false => usage("the drive has a phase; set its phase_rad to 0"),
    }
}

/// Frequency without damping of the mode nearest to a frequency [Hz].
fn mode(case: &Case, near_hz: f64) -> Result<f64> {
    let options = ModeOptions {
        count: MODES,
        near_hz,
        limits: false,
    };
    let found = modes::modes(case, &options)?;
    // modes of the fluid hardly oscillate
    let lightly = |mode: &&modes::Mode| mode.kind.swings() && -mode.s.re < DAMPED * mode.s.norm();
    let all = found.modes.iter().filter(lightly);
    let frequencies = all.map(|mode| mode.s.norm() / std::f64::consts::TAU);
    let nearest = frequencies.min_by(|a, b| (a - near_hz).abs().total_cmp(&(b - near_hz).abs()));
    nearest.ok_or_else(|| {
        Error::Usage(format!(
            "--resonance: {} has no mode with a damping ratio below {DAMPED} near {near_hz} Hz; `slcbeam modes` lists them",
            case.name
        ))
    })
}

/// Follower of a resonance.
struct BackboneFollower<'a> {
    request: &'a PathRequest<'a>,
    /// JSON pointer of the drive's frequency.
    pointer: &'a str,
    /// Frequencies over the coordinate, which is 0 at the mode of the first value.
    scale: ParameterScale,
    /// Scene at the first value and the frequency of its mode.
    reference: PeriodicScene,
}

impl BackboneFollower<'_> {
    /// Cycle at the resonance for a value of the number, by a search in the family over the frequency.
    fn find(
        &self,
        (value, case): (f64, &Case),
        search: &dyn Fn(&CycleFamily) -> std::result::Result<FamilyMember, StepError>,
    ) -> Result<std::result::Result<PathPoint, String>> {
        let begin = Instant::now();
        let family = CycleFamily {
            reference: self.reference.clone(),
            case_at: &|frequency| parameter::with(case, &[(self.pointer, frequency)]),
            scale: self.scale,
        };
        let member = match search(&family) {
            Ok(member) => member,
            Err(error) => return Ok(Err(error.what)),
        };
        let frequency = self.scale.value(member.state.coordinate);
        let mut there = point(value, member, begin)?;
        if let Ok(member) = &mut there.found {
            member.resonance_hz = Some(frequency);
        }
        Ok(Ok(there))
    }

    /// Resonance at the first value, from the cycle at the frequency of the mode.
    fn start(&self, value: f64, case: &Case) -> Result<std::result::Result<BackboneStart, String>> {
        let found = match PhaseCondition::from_scene(&self.reference) {
            Ok((condition, begin)) => {
                let found = self.find((value, case), &|family| condition.approach(family, &begin))?;
                found.map(|point| (condition, point))
            }
            Err(error) => Err(error.what),
        };
        Ok(match found {
            Ok((_, point)) if point.state.coordinate.abs() > FARTHEST => Err(format!(
                "the nearest resonance is at {:.4} Hz, far from the mode at {:.4} Hz. Choose a first value with a smaller motion",
                self.scale.value(point.state.coordinate),
                self.scale.from
            )),
            Ok((condition, point)) => Ok(BackboneStart { condition, point }),
            Err(why) => Err(format!(
                "{why}. The search begins at the mode at {:.4} Hz: choose a first value with a smaller motion",
                self.scale.from
            )),
        })
    }

    /// Resonance at a further value, predicted from those before.
    fn step(
        &self,
        condition: &PhaseCondition,
        before: &[(f64, FamilyState)],
        (coordinate, value): (f64, f64),
    ) -> Result<std::result::Result<PathPoint, String>> {
        let case = (self.request.case_at)(value)?;
        let near = match before {
            [] => return Ok(Err("no resonance before".into())),
            [(_, only)] => only.clone(),
            [.., (from, first), (to, last)] => {
                let ahead = |now: f64, old: f64| now + (coordinate - to) / (to - from) * (now - old);
                FamilyState {
                    coordinate: ahead(last.coordinate, first.coordinate),
                    y: last
                        .y
                        .iter()
                        .zip(&first.y)
                        .map(|(now, old)| ahead(*now, *old))
                        .collect(),
                    ..last.clone()
                }
            }
        };
        self.find((value, &case), &|family| condition.meet(family, &near))
    }
}
