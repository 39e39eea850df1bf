//! Frequency responses over a band: peaks, poles, and errors by the meshes.

pub mod approximation;
pub mod cycle;
pub mod derivatives;
mod peaks;
mod poles;
pub mod power;
pub mod reduced;
mod samples;

use std::convert::Infallible;

use nalgebra::Complex;

use self::approximation::ApproximatedResponse;
pub use self::peaks::BandPeak;
use self::peaks::{exact_peaks, peaks};
pub use self::poles::{BandPole, Poles, growing, poles};
use self::samples::Sampling;
use super::refine::finer_along_bladders;
use crate::case::Case;
use crate::error::numbers::counted;
use crate::error::{Code, Error, Result};
use crate::run::record::HistoryColumn;
use crate::run::response::LinearResponse;

/// Offsets of the samples near a pole, in units of its decay rate.
const BESIDE: [f64; 7] = [-4.0, -1.5, -0.5, 0.0, 0.5, 1.5, 4.0];
/// Part of the distance of the samples of the grid in which at most one is added, and largest number of samples with added ones.
const NARROW: f64 = 1.0 / 32.0;
const MOST: usize = 4000;
/// Errors of the approximation, and of those on other meshes.
const OWN: f64 = 1e-5;
const OTHER: f64 = 1e-4;
/// Ratio of a single frequency to the ends of the band about it.
const ONE: f64 = 1.02;
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

    /// Band that is approximated: the requested one, or one about a single frequency.
    fn around(&self) -> [f64; 2] {
        let [from, to] = self.band;
        if from < to { self.band } else { [from / ONE, to * ONE] }
    }
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
            .and_then(|response| ApproximatedResponse::new(&response, request.around(), &[], OTHER))
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
    let found = poles(case, request.at, &response, request.around());
    let mut found = found.unwrap_or_else(|why| {
        unknown.push(format!("poles: {why}"));
        Poles {
            whole: true,
            ..Poles::default()
        }
    });
    unknown.extend(found.growth_unknown.take());
    let known: Vec<_> = found.poles.iter().map(|pole| pole.s).collect();
    let approximated = ApproximatedResponse::new(&response, request.around(), &known, OWN)?;
    found.complete(&response, &approximated, request.around());
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
    let approximated = ApproximatedResponse::new(&response, request.around(), &[], OTHER)?;
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

/// Frequencies [Hz], and values of all outputs at each.
type Samples = (Vec<f64>, Vec<Vec<Complex<f64>>>);

/// Evaluates a response on a grid, near poles, and between these frequencies where it changes.
fn sample(response: &ApproximatedResponse, request: &Request, poles: &[BandPole]) -> Samples {
    let [from, to] = request.band;
    let sampling = Sampling {
        band: request.band,
        points: request.points,
        narrow: NARROW,
        most: request.points.max(MOST),
    };
    let mut frequencies = sampling.grid();
    for pole in poles {
        let beside = BESIDE.map(|by| (pole.s.im + by * pole.s.re.abs()) / std::f64::consts::TAU);
        frequencies.extend(beside.into_iter().filter(|f| (from..=to).contains(f)));
    }
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup_by(|a, b| *a <= *b * (1.0 + 1e-12));
    let Ok(samples) = sampling.refine(&frequencies, |hz| Ok::<_, Infallible>(response.at(hz)), Vec::clone);
    samples
}
