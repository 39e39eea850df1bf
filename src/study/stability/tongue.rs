//! Growth over frequency and amplitude of a shaken root, beside Mathieu's equation.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use crate::case::schema::Case;
use crate::case::{ResolvedEnd, Translation};
use crate::error::{Error, Result};
use crate::functions::Signal;
use crate::model::Model;
use crate::model::characteristic::{MATHIEU_COUPLING, mathieu};
use crate::run::drive::{Drive, settled, settled_opening};
use crate::run::floquet::{self, Stability};
use crate::run::known;
use crate::run::periodic::scene::whole;
use crate::run::periodic::{Scene, shoot};
use crate::run::stop::{INTERRUPTED, Stop};
use crate::study::evaluations::Evaluations;
use crate::study::sweep::pool;

/// Multipliers looked at in a point.
const COUNT: usize = 2;

/// What is to be mapped.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Frequencies of the shaking [Hz], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Its amplitudes [m], ascending.
    pub amplitudes_m: Vec<f64>,
    /// Permeability factors, one sheet each; one sheet without, in a dry beam.
    pub permeability_factors: Vec<f64>,
}

/// One point of a sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Growth rate of the largest multiplier [1/s]; none where no cycle was found.
    pub growth_per_s: Option<f64>,
    /// Largest multiplier, real and imaginary part.
    pub multiplier: Option<(f64, f64)>,
    /// What is to be said of the cycle, or why there is none.
    pub words: String,
    /// The same in one word; none where no cycle was found, and in maps of before it was told.
    #[serde(default)]
    pub stability: Option<Stability>,
}

impl Point {
    /// Whether bending swings up by itself. Of a map of before the word was told, by the rate alone.
    pub fn grows(&self) -> bool {
        self.growth_per_s.is_some_and(|rate| rate > 0.0) && self.stability != Some(Stability::Neutral)
    }
}

/// One permeability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// Factor of the case's permeabilities; none in a dry beam.
    pub permeability_factor: Option<f64>,
    /// Points by frequency, then by amplitude.
    pub points: Vec<Vec<Point>>,
}

/// Mathieu's equation of the dry beam's first mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mathieu {
    /// First bending frequency [Hz].
    pub frequency_hz: f64,
    /// Amplitude from which the principal tongue holds each frequency of the map [m].
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
    /// The prediction without fluid and stretch; of a cantilever.
    pub mathieu: Option<Mathieu>,
    /// What to know of the case.
    pub warnings: Vec<String>,
}

/// Frequency [Hz] and amplitude [m] of the sine by which the root is shaken along the beam.
///
/// # Errors
/// [`Error::Usage`] when there is none.
pub fn shaking(case: &Case) -> Result<(f64, f64)> {
    match settled(axial(&whole(case)?.ends)) {
        Signal::Sine(sine) => Ok((sine.frequency_hz, sine.amplitude.abs())),
        _ => Err(Error::Usage(format!(
            "{}: a map needs a root that is shaken along the beam by a sine, /ends/root/clamped/u3_m = \
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

/// Computes the map; `tell` hears how many of how many columns are done. Points that are not when somebody asks for the end have no answer,
/// those among `evaluations` are not computed again.
///
/// # Errors
/// A case without shaken root, or with another period besides.
pub fn map(
    case: &Case,
    plan: &Plan,
    evaluations: &Evaluations,
    stop: &Stop,
    tell: &(dyn Fn(usize, usize) + Sync),
) -> Result<Map> {
    let own = shaking(case)?;
    // another drive beside the shaking would have a period of its own
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
        tell(1 + done.fetch_add(1, std::sync::atomic::Ordering::Relaxed), count);
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
        warnings: known::without_outputs(case, &crate::run::periodic::scene::system(case)?),
    })
}

/// All amplitudes at one frequency, each cycle found from the one before.
fn column(
    case: &Case,
    factor: Option<f64>,
    frequency_hz: f64,
    amplitudes: &[f64],
    evaluations: &Evaluations,
    stop: &Stop,
) -> Result<Vec<Point>> {
    let mut case = case.clone();
    if let (Some(factor), Some(network)) = (factor, &mut case.network) {
        network.permeability_factor *= factor;
    }
    let mut before: Option<(Scene, Vec<f64>)> = None;
    amplitudes
        .iter()
        .map(|&amplitude| {
            if stop.raised() {
                return Ok(Point {
                    words: INTERRUPTED.into(),
                    ..Point::default()
                });
            }
            let scene = Scene::of(
                &case,
                shaken(&case, frequency_hz, amplitude)?,
                Drive {
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

/// A point, and the state of its cycle, where there is one.
fn point(scene: &Scene, from: Option<&[f64]>) -> (Point, Option<Vec<f64>>) {
    match shoot(scene, from) {
        Ok(mut cycle) => {
            let found = floquet::multipliers(scene, &mut cycle, COUNT);
            let point = Point {
                growth_per_s: Some(found.verdict.growth_per_s),
                multiplier: found.multipliers.first().map(|m| (m.re, m.im)),
                words: found.verdict.words,
                stability: Some(found.verdict.stability),
            };
            (point, Some(cycle.y))
        }
        Err(impasse) => {
            let words = impasse.what;
            let point = Point {
                words,
                ..Point::default()
            };
            (point, None)
        }
    }
}

/// The model with another shaking of the root.
fn shaken(case: &Case, frequency_hz: f64, amplitude: f64) -> Result<Model> {
    let mut model = whole(case)?;
    model.replace_signals(settled, settled_opening);
    if let Translation::Displacement(Signal::Sine(sine)) = &mut model.ends[0].axial {
        (sine.frequency_hz, sine.amplitude) = (frequency_hz, amplitude);
    }
    Ok(model)
}

/// `[E39]` Where the principal tongue begins, of the drained beam's first mode alone, to first order in the modulation:
///
/// ```text
/// |Ω/(2 ω1) - 1| < ε/4     ε = κ_1 U Ω²/(l_s ω1²)     U the amplitude of the root
/// ```
fn prediction(case: &Case, frequencies: &[f64]) -> Result<Option<Mathieu>> {
    let model = Model::whole(case, true)?;
    let Some(sine) = mathieu(&model) else { return Ok(None) };
    let first = (MATHIEU_COUPLING * sine.acceleration / (model.length * sine.modulation)).sqrt();
    let onset = |f: &f64| {
        let omega = TAU * f;
        let epsilon = 4.0 * (omega / (2.0 * first) - 1.0).abs();
        epsilon * model.length * first * first / (MATHIEU_COUPLING * omega * omega)
    };
    Ok(Some(Mathieu {
        frequency_hz: first / TAU,
        onset_m: frequencies.iter().map(onset).collect(),
    }))
}
