//! Poles of a response in a band.

use nalgebra::Complex;

use super::approximation::ApproximatedResponse;
use crate::case::Case;
use crate::error::numbers::counted;
use crate::run::modes;
use crate::run::response::LinearResponse;
use crate::spectral::{self, EigenvalueOptions, Factors};

/// Relative error bound up to which an eigenvalue counts as a pole.
const NEAR_POLE: f64 = 0.02;
/// Relative difference of one eigenvalue found twice.
const SAME_POLE: f64 = 1e-6;
/// Largest number of pole pairs to compute in the band, and largest number of unknowns of a system in which they are searched.
const POLES: usize = 48;
const SEARCHED: usize = 4000;
/// Number of eigenvalues nearest to a real shift, and number of differential unknowns up to which all are computed if these do not converge.
const GROWING: usize = 8;
/// Multiples of the largest shift, and steps of inverse iteration there; steps from the pole of an approximation.
const FASTER: [f64; 2] = [30.0, 1000.0];
const FAST_STEPS: usize = 40;
const NEAR_STEPS: usize = 2;
const DENSE: usize = 400;

/// A pole in the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPole {
    /// `s` [1/s]; of a conjugate pair the pole with positive imaginary part.
    pub s: Complex<f64>,
    /// Bound of its numerical error [1/s].
    pub bound: f64,
}

/// Poles in a band, and those with positive real part. The search omits the memory of unsteady friction, whose many decay modes would
/// crowd it; each pole is corrected afterwards. Large systems are not searched: [`Poles::complete`] finds the poles that outputs show.
///
/// # Errors
/// The poles cannot be computed.
pub fn poles(
    case: &Case,
    at: Option<f64>,
    response: &LinearResponse,
    band: [f64; 2],
) -> std::result::Result<Poles, String> {
    let words = |failure: spectral::SpectralError| failure.to_string();
    let unknowns = response.about.y.len();
    if unknowns > SEARCHED {
        return Ok(Poles {
            growth_unknown: Some(format!(
                "modes that no output shows, growing ones among them: they are not searched in {}. Use `slcbeam modes` near a frequency",
                counted(unknowns as u64, "unknown")
            )),
            ..Poles::default()
        });
    }
    let apart = response.remembers.then(|| plain(case, at)).transpose()?;
    let plain = apart.as_ref().unwrap_or(&response.about);
    let tau = std::f64::consts::TAU;
    let [from, to] = band.map(|hz| tau * hz);
    let middle = Complex::new(0.0, (from.max(1e-3 * to) * to).sqrt());
    let options = EigenvalueOptions::default();
    let pairs = spectral::nearest(&plain.pencil(), middle, 2 * POLES, &options)
        .map_err(words)?
        .pairs;
    let farthest = pairs.iter().map(|pair| (pair.s - middle).norm()).fold(0.0, f64::max);
    let whole = pairs.len() < 2 * POLES || farthest >= (to - middle.im).max(middle.im - from);
    let (growing, growth_unknown) = match growing_of(&plain.pencil(), &pairs, [middle.im, to.max(plain.frequency())]) {
        Ok(growing) => (growing, None),
        Err(why) => (
            growing_among(&pairs).map(|pair| pair.s).collect(),
            Some(format!("growing modes: {why}")),
        ),
    };
    let mut poles = vec![];
    for pair in pairs.iter().filter(|pair| pair.s.im > 0.0) {
        let (mut s, mut bound) = (pair.s, pair.error);
        if response.remembers && (0.5 * from..=2.0 * to).contains(&s.im) {
            let near = spectral::nearest(&response.about.pencil(), s, 4, &options)
                .map_err(words)?
                .pairs;
            let found = near.iter().min_by(|a, b| (a.s - s).norm().total_cmp(&(b.s - s).norm()));
            (s, bound) = found.map_or((s, bound), |found| (found.s, found.error));
        }
        // damping below its error bound counts as zero
        if s.re.abs() <= bound {
            s.re = 0.0;
        }
        poles.push(BandPole { s, bound });
    }
    poles.retain(|pole| (from..=to).contains(&pole.s.im));
    let mut found = Poles {
        poles,
        growing,
        whole,
        growth_unknown,
    };
    found.sort();
    Ok(found)
}

/// Poles in a band.
#[derive(Clone, Debug, Default)]
pub struct Poles {
    /// Poles, in ascending order of frequency; of a conjugate pair the one with positive imaginary part.
    pub poles: Vec<BandPole>,
    /// Poles with positive real part, in the band or not.
    pub growing: Vec<Complex<f64>>,
    /// False if the band may contain further poles.
    pub whole: bool,
    /// Reason why growing modes may be unknown.
    pub growth_unknown: Option<String>,
}

impl Poles {
    fn sort(&mut self) {
        self.poles.sort_by(|a, b| a.s.im.total_cmp(&b.s.im));
        self.poles.dedup_by(|a, b| (a.s - b.s).norm() < 1e-9 * b.s.norm());
    }

    /// Adds poles that outputs show in a band [Hz] and the search did not find: those that inverse iteration finds from the poles of an
    /// approximation.
    pub(super) fn complete(&mut self, response: &LinearResponse, shown: &ApproximatedResponse, band: [f64; 2]) {
        let [from, to] = band.map(|hz| std::f64::consts::TAU * hz);
        let within = |s: Complex<f64>| (from..=to).contains(&s.im);
        let mut poles = if self.whole { vec![] } else { shown.fit.poles() };
        poles.retain(|s| within(*s));
        let Some(mut factors) = poles
            .first()
            .and_then(|first| Factors::new(&response.about.pencil(), *first).ok())
        else {
            return;
        };
        for about in poles {
            let Ok(pair) = factors.eigenpair(about, NEAR_STEPS) else {
                continue;
            };
            let known = |pole: &BandPole| (pole.s - pair.s).norm() < SAME_POLE * pair.s.norm();
            if within(pair.s) && pair.error < NEAR_POLE * pair.s.norm() && !self.poles.iter().any(known) {
                self.poles.push(BandPole {
                    s: pair.s,
                    bound: pair.error,
                });
                add_growing(&mut self.growing, &[pair]);
            }
        }
        self.sort();
    }
}

/// Linearization without the memory of unsteady friction.
fn plain(case: &Case, at: Option<f64>) -> std::result::Result<modes::Linearised, String> {
    let plain = match at {
        Some(at) => modes::at_equilibrium(case, at),
        None => modes::linearise(case, 0.0, None),
    };
    plain.map_err(|fault| fault.to_string())
}

/// Adds growing eigenvalues that are not yet known.
fn add_growing(known: &mut Vec<Complex<f64>>, pairs: &[spectral::EigenPair]) {
    for pair in growing_among(pairs) {
        if !known.iter().any(|s| (s - pair.s).norm() < SAME_POLE * pair.s.norm()) {
            known.push(pair.s);
        }
    }
}

/// Eigenvalues with positive real part, one of each conjugate pair.
fn growing_among(pairs: &[spectral::EigenPair]) -> impl Iterator<Item = &spectral::EigenPair> {
    // the imaginary part of a real eigenvalue is a rounding error of either sign
    let upper = |s: Complex<f64>| s.im >= -SAME_POLE * s.norm();
    pairs.iter().filter(move |pair| upper(pair.s) && pair.s.re > pair.error)
}

/// Number of growing poles, or conjugate pairs, near the characteristic frequency of the state.
///
/// # Errors
/// The poles cannot be computed.
pub fn growing(case: &Case, at: Option<f64>, response: &LinearResponse) -> std::result::Result<usize, String> {
    let apart = response.remembers.then(|| plain(case, at)).transpose()?;
    let plain = apart.as_ref().unwrap_or(&response.about);
    let middle = Complex::new(0.0, plain.frequency());
    let words = |failure: spectral::SpectralError| failure.to_string();
    let pencil = plain.pencil();
    let found = spectral::nearest(&pencil, middle, 2 * POLES, &EigenvalueOptions::default()).map_err(words)?;
    growing_of(&pencil, &found.pairs, [middle.im, 10.0 * middle.im]).map(|growing| growing.len())
}

/// Growing poles among those found near the imaginary axis, and those that grow without oscillation: to a shift σ on the positive real
/// axis all growing ones below 2σ are nearer than any that decays. The shifts are those given and multiples of the second one.
///
/// # Errors
/// No growing pole was found, and a search failed.
fn growing_of(
    pencil: &spectral::Pencil,
    found: &[spectral::EigenPair],
    shifts: [f64; 2],
) -> std::result::Result<Vec<Complex<f64>>, String> {
    let options = EigenvalueOptions {
        at_last_dense_up_to: DENSE,
        ..EigenvalueOptions::default()
    };
    let mut all: Vec<Complex<f64>> = growing_among(found).map(|pair| pair.s).collect();
    let mut failed = None;
    for shift in shifts {
        match spectral::nearest(pencil, Complex::new(shift, 0.0), GROWING, &options) {
            Ok(beside) => add_growing(&mut all, &beside.pairs),
            Err(failure) => failed = Some(failure.to_string()),
        }
    }
    // many decaying modes are about as far from a large shift: only one that grows fast stands out
    for multiple in FASTER {
        let shift = Complex::new(multiple * shifts[1], 0.0);
        let pair = Factors::new(pencil, shift).and_then(|mut factors| factors.eigenpair(shift, FAST_STEPS));
        add_growing(&mut all, &pair.into_iter().collect::<Vec<_>>());
    }
    if let Some(why) = failed.filter(|_| all.is_empty()) {
        return Err(why);
    }
    Ok(all)
}
