//! Growth over frequency and amplitude of a shaken root, compared with Mathieu's equation.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::case::schema::Case;
use crate::case::{ResolvedEnd, Translation};
use crate::error::{Error, Result};
use crate::functions::Signal;
use crate::model::Model;
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu};
use crate::run::drive::{PeriodicDrive, settled, settled_opening};
use crate::run::early_warnings;
use crate::run::floquet::{self, CycleStability};
use crate::run::periodic::scene::whole;
use crate::run::periodic::{PeriodicScene, shoot};
use crate::run::stop::{INTERRUPTED, StopFlag};
use crate::study::evaluations::Evaluations;
use crate::study::sweep::pool;

/// Number of multipliers computed at a point.
const COUNT: usize = 2;

/// Range of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapRange {
    /// Frequencies of the shaking [Hz], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Its amplitudes [m], ascending.
    pub amplitudes_m: Vec<f64>,
    /// Permeability factors, one sheet each; a dry beam has one sheet without a factor.
    pub permeability_factors: Vec<f64>,
}

/// One point of a sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MapPoint {
    /// Growth rate of the largest multiplier [1/s]; `None` without a cycle.
    pub growth_per_s: Option<f64>,
    /// Largest multiplier, real and imaginary part.
    pub multiplier: Option<(f64, f64)>,
    /// Description of the cycle, or the reason why there is none.
    pub words: String,
    /// Stability of the cycle; `None` without a cycle, and in maps of earlier versions.
    #[serde(default)]
    pub stability: Option<CycleStability>,
}

impl MapPoint {
    /// True if bending oscillations grow by themselves. Maps of earlier versions are decided by the rate alone.
    pub fn grows(&self) -> bool {
        self.growth_per_s.is_some_and(|rate| rate > 0.0) && self.stability != Some(CycleStability::Neutral)
    }
}

/// Points at one permeability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// Factor of the case's permeabilities; `None` for a dry beam.
    pub permeability_factor: Option<f64>,
    /// Points by frequency, then by amplitude.
    pub points: Vec<Vec<MapPoint>>,
}

/// Mathieu's equation of the first mode of the dry beam.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MathieuEquation {
    /// First bending frequency [Hz].
    pub frequency_hz: f64,
    /// Amplitude above which the principal tongue contains each frequency of the map [m].
    pub onset_m: Vec<f64>,
}

/// A stability map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Name of the case.
    pub case: String,
    /// Frequency [Hz] and amplitude [m] of the case itself.
    pub own: (f64, f64),
    /// Frequencies [Hz].
    pub frequencies_hz: Vec<f64>,
    /// Amplitudes [m].
    pub amplitudes_m: Vec<f64>,
    /// Sheets.
    pub sheets: Vec<Sheet>,
    /// Prediction without fluid and stretch; cantilevers only.
    pub mathieu: Option<MathieuEquation>,
    /// Warnings about the case.
    pub warnings: Vec<String>,
}

/// Frequency [Hz] and amplitude [m] of the sine that shakes the root along the beam.
///
/// # Errors
/// [`Error::Usage`] if there is none.
pub fn shaking(case: &Case) -> Result<(f64, f64)> {
    case.single("map")?;
    match settled(axial(whole(case)?.root_and_tip())) {
        Signal::Sine(sine) => Ok((sine.frequency_hz, sine.amplitude.abs())),
        _ => Err(Error::Usage(format!(
            "{}: the root does not oscillate along the beam, but a map needs a sine there: /ends/root/clamped/u3_m = \
             {{\"sine\": {{\"amplitude\": .., \"frequency_hz\": ..}}}}",
            case.name
        ))),
    }
}

fn axial(ends: &[ResolvedEnd; 2]) -> &Signal {
    match &ends[0].axial {
        Translation::Displacement(signal) | Translation::Force(signal) => signal,
    }
}

/// Computes the map; `report` is called with the finished and the total number of columns. Points not finished at a stop
/// have no result. Points stored in `evaluations` are not computed again.
///
/// # Errors
/// A case without a shaken root, or with an additional period.
pub fn map(
    case: &Case,
    plan: &MapRange,
    evaluations: &Evaluations,
    stop: &StopFlag,
    report: &(dyn Fn(usize, usize) + Sync),
) -> Result<Map> {
    let own = shaking(case)?;
    // another drive would have a period of its own
    crate::run::drive::drive(case, &whole(case)?, None)?;
    let wet = case.bladders.is_some();
    let factors: Vec<Option<f64>> = if wet && case.network.is_some() {
        plan.permeability_factors.iter().copied().map(Some).collect()
    } else {
        vec![None]
    };
    let columns = plan.frequencies_hz.len();
    let count = factors.len() * columns;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let all = pool::all(count, pool::cores(), &|k| {
        let made = column(
            case,
            factors[k / columns],
            plan.frequencies_hz[k % columns],
            &plan.amplitudes_m,
            &evaluations.scoped(&k.to_string()),
            stop,
        );
        report(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), count);
        Some(made)
    });
    let mut all = all.into_iter().flatten().collect::<Result<Vec<_>>>()?.into_iter();
    let sheets = factors
        .iter()
        .map(|&permeability_factor| Sheet {
            permeability_factor,
            points: all.by_ref().take(columns).collect(),
        })
        .collect();
    Ok(Map {
        case: case.name.clone(),
        own,
        frequencies_hz: plan.frequencies_hz.clone(),
        amplitudes_m: plan.amplitudes_m.clone(),
        sheets,
        mathieu: prediction(case, &plan.frequencies_hz)?,
        warnings: early_warnings::without_outputs(case, &crate::run::periodic::scene::system(case)?),
    })
}

/// Points at all amplitudes of one frequency; each search starts from the previous cycle.
fn column(
    case: &Case,
    factor: Option<f64>,
    frequency_hz: f64,
    amplitudes: &[f64],
    evaluations: &Evaluations,
    stop: &StopFlag,
) -> Result<Vec<MapPoint>> {
    let mut case = case.clone();
    if let (Some(factor), Some(network)) = (factor, &mut case.network) {
        network.permeability_factor *= factor;
    }
    let mut before: Option<(PeriodicScene, Vec<f64>)> = None;
    amplitudes
        .iter()
        .map(|&amplitude| {
            if stop.raised() {
                return Ok(MapPoint {
                    words: INTERRUPTED.into(),
                    ..MapPoint::default()
                });
            }
            let scene = PeriodicScene::with_model(
                &case,
                shaken(&case, frequency_hz, amplitude)?,
                PeriodicDrive {
                    period: 1.0 / frequency_hz,
                    driven: true,
                },
            )?
            .heeding(stop);
            let from = before.as_ref().and_then(|(old, y)| scene.take_over(old, y));
            let compute = || point(&scene, from.as_deref());
            let (point, state) = evaluations.get(&amplitude, &|| stop.raised(), compute);
            if let Some(y) = state {
                before = Some((scene, y));
            }
            Ok(point)
        })
        .collect()
}

/// Returns a point, and the state of its cycle if there is one.
fn point(scene: &PeriodicScene, from: Option<&[f64]>) -> (MapPoint, Option<Vec<f64>>) {
    match shoot(scene, from) {
        Ok(mut cycle) => {
            let found = floquet::multipliers(scene, &mut cycle, COUNT);
            let point = MapPoint {
                growth_per_s: Some(found.verdict.growth_per_s),
                multiplier: found.multipliers.first().map(|m| (m.re, m.im)),
                words: found.verdict.words,
                stability: Some(found.verdict.stability),
            };
            (point, Some(cycle.y))
        }
        Err(impasse) => {
            let words = impasse.what;
            let point = MapPoint {
                words,
                ..MapPoint::default()
            };
            (point, None)
        }
    }
}

/// Returns the model with another shaking of the root.
fn shaken(case: &Case, frequency_hz: f64, amplitude: f64) -> Result<Model> {
    let mut model = whole(case)?;
    model.replace_signals(settled, settled_opening);
    if let Translation::Displacement(Signal::Sine(sine)) = &mut model.ends[0].axial {
        (sine.frequency_hz, sine.amplitude) = (frequency_hz, amplitude);
    }
    Ok(model)
}

/// `[E39]` Onset of the principal tongue of the drained beam's first mode alone, to first order in the modulation:
///
/// ```text
/// |Ω/(2 ω1) - 1| < ε/4     ε = κ_1 U Ω²/(l_s ω1²)     U the amplitude of the root
/// ```
fn prediction(case: &Case, frequencies: &[f64]) -> Result<Option<MathieuEquation>> {
    let model = Model::whole(case, true)?;
    let Some(sine) = mathieu(&model) else { return Ok(None) };
    let first = (MATHIEU_COUPLING * sine.acceleration / (model.length * sine.modulation)).sqrt();
    let onset = |f: &f64| {
        let omega = TAU * f;
        let epsilon = 4.0 * (omega / (2.0 * first) - 1.0).abs();
        epsilon * model.length * first * first / (MATHIEU_COUPLING * omega * omega)
    };
    Ok(Some(MathieuEquation {
        frequency_hz: first / TAU,
        onset_m: frequencies.iter().map(onset).collect(),
    }))
}
