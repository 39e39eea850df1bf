//! Derivatives of peaks, and of a response at frequencies, by numbers of the case.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::peaks::Stationary;
use super::{BandPole, BandResponse};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::error::Result;
use crate::run::response::LinearResponse;
use crate::run::response::sensitivity::{EquationSlopes, ResponseJet};
use crate::spectral::{self, EigenvalueOptions};
use crate::study::in_halves;

/// Derivatives of a peak by a number of the case, per unit of the number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakSlopes {
    /// Of the frequency [Hz]; not a number if the peak is no smooth maximum.
    pub frequency_hz: f64,
    /// Of the amplitude; not a number as for the frequency.
    pub amplitude: f64,
    /// Of the damping ratio of the pole, if the peak has one.
    pub damping_ratio: Option<f64>,
}

/// Derivatives of a response by one number of the case.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseSensitivity {
    /// The number.
    pub parameter: Parameter,
    /// Derivatives of each peak of each output.
    pub peaks: Vec<Vec<PeakSlopes>>,
    /// Derivatives of the transfer function of each output at each frequency.
    pub values: Vec<Vec<Complex<f64>>>,
}

/// Derivatives [E98] by numbers p of the case: of peaks, and of the transfer functions at `frequencies` [Hz]. A peak ω of the
/// amplitude |H| moves with its partial derivatives at fixed ω:
///
/// ```text
/// dω/dp = -∂²|H|²/∂ω∂p / ∂²|H|²/∂ω²        d|H|/dp = Re(H* ∂H/∂p)/|H|
/// ```
///
/// Its damping ratio is that of the nearest pole, [E44].
///
/// # Errors
/// A number without derivatives; a frequency that is a pole.
pub fn differentiate(
    case: &Case,
    at: Option<f64>,
    found: &BandResponse,
    frequencies: &[f64],
    parameters: &[Parameter],
) -> Result<Vec<ResponseSensitivity>> {
    let response = &found.response;
    let slopes = equation_slopes(case, at, response, parameters)?;
    let mut all: Vec<ResponseSensitivity> = parameters
        .iter()
        .map(|parameter| ResponseSensitivity {
            parameter: parameter.clone(),
            peaks: vec![],
            values: vec![],
        })
        .collect();
    let values = at_frequencies(response, frequencies, &slopes)?;
    for (place, curve) in found.curves.iter().enumerate() {
        let hz: Vec<f64> = curve.peaks.iter().map(|peak| peak.frequency_hz).collect();
        let jets = at_frequencies(response, &hz, &slopes)?;
        let damping: Vec<Vec<f64>> = curve
            .peaks
            .iter()
            .map(|peak| {
                peak.pole
                    .map_or(Ok(vec![]), |pole| damping_slopes(response, pole, &slopes))
            })
            .collect::<Result<_>>()?;
        for (k, one) in all.iter_mut().enumerate() {
            let peaks = jets.iter().zip(&damping);
            let peaks = peaks.map(|(jets, damping)| peak_slopes(&jets[place], k, damping.get(k).copied()));
            one.peaks.push(peaks.collect());
            one.values
                .push(values.iter().map(|jets| jets[place].slopes[k][0]).collect());
        }
    }
    Ok(all)
}

/// Derivatives of the equations of a response by each of the numbers.
///
/// # Errors
/// As [`EquationSlopes::new`].
pub fn equation_slopes(
    case: &Case,
    at: Option<f64>,
    response: &LinearResponse,
    parameters: &[Parameter],
) -> Result<Vec<EquationSlopes>> {
    in_halves(parameters, |part| {
        let of = |parameter: &Parameter| EquationSlopes::new(case, at, response, parameter);
        part.iter().map(of).collect()
    })
}

/// Transfer functions of all outputs with derivatives at frequencies [Hz].
///
/// # Errors
/// A frequency is a pole; the computation was interrupted.
pub fn at_frequencies(
    response: &LinearResponse,
    frequencies: &[f64],
    slopes: &[EquationSlopes],
) -> Result<Vec<Vec<ResponseJet>>> {
    in_halves(frequencies, |part| {
        let mut solver = response.solver()?;
        part.iter().map(|hz| solver.jets(*hz, slopes)).collect()
    })
}

fn peak_slopes(jet: &ResponseJet, k: usize, damping_ratio: Option<f64>) -> PeakSlopes {
    let [slope, mixed] = jet.slopes[k];
    let conjugate = jet.value.conj();
    let found = Stationary::from_jet(jet);
    let moved = |peak: &Stationary| (slope.conj() * jet.rate + conjugate * mixed).im / peak.curvature / TAU;
    PeakSlopes {
        frequency_hz: found.as_ref().map_or(f64::NAN, moved),
        amplitude: found.map_or(f64::NAN, |_| (conjugate * slope).re / jet.value.norm()),
        damping_ratio,
    }
}

/// Derivatives of the damping ratio of a pole by each parameter.
fn damping_slopes(response: &LinearResponse, pole: BandPole, slopes: &[EquationSlopes]) -> Result<Vec<f64>> {
    let about = &response.about;
    let found = spectral::nearest(&about.pencil(), pole.s, 1, &EigenvalueOptions::default());
    let pairs = found.map_err(|failure| response.failed(&failure))?.pairs;
    let of = |slope: &EquationSlopes| {
        let Some(pair) = pairs.first() else { return f64::NAN };
        let ds = -spectral::quotient(about.pencil().pattern, &slope.a, &slope.b, &about.b, pair);
        let (s, size) = (pair.s, pair.s.norm());
        -ds.re / size + s.re * (s.re * ds.re + s.im * ds.im) / size.powi(3)
    };
    Ok(slopes.iter().map(of).collect())
}
