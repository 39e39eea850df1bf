//! Follows a branch of cycles by pseudo-arclength: predictor, acceptance, step size, special points, requested values.

use std::cell::Cell;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::cycles::{CycleMember, MemberKind, PathPoint, multipliers, point};
use super::special_points::{self, JUMP, LOCATED, SHARE, SpecialKind, SpecialPoint, TRIES};
use crate::error::Result;
use crate::numerics::kernels::dot;
use crate::onestep::step_map::StepError;
use crate::run::floquet::Floquet;
use crate::run::periodic::family::{CycleFamily, FamilyMember, FamilyState};
use crate::run::stop::StopFlag;
use crate::study::evaluations::Evaluations;

/// Smallest cosine of the angle between a step and the tangents at both its ends. A step to another branch has a smaller one.
const STRAIGHT: f64 = 0.9;
/// Cosine above which the next step is longer.
const VERY_STRAIGHT: f64 = 0.975;
/// Largest step; 1 is the distance of requested values, or a change of state by the amplitude of the cycle.
const LONGEST: f64 = 3.0;
/// Smallest step.
const SHORTEST: f64 = 1e-4;
/// Factors of the step after a rejected and after a nearly straight one.
const FACTORS: [f64; 2] = [0.5, 1.6];
/// Number of halvings of a step in the search for a requested value within it.
const HALVINGS: usize = 8;
/// Largest number of steps of a branch, and of steps for each requested value.
const MOST_STEPS: [usize; 2] = [400, 20];

/// Follower of one branch.
pub(super) struct BranchFollower<'a> {
    pub family: CycleFamily<'a>,
    pub values: &'a [f64],
    pub evaluations: Evaluations,
    pub stop: &'a StopFlag,
}

/// A branch after its first cycle.
pub(super) struct FollowedBranch {
    pub members: Vec<CycleMember>,
    /// Values with a warning that energies do not add up.
    pub open: Vec<(f64, String)>,
    pub missing: Vec<(f64, String)>,
    /// Last state.
    pub last: Vec<f64>,
    /// True if the branch left the range of values, so that a further cycle is on another branch.
    pub ended: bool,
}

/// Result of one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum StepOutcome {
    Accepted(Box<PathPoint>),
    Rejected(String),
}

/// Target of a step.
#[derive(Clone, Copy)]
enum Aim {
    /// The requested value of this index.
    Value(usize),
    /// A distance along the tangent.
    Distance(f64),
}

/// State with its multipliers.
type Located = (FamilyState, Floquet);

impl BranchFollower<'_> {
    /// Follows a branch from its first cycle until it leaves the range of values. Marks the requested values that it reaches.
    ///
    /// # Errors
    /// A period cannot be recorded.
    pub fn follow(&self, first: Located, finished: &mut [bool], report: &dyn Fn(usize)) -> Result<FollowedBranch> {
        let mut branch = FollowedBranch {
            members: vec![],
            open: vec![],
            missing: vec![],
            last: first.0.y.clone(),
            ended: false,
        };
        let counter = Cell::new(0);
        let (mut here, mut step) = (first.clone(), LONGEST);
        for _ in 0..MOST_STEPS[0] + MOST_STEPS[1] * self.values.len() {
            let direction = here.0.direction(here.0.size);
            let slope = direction[direction.len() - 1];
            let Some(target) = self.next(here.0.coordinate, slope) else {
                branch.ended = true;
                return Ok(branch);
            };
            let reach = (target as f64 - here.0.coordinate) / slope;
            let aim = if reach <= 1.2 * step {
                Aim::Value(target)
            } else {
                Aim::Distance(step)
            };
            if self.stop.raised() {
                return Ok(branch);
            }
            let outcome = self.step(&here.0, aim, &counter)?;
            let StepOutcome::Accepted(there) = outcome else {
                step = FACTORS[0] * step.min(reach);
                if step < SHORTEST {
                    break;
                }
                continue;
            };
            if there.found.is_err() && matches!(aim, Aim::Distance(_)) {
                // beyond the limits of the model, as at the resonance of an undamped beam
                break;
            }
            let straight = self.straightness(&here.0, &there.state);
            if straight > VERY_STRAIGHT {
                step = (FACTORS[1] * step).min(LONGEST);
            }
            let Some(next) = self.add(&here, *there, aim, &mut branch, finished, &counter)? else {
                branch.ended = true;
                return Ok(branch);
            };
            report(finished.iter().filter(|done| **done).count());
            if self.closed(&first.0, &next.0) {
                branch.ended = true;
                return Ok(branch);
            }
            here = next;
        }
        Ok(branch)
    }

    /// Index of the next requested value along a branch.
    fn next(&self, coordinate: f64, slope: f64) -> Option<usize> {
        let ahead = match slope > 0.0 {
            true => coordinate.floor() + 1.0,
            false => coordinate.ceil() - 1.0,
        };
        (ahead >= 0.0 && ahead < self.values.len() as f64).then_some(ahead as usize)
    }

    /// True if a state is the first one of the branch again.
    fn closed(&self, first: &FamilyState, now: &FamilyState) -> bool {
        let chord = self.family.chord(first, now, first.size);
        dot(&chord, &chord).sqrt() < 1e-3
    }

    /// Smallest cosine of the angle between a step and the tangents at its ends, in the unit of the smaller cycle.
    fn straightness(&self, a: &FamilyState, b: &FamilyState) -> f64 {
        let size = a.size.min(b.size);
        let chord = self.family.chord(a, b, size);
        let length = dot(&chord, &chord).sqrt();
        let cosine = |state: &FamilyState| dot(&state.direction(size), &chord) / length;
        cosine(a).min(cosine(b))
    }

    /// A step from a state: accepted if it is nearly straight.
    fn step(&self, here: &FamilyState, aim: Aim, counter: &Cell<usize>) -> Result<StepOutcome> {
        counter.set(counter.get() + 1);
        let compute = || {
            let begin = Instant::now();
            let direction = here.direction(here.size);
            let slope = direction[direction.len() - 1];
            let found = match aim {
                Aim::Value(k) => {
                    let predicted = here.shifted(&direction, (k as f64 - here.coordinate) / slope);
                    let value = self.values[k];
                    self.family
                        .at_value((k as f64, value), &predicted, here)
                        .map(|found| (value, found))
                }
                Aim::Distance(step) => {
                    let found = self.family.across(&here.shifted(&direction, step), &direction);
                    found.map(|found| (self.family.scale.value(found.state.coordinate), found))
                }
            };
            Ok(match found {
                Err(failure) => StepOutcome::Rejected(failure.what),
                Ok((_, found)) if self.straightness(here, &found.state) < STRAIGHT => {
                    StepOutcome::Rejected("the step leaves the branch, or it is too long".into())
                }
                Ok((value, found)) => StepOutcome::Accepted(Box::new(point(value, found, begin)?)),
            })
        };
        self.evaluations
            .try_get(&("step", counter.get()), &|| self.stop.raised(), compute)
    }

    /// Adds the special points and the requested values up to a new point, and the point. Returns the last state; `None` if the branch
    /// leaves the range.
    fn add(
        &self,
        here: &Located,
        there: PathPoint,
        aim: Aim,
        branch: &mut FollowedBranch,
        finished: &mut [bool],
        counter: &Cell<usize>,
    ) -> Result<Option<Located>> {
        let mut new = vec![];
        if let Ok(member) = &there.found {
            let ends = [(&here.0, &here.1), (&there.state, &member.floquet)];
            for (kind, values) in special_points::between(ends[0], ends[1]) {
                let found = self.locate([&here.0, &there.state], kind, values, counter)?;
                new.extend(found.map(|(share, point)| (share, point, MemberKind::Special)));
            }
            new.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let kind = match aim {
            Aim::Value(_) => MemberKind::Requested,
            Aim::Distance(_) => MemberKind::Between,
        };
        new.push((1.0, there, kind));
        let mut last = here.clone();
        let most = (self.values.len() - 1) as f64;
        for (_, point, kind) in new {
            while let Some(k) = self.next(last.0.coordinate, point.state.coordinate - last.0.coordinate) {
                let at = k as f64;
                let inside = (last.0.coordinate.min(point.state.coordinate) < at)
                    && (at < last.0.coordinate.max(point.state.coordinate));
                if !inside {
                    break;
                }
                finished[k] = true;
                match self.passage(&last.0, &point.state, k, counter)? {
                    Some(passed) => last = keep(branch, (self.values[k], passed), MemberKind::Requested, &last.1),
                    None => {
                        let why = "the branch passes this value, but Newton's iteration did not find the cycle";
                        branch.missing.push((self.values[k], why.into()));
                        break;
                    }
                }
            }
            if point.state.coordinate < -1e-9 || point.state.coordinate > most + 1e-9 {
                return Ok(None);
            }
            if kind == MemberKind::Requested {
                finished[point.state.coordinate.round() as usize] = true;
            }
            let value = self.family.scale.value(point.state.coordinate);
            last = keep(branch, (value, point), kind, &last.1);
        }
        Ok(Some(last))
    }

    /// Cycle at a requested value within a step.
    fn passage(&self, a: &FamilyState, b: &FamilyState, k: usize, counter: &Cell<usize>) -> Result<Option<PathPoint>> {
        counter.set(counter.get() + 1);
        let compute = || {
            let begin = Instant::now();
            let (mut a, mut b) = (a.clone(), b.clone());
            for _ in 0..HALVINGS {
                let at = k as f64;
                let share = (at - a.coordinate) / (b.coordinate - a.coordinate);
                let near = part(&a, &b, share);
                let whole = self.family.chord(&a, &b, a.size);
                let length = dot(&whole, &whole).sqrt();
                if let Ok(found) = self.family.at_value((at, self.values[k]), &near, &a) {
                    let off = self.family.chord(&near, &found.state, a.size);
                    if dot(&off, &off).sqrt() <= 0.3 * length {
                        return point(self.values[k], found, begin).map(Some);
                    }
                }
                let Ok(middle) = self.middle(&a, &b, 0.5) else {
                    return Ok(None);
                };
                if (middle.state.coordinate - at) * (a.coordinate - at) < 0.0 {
                    b = middle.state;
                } else {
                    a = middle.state;
                }
            }
            Ok(None)
        };
        self.evaluations
            .try_get(&("passage", counter.get()), &|| self.stop.raised(), compute)
    }

    /// Cycle of the branch at a share of the chord between two states.
    fn middle(&self, a: &FamilyState, b: &FamilyState, share: f64) -> std::result::Result<FamilyMember, StepError> {
        let mut direction = self.family.chord(a, b, a.size);
        let length = dot(&direction, &direction).sqrt();
        direction.iter_mut().for_each(|x| *x /= length);
        self.family.across(&part(a, b, share), &direction)
    }

    /// Locates a special point between two states by the Illinois variant of regula falsi. Returns its share of the chord.
    fn locate(
        &self,
        [a, b]: [&FamilyState; 2],
        kind: SpecialKind,
        values: [f64; 2],
        counter: &Cell<usize>,
    ) -> Result<Option<(f64, PathPoint)>> {
        counter.set(counter.get() + 1);
        let compute = || {
            let begin = Instant::now();
            let ([mut low, mut high], [mut f_low, mut f_high]) = ([0.0, 1.0], values);
            let most = f_low.abs().max(f_high.abs());
            let (mut before, mut was_lower) = (None, None);
            let whole = self.family.scale.value(b.coordinate) - self.family.scale.value(a.coordinate);
            for _ in 0..TRIES {
                let share: f64 = (low * f_high - high * f_low) / (f_high - f_low);
                let share = share.clamp(low + 0.02 * (high - low), high - 0.02 * (high - low));
                let Ok(mut found) = self.middle(a, b, share) else {
                    return Ok(None);
                };
                let floquet = match kind {
                    SpecialKind::Fold => None,
                    _ => Some(multipliers(&found.scene, &mut found.cycle)),
                };
                let test = match &floquet {
                    None => found.state.direction(found.state.size)[found.state.y.len()],
                    Some(floquet) => kind.test(&found.state, floquet),
                };
                let value = self.family.scale.value(found.state.coordinate);
                let linear = value + whole * test.abs() / most;
                let value_error = (value - before.unwrap_or(linear)).abs();
                before = Some(value);
                if test.abs() <= LOCATED * most || (high - low) < SHARE {
                    if test.abs() > JUMP * most {
                        return Ok(None);
                    }
                    let mut point = point(value, found, begin)?;
                    if let Ok(member) = &mut point.found {
                        member.special = Some(SpecialPoint {
                            kind,
                            multiplier: kind.multiplier(&member.floquet),
                            value_error,
                        });
                    }
                    return Ok(Some((share, point)));
                }
                let lower = test * f_low > 0.0;
                if lower {
                    (low, f_low) = (share, test);
                    f_high *= if was_lower == Some(true) { 0.5 } else { 1.0 };
                } else {
                    (high, f_high) = (share, test);
                    f_low *= if was_lower == Some(false) { 0.5 } else { 1.0 };
                }
                was_lower = Some(lower);
            }
            Ok(None)
        };
        self.evaluations
            .try_get(&("special", counter.get()), &|| self.stop.raised(), compute)
    }
}

/// Adds a point to a branch. Returns its state, with the multipliers before if its period could not be recorded.
fn keep(branch: &mut FollowedBranch, (value, point): (f64, PathPoint), kind: MemberKind, before: &Floquet) -> Located {
    branch.last.clone_from(&point.state.y);
    let floquet = match point.found {
        Ok(member) => {
            branch.open.extend(point.open.map(|warning| (member.value, warning)));
            let floquet = member.floquet.clone();
            branch.members.push(CycleMember { kind, ..member });
            floquet
        }
        Err(why) => {
            branch.missing.push((value, why));
            before.clone()
        }
    };
    (point.state, floquet)
}

/// State at a share of the chord between two.
fn part(a: &FamilyState, b: &FamilyState, share: f64) -> FamilyState {
    let mut to = a.clone();
    to.y.iter_mut().zip(&b.y).for_each(|(a, b)| *a += share * (b - *a));
    to.coordinate += share * (b.coordinate - a.coordinate);
    to
}
