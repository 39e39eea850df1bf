//! Growing waves: oscillations that grow in the equations linearised about states of the run.
//!
//! An L-stable method damps every wave that its steps do not resolve, a growing one as well. Results then show nothing of the growth until
//! smaller steps do. A conservative momentum balance with a reciprocal coupling cannot feed a wave, so such a model is not examined.

use serde::{Deserialize, Serialize};

use super::max_step;
use crate::case::schema::{Case, Formulation};
use crate::dae::{BeamDae, Dae, Seeds};
use crate::error::numbers::{quantity, significant};
use crate::functions::bounds::TimeStretch;
use crate::model::{CouplingLaw, Model};
use crate::spectral::{self, Bounds, Pencil};

/// States that are examined, as parts of the run: multiples of the golden section modulo one, in order, which no period of a drive meets
/// again and again.
const STATES: [f64; 3] = [0.236, 0.618, 0.854];
/// Amplification of a disturbance over the run above which a wave is reported.
const AMPLIFICATION: f64 = 1e3;
/// Share of the corresponding growth rate above which a wave of one state is stored.
const STORED: f64 = 0.1;
/// Waves that are stored of one state, at most.
const WAVES: usize = 6;
/// Frequency of a wave over that of the state about which the equations are linearised, at least.
const FASTER: f64 = 10.0;
/// Relative difference of frequencies below which waves of two states are the same.
const SAME: f64 = 0.05;
/// A cause explains a wave if less than this share of the growth rate is left without it.
const EXPLAINED: f64 = 0.5;
/// Growth rate over that of the last examination of causes above which causes are examined again.
const AGAIN: f64 = 2.0;

/// Waves of one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Waves {
    /// Time of the state [s].
    t: f64,
    /// Part of the run for which it is representative.
    part: f64,
    /// Step of the integrator [s].
    step: f64,
    /// Growth rate and angular frequency of each [1/s].
    found: Vec<[f64; 2]>,
}

/// Fastest growth rates without a cause [1/s], at the state where waves grew fastest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Causes {
    /// With everything.
    rate: f64,
    /// With the conservative momentum balance.
    conservative: Option<f64>,
    /// With the reciprocal coupling.
    reciprocal: Option<f64>,
}

/// Growing waves seen so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeenWaves {
    states: Vec<Waves>,
    causes: Option<Causes>,
}

impl SeenWaves {
    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }
}

/// Examines a run for growing waves.
pub struct WaveWatch {
    end: f64,
    next: usize,
    /// Shortest time scales of signals.
    stretches: Vec<TimeStretch>,
    /// Lowest frequency of the beam at rest [1/s].
    first: f64,
}

/// A growing wave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrowingWave {
    /// Largest growth rate [1/s].
    pub rate_per_s: f64,
    /// Frequency there [Hz].
    pub frequency_hz: f64,
    /// Time of that state [s].
    pub at_s: f64,
    /// Step of the integrator there [s].
    pub step_s: f64,
    /// Natural logarithm of the amplification of a disturbance over the run.
    pub exponent: f64,
    /// Causes, `coupling` or `formulation`, each with its evidence.
    pub drivers: Vec<super::growth::Driver>,
}

impl WaveWatch {
    /// For a run of a model until `end` [s]; None where no wave can grow by itself.
    pub fn new(model: &Model, end: f64) -> Option<Self> {
        let section = &model.section;
        (published(model) || !reciprocal(model)).then(|| Self {
            end,
            next: 0,
            stretches: max_step::stretches(model, end),
            first: (section.bending_stiffness / section.mass_per_length).sqrt() * (1.8751 / model.length).powi(2),
        })
    }

    /// Skips the states before a time [s], from which the run goes on.
    pub fn skip(&mut self, t: f64) {
        self.next = STATES.partition_point(|part| part * self.end <= t);
    }

    /// True if a state is due at a time [s].
    pub fn due(&self, t: f64) -> bool {
        STATES.get(self.next).is_some_and(|part| t >= part * self.end)
    }

    /// Examines the state at the end of a step [s] that passed the time of one or more states.
    pub fn examine(
        &mut self,
        case: &Case,
        dae: &BeamDae,
        t: f64,
        step: f64,
        [y, yp]: [&[f64]; 2],
        seen: &mut SeenWaves,
    ) {
        let from = self.next;
        self.skip(t);
        let part = (from..self.next).map(share).sum();
        let k = self.stretches.partition_point(|stretch| stretch.to < t);
        let scale = self.stretches.get(k).map_or(f64::INFINITY, |stretch| stretch.scale);
        let bounds = Bounds {
            rate: STORED * AMPLIFICATION.ln() / self.end,
            frequency: FASTER * self.first.max(std::f64::consts::TAU / scale),
            count: WAVES,
        };
        let about = State {
            t,
            within: dae.within(),
            y,
            yp,
        };
        let Some(found) = waves(&mut dae.clone(), &about, self.first, &bounds) else {
            return;
        };
        let Some(&[rate, _]) = found.first() else { return };
        let examined = seen.causes.map_or(0.0, |causes| causes.rate);
        if rate * self.end > AMPLIFICATION.ln() && rate > AGAIN * examined {
            let without = |change: &dyn Fn(&mut Model)| -> Option<f64> {
                let system = dae.system().like_with(case, change).ok().flatten()?;
                let found = waves(&mut BeamDae::new(system), &about, self.first, &bounds)?;
                Some(found.first().map_or(0.0, |[rate, _]| *rate))
            };
            let model = &dae.system().model;
            seen.causes = Some(Causes {
                rate,
                conservative: published(model).then(|| without(&make_conservative)).flatten(),
                reciprocal: (!reciprocal(model)).then(|| without(&make_reciprocal)).flatten(),
            });
        }
        seen.states.push(Waves { t, part, step, found });
    }

    /// The wave that is amplified most, if that is worth a warning.
    pub fn judge(&self, seen: &SeenWaves) -> Option<GrowingWave> {
        let exponent = |frequency: f64| -> f64 {
            let of_state = |state: &Waves| {
                let same = state.found.iter().filter(|[_, f]| (f / frequency - 1.0).abs() < SAME);
                state.part * self.end * same.map(|[rate, _]| *rate).fold(0.0, f64::max)
            };
            seen.states.iter().map(of_state).sum()
        };
        let all = seen
            .states
            .iter()
            .flat_map(|state| state.found.iter().map(move |wave| (state, *wave)));
        let (largest, frequency) = all
            .clone()
            .map(|(_, [_, frequency])| (exponent(frequency), frequency))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        if largest < AMPLIFICATION.ln() {
            return None;
        }
        let (state, [rate, frequency]) = all
            .filter(|(_, [_, f])| (f / frequency - 1.0).abs() < SAME)
            .max_by(|a, b| a.1[0].total_cmp(&b.1[0]))?;
        Some(GrowingWave {
            rate_per_s: rate,
            frequency_hz: frequency / std::f64::consts::TAU,
            at_s: state.t,
            step_s: state.step,
            exponent: largest,
            drivers: seen.causes.map(|causes| causes.drivers()).unwrap_or_default(),
        })
    }
}

impl Causes {
    fn drivers(&self) -> Vec<super::growth::Driver> {
        let both = [
            ("coupling", "the reciprocal coupling", self.reciprocal),
            ("formulation", "the conservative momentum balance", self.conservative),
        ];
        let explains = both.into_iter().filter_map(|(name, instead, rate)| {
            let rate = rate.filter(|rate| *rate < EXPLAINED * self.rate)?;
            let left = match rate > 0.0 {
                true => format!("growth at {} 1/s", significant(rate, 3)),
                false => "no growth".into(),
            };
            Some(super::growth::Driver {
                name: name.into(),
                evidence: format!("{left} with {instead}"),
            })
        });
        explains.collect()
    }
}

impl GrowingWave {
    /// As one warning.
    pub fn warning(&self) -> String {
        let driven = match self.drivers.is_empty() {
            true => "the published coupling or momentum balance".into(),
            false => super::growth::Driver::list(&self.drivers),
        };
        let resolved = self.step_s * self.frequency_hz * std::f64::consts::TAU < 1.0;
        let step = quantity(self.step_s, "s", 2);
        let consequence = match resolved {
            true => format!("is resolved by the time steps of {step}: it grows in the results"),
            false => format!(
                "is damped by the time steps of {step}: results depend on /solver/rtol, and error bars do not \
                 include this"
            ),
        };
        format!(
            "an unstable wave ({}, grows at {} 1/s at t = {}, by 10^{:.0} over the run, limit 10^{:.0}) {consequence}. \
             Cause: {driven}. Use the reciprocal coupling and the conservative formulation, or damping.",
            quantity(self.frequency_hz, "Hz", 4),
            significant(self.rate_per_s, 3),
            quantity(self.at_s, "s", 3),
            self.exponent / std::f64::consts::LN_10,
            AMPLIFICATION.log10(),
        )
    }
}

/// A state and its rates, scaled, with the instant that selects branches of signals [s].
struct State<'a> {
    t: f64,
    within: f64,
    y: &'a [f64],
    yp: &'a [f64],
}

/// Growth rates and angular frequencies [1/s] of waves about a state; None where they cannot be computed.
fn waves(dae: &mut BeamDae, about: &State, shift: f64, bounds: &Bounds) -> Option<Vec<[f64; 2]>> {
    dae.enter_smooth_interval(about.within);
    dae.approach(0.0);
    let (ones, zeros) = (vec![1.0; dae.len()], vec![0.0; dae.len()]);
    let entries = dae.pattern().entries();
    let (mut a, mut b) = (vec![0.0; entries], vec![0.0; entries]);
    for (values, y, yp) in [(&mut a, &ones, &zeros), (&mut b, &zeros, &ones)] {
        dae.jacobian(about.t, about.y, about.yp, Seeds::Columns { y, yp }, values)
            .ok()?;
    }
    let pencil = Pencil {
        pattern: dae.pattern(),
        a: &a,
        b: &b,
    };
    let pairs = spectral::growing(&pencil, shift, bounds).ok()??;
    Some(pairs.iter().map(|pair| [pair.s.re, pair.s.im]).collect())
}

/// Part of the run for which a state is representative.
fn share(k: usize) -> f64 {
    let between = |a: usize, b: usize| 0.5 * (STATES[a] + STATES[b]);
    let from = if k == 0 { 0.0 } else { between(k - 1, k) };
    let to = if k + 1 == STATES.len() { 1.0 } else { between(k, k + 1) };
    to - from
}

/// True if the published momentum balance acts.
fn published(model: &Model) -> bool {
    model.published()
}

/// True if areas and strains share one potential.
fn reciprocal(model: &Model) -> bool {
    let shared = |wet: &crate::model::Wet| {
        let shared = wet.segments.iter().all(|law| law.strains == law.area);
        matches!(wet.coupling, CouplingLaw::Reciprocal { .. }) && wet.strains == wet.area && shared
    };
    model.wet.as_ref().is_none_or(shared)
}

fn make_conservative(model: &mut Model) {
    model.formulation = Formulation::Conservative;
}

fn make_reciprocal(model: &mut Model) {
    let length = model.length;
    if let Some(wet) = &mut model.wet {
        let length_ratio = wet.length_ratio(length);
        wet.coupling = CouplingLaw::Reciprocal { length_ratio };
        wet.strains = wet.area;
        for law in &mut wet.segments {
            let length_ratio = law.length_ratio;
            law.coupling = CouplingLaw::Reciprocal { length_ratio };
            law.strains = law.area;
        }
    }
}
