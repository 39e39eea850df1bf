//! Frequency responses over a band: peaks, poles, and errors by the meshes.

pub mod approximation;
pub mod cycle;
pub mod derivatives;
mod peaks;
pub mod power;
pub mod reduced;

use nalgebra::Complex;

use self::approximation::ApproximatedResponse;
pub use self::peaks::BandPeak;
use self::peaks::{exact_peaks, peaks};
use super::refine::finer_along_bladders;
use crate::case::Case;
use crate::error::numbers::counted;
use crate::error::{Code, Error, Result};
use crate::run::modes;
use crate::run::record::HistoryColumn;
use crate::run::response::LinearResponse;
use crate::spectral::{self, EigenvalueOptions};

/// Relative distance of an eigenvalue from the pole of an approximation that stands for it.
const NEAR_POLE: f64 = 0.02;
/// Relative difference of one eigenvalue found twice.
const SAME_POLE: f64 = 1e-6;
/// Largest number of pole pairs to compute in the band.
const POLES: usize = 48;
/// Offsets of the samples near a pole, in units of its decay rate.
const BESIDE: [f64; 7] = [-4.0, -1.5, -0.5, 0.0, 0.5, 1.5, 4.0];
/// Change of a response between two samples, relative to the larger one, above which a sample is added between them.
const CHANGE: f64 = 0.1;
/// Part of the distance of the samples of the grid in which at most one is added, and largest number of samples with added ones.
const NARROW: f64 = 1.0 / 32.0;
const MOST: usize = 4000;
/// Errors of the approximation, and of those on other meshes.
const OWN: f64 = 1e-5;
const OTHER: f64 = 1e-4;
/// Error of the run's mesh over its difference to half and to twice the beam cells, and to twice the fluid cells.
const OF_HALF: f64 = 1.25 / 3.0;
const OF_TWICE: f64 = 1.25 * 4.0 / 3.0;
const OF_FLUID: f64 = 2.0;

/// Request for a response.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// JSON pointer of a signal of the case.
    pub input: String,
    /// Names of outputs.
    pub outputs: Vec<String>,
    /// Instant of the equilibrium to linearize about [s]; the initial state of the case if none.
    pub at: Option<f64>,
    /// First and last frequency [Hz].
    pub band: [f64; 2],
    /// Number of samples, equally spaced in the logarithm; more are added where the response changes.
    pub points: usize,
}

impl Request {
    /// The linear response of a case.
    ///
    /// # Errors
    /// Those of [`Response::new`].
    pub fn compute(&self, case: &Case) -> Result<LinearResponse> {
        LinearResponse::new(case, &self.input, &self.outputs, self.at)
    }
}

/// A pole in the band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPole {
    /// `s` [1/s]; of a conjugate pair the pole with positive imaginary part.
    pub s: Complex<f64>,
    /// Bound of its numerical error [1/s].
    pub bound: f64,
}

/// The response of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputResponse {
    /// The output.
    pub output: HistoryColumn,
    /// Its transfer function at each frequency.
    pub values: Vec<Complex<f64>>,
    /// Estimated absolute error by the meshes of beam and fluid, and by the approximation; empty if unknown.
    pub errors: Vec<f64>,
    /// Its peaks.
    pub peaks: Vec<BandPeak>,
}

/// A response over a band.
pub struct BandResponse {
    /// Linearization and its input.
    pub response: LinearResponse,
    /// Frequencies [Hz].
    pub frequencies: Vec<f64>,
    /// One per output.
    pub curves: Vec<OutputResponse>,
    /// Poles in the band, in ascending order of frequency.
    pub poles: Vec<BandPole>,
    /// Number of poles with positive real part.
    pub growing: usize,
    /// Number of frequencies at which the equations were solved.
    pub solved: usize,
    /// Reasons why poles or errors are unknown.
    pub unknown: Vec<String>,
}

/// Computes the response of a case over a band; `response` is [`Request::of`] the case.
///
/// # Errors
/// A frequency that is a pole.
pub fn respond(case: &Case, request: &Request, response: LinearResponse) -> Result<BandResponse> {
    let mut found = respond_on_mesh(case, request, response)?;
    for (other, factor) in meshes(case)? {
        match request
            .compute(&other)
            .and_then(|response| ApproximatedResponse::new(&response, request.band, &[], OTHER))
        {
            Ok(other) => {
                for (k, hz) in found.frequencies.iter().enumerate() {
                    for (curve, other) in found.curves.iter_mut().zip(other.at(*hz)) {
                        curve.errors[k] += factor * (curve.values[k] - other).norm();
                    }
                }
            }
            Err(interrupted @ Error::Interrupted(_)) => return Err(interrupted),
            Err(fault) => found.unknown.push(format!("errors due to the mesh: {fault}")),
        }
    }
    if found.unknown.iter().any(|why| why.starts_with("errors")) {
        found.curves.iter_mut().for_each(|curve| curve.errors.clear());
    }
    Ok(found)
}

/// Computes the response of a case over a band as [`respond`], with errors by the approximation only.
///
/// # Errors
/// A frequency that is a pole.
pub fn respond_on_mesh(case: &Case, request: &Request, response: LinearResponse) -> Result<BandResponse> {
    let mut unknown = vec![];
    let found = poles(case, request.at, &response, request.band);
    let mut found = found.unwrap_or_else(|why| {
        unknown.push(format!("poles: {why}"));
        Poles {
            whole: true,
            ..Poles::default()
        }
    });
    let known: Vec<_> = found.poles.iter().map(|pole| pole.s).collect();
    let approximated = ApproximatedResponse::new(&response, request.band, &known, OWN)?;
    found.complete(&response, &approximated, request.band);
    let Poles { poles, growing, .. } = found;
    let (frequencies, mut curves) = curves(&response, &approximated, request, &poles);
    exact_peaks(&response, &mut curves)?;
    Ok(BandResponse {
        response,
        frequencies,
        curves,
        poles,
        growing: growing.len(),
        solved: approximated.samples.omega.len(),
        unknown,
    })
}

/// The response of a case on another mesh for error estimates: peaks of the approximation, and its poles.
///
/// # Errors
/// As [`respond`].
pub fn respond_roughly(request: &Request, response: LinearResponse) -> Result<BandResponse> {
    let approximated = ApproximatedResponse::new(&response, request.band, &[], OTHER)?;
    let poles = approximated.fit.poles().into_iter();
    let poles = poles.filter(|s| s.im > 0.0).map(|s| BandPole { s, bound: 0.0 });
    let poles: Vec<BandPole> = poles.collect();
    let (frequencies, curves) = curves(&response, &approximated, request, &poles);
    Ok(BandResponse {
        response,
        frequencies,
        curves,
        poles,
        growing: 0,
        solved: approximated.samples.omega.len(),
        unknown: vec![],
    })
}

/// Frequencies [Hz] and outputs of an approximation.
fn curves(
    response: &LinearResponse,
    approximated: &ApproximatedResponse,
    request: &Request,
    poles: &[BandPole],
) -> (Vec<f64>, Vec<OutputResponse>) {
    let (frequencies, all) = sample(approximated, request, poles);
    let of = |(place, output): (usize, &HistoryColumn)| {
        let values: Vec<_> = all.iter().map(|all| all[place]).collect();
        let median = approximated.medians[place];
        let error = |(hz, value): (&f64, &Complex<f64>)| approximated.error_at(*hz) * value.norm().max(median);
        OutputResponse {
            output: output.clone(),
            peaks: peaks(approximated, place, &frequencies, &values, poles),
            errors: frequencies.iter().zip(&values).map(error).collect(),
            values,
        }
    };
    let curves = response.outputs.iter().enumerate().map(of).collect();
    (frequencies, curves)
}

/// The case on other meshes, each with the error of its own mesh over the difference to the other.
///
/// # Errors
/// As [`System::new`](crate::discrete::System::new).
pub fn meshes(case: &Case) -> Result<Vec<(Case, f64)>> {
    let mut all = vec![];
    let mut other = case.clone();
    if case.mesh.cells_per_segment.is_multiple_of(2) {
        other.mesh.cells_per_segment /= 2;
        all.push((other, OF_HALF));
    } else {
        other.mesh.cells_per_segment *= 2;
        all.push((other, OF_TWICE));
    }
    all.extend(finer_along_bladders(case)?.map(|other| (other, OF_FLUID)));
    Ok(all)
}

/// Poles in a band, and the number of poles with positive real part. The search omits the memory of unsteady friction, whose many decay
/// modes would crowd it; each pole is corrected afterwards.
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
    let growing = growing_among(&pairs).map(|pair| pair.s).collect();
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
    let mut found = Poles { poles, growing, whole };
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
}

impl Poles {
    fn sort(&mut self) {
        self.poles.sort_by(|a, b| a.s.im.total_cmp(&b.s.im));
        self.poles.dedup_by(|a, b| (a.s - b.s).norm() < 1e-9 * b.s.norm());
    }

    /// Adds poles that outputs show: the eigenvalues nearest to the poles of an approximation in a band [Hz], where a search for the
    /// nearest to its middle finds others first.
    fn complete(&mut self, response: &LinearResponse, shown: &ApproximatedResponse, band: [f64; 2]) {
        let [from, to] = band.map(|hz| std::f64::consts::TAU * hz);
        let within = |s: Complex<f64>| (from..=to).contains(&s.im);
        let poles = if self.whole { vec![] } else { shown.fit.poles() };
        for about in poles.into_iter().filter(|s| within(*s)) {
            let nearest = spectral::nearest(&response.about.pencil(), about, 2, &EigenvalueOptions::default());
            let near = |pair: &spectral::EigenPair| (pair.s - about).norm();
            let pairs = nearest.map_or(vec![], |found| found.pairs).into_iter();
            let found = pairs.min_by(|a, b| near(a).total_cmp(&near(b)));
            let Some(pair) = found.filter(|pair| within(pair.s) && near(pair) < NEAR_POLE * about.norm()) else {
                continue;
            };
            let known = |pole: &BandPole| (pole.s - pair.s).norm() < SAME_POLE * pair.s.norm();
            if !self.poles.iter().any(known) {
                self.poles.push(BandPole {
                    s: pair.s,
                    bound: pair.error,
                });
            }
        }
        self.sort();
    }
}

/// Warnings of a state about which motions do not stay small.
pub fn cautions(growing: usize, moving: bool) -> Vec<String> {
    let mut warnings = vec![];
    if growing > 0 {
        warnings.push(Code::Growth.warning(format!(
            "{} with a positive real part: small motions grow. The response is not that of a steady state",
            counted(growing as u64, "pole")
        )));
    }
    if moving {
        warnings.push(Code::NotAtRest.warning(
            "the state is not an equilibrium: the beam would start to move. Use `slcbeam response --at SECONDS`, or \
             /start/equilibrium, for the equilibrium under the loads of an instant.",
        ));
    }
    warnings
}

/// Linearization without the memory of unsteady friction.
fn plain(case: &Case, at: Option<f64>) -> std::result::Result<modes::Linearised, String> {
    let plain = match at {
        Some(at) => modes::at_equilibrium(case, at),
        None => modes::linearise(case, 0.0, None),
    };
    plain.map_err(|fault| fault.to_string())
}

/// Eigenvalues with positive real part, one of each conjugate pair.
fn growing_among(pairs: &[spectral::EigenPair]) -> impl Iterator<Item = &spectral::EigenPair> {
    pairs.iter().filter(|pair| pair.s.im >= 0.0 && pair.s.re > pair.error)
}

/// Number of growing poles, or conjugate pairs, near the characteristic frequency of the state.
///
/// # Errors
/// The poles cannot be computed.
pub fn growing(case: &Case, at: Option<f64>, response: &LinearResponse) -> std::result::Result<usize, String> {
    let apart = response.remembers.then(|| plain(case, at)).transpose()?;
    let plain = apart.as_ref().unwrap_or(&response.about);
    let middle = Complex::new(0.0, plain.frequency());
    let found = spectral::nearest(&plain.pencil(), middle, 2 * POLES, &EigenvalueOptions::default());
    Ok(growing_among(&found.map_err(|failure| failure.to_string())?.pairs).count())
}

/// Frequencies [Hz], and values of all outputs at each.
type Samples = (Vec<f64>, Vec<Vec<Complex<f64>>>);

/// Evaluates a response on a grid, near poles, and between these frequencies where it changes.
fn sample(response: &ApproximatedResponse, request: &Request, poles: &[BandPole]) -> Samples {
    let [from, to] = request.band;
    let points = if from < to { request.points } else { 1 };
    let steps = (points.max(2) - 1) as f64;
    let mut frequencies: Vec<f64> = (0..points).map(|k| from * (to / from).powf(k as f64 / steps)).collect();
    frequencies[points - 1] = to;
    for pole in poles {
        let beside = BESIDE.map(|by| (pole.s.im + by * pole.s.re.abs()) / std::f64::consts::TAU);
        frequencies.extend(beside.into_iter().filter(|f| (from..=to).contains(f)));
    }
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup_by(|a, b| *a <= *b * (1.0 + 1e-12));
    // samples still to be added, the next one last
    let mut ahead: Vec<(f64, Vec<Complex<f64>>)> = frequencies.iter().rev().map(|f| (*f, response.at(*f))).collect();
    let (mut frequencies, mut values) = (vec![], vec![]);
    while let Some((f, value)) = ahead.pop() {
        let before = frequencies.last().zip(values.last());
        let middle = before.and_then(|(before, old): (&f64, &Vec<Complex<f64>>)| {
            let changes = |(a, b): (&Complex<f64>, &Complex<f64>)| (a - b).norm() > CHANGE * a.norm().max(b.norm());
            let wide = (f / before).ln() > NARROW * (to / from).ln() / steps
                && frequencies.len() + ahead.len() < points.max(MOST);
            (wide && old.iter().zip(&value).any(changes)).then(|| (before * f).sqrt())
        });
        if let Some(middle) = middle {
            ahead.extend([(f, value), (middle, response.at(middle))]);
        } else {
            frequencies.push(f);
            values.push(value);
        }
    }
    (frequencies, values)
}
