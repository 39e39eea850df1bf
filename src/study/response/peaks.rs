//! Peaks of a response: local maxima of the amplitude, first of an approximation, then of exact solutions.

use std::convert::Infallible;
use std::f64::consts::TAU;

use nalgebra::Complex;

use super::approximation::ApproximatedResponse;
use super::{BandPole, OutputResponse};
use crate::error::{Error, Result};
use crate::numerics::golden_section;
use crate::run::response::LinearResponse;
use crate::run::response::sensitivity::ResponseJet;
use crate::study::in_halves;

/// Part of the largest amplitude below which a local maximum is a rounding error.
pub(super) const NOISE: f64 = 1e-6;
/// Part of an amplitude by which a peak must exceed its neighbors.
const FLAT: f64 = 1e-9;
/// Golden-section steps of the search for a peak; each leaves 0.62 of the interval.
const SECTIONS: usize = 48;
/// Largest number of Newton steps to a peak.
const STEPS: usize = 8;
/// Relative step, the last one to a peak, whose square is a rounding error; and the largest accepted distance from the peak of the approximation.
const FOUND: f64 = 1e-9;
const NEAR: f64 = 0.02;

/// A local maximum of the amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandPeak {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// The response there.
    pub value: Complex<f64>,
    /// Nearest pole.
    pub pole: Option<BandPole>,
}

impl BandPeak {
    /// Damping ratio of the nearest pole.
    pub fn damping_ratio(&self) -> Option<f64> {
        self.pole.map(|pole| 0.0 - pole.s.re / pole.s.norm())
    }
}

/// Local maxima of an amplitude, each refined by golden-section search.
pub(super) fn peaks(
    response: &ApproximatedResponse,
    place: usize,
    frequencies: &[f64],
    values: &[Complex<f64>],
    poles: &[BandPole],
) -> Vec<BandPeak> {
    let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let mut all = vec![];
    for k in 1..frequencies.len().saturating_sub(1) {
        let [before, own, after] = [-1, 0, 1].map(|by: isize| values[k.wrapping_add_signed(by)].norm());
        let rises = (own - before) + (own - after);
        if !(own > before && own >= after) || own < NOISE * largest || rises < FLAT * own {
            continue;
        }
        let at = |f: f64| response.at(f)[place];
        let around = [frequencies[k - 1], frequencies[k + 1]];
        let Ok(frequency_hz) = golden_section::maximum(around, SECTIONS, |f| Ok::<_, Infallible>(at(f).norm()));
        let s = std::f64::consts::TAU * frequency_hz;
        let nearest = poles
            .iter()
            .min_by(|a, b| (a.s.im - s).abs().total_cmp(&(b.s.im - s).abs()));
        all.push(BandPeak {
            frequency_hz,
            value: at(frequency_hz),
            pole: nearest.filter(|pole| (pole.s.im - s).abs() < 0.1 * s).copied(),
        });
    }
    all
}

/// Moves peaks of an approximation to the maxima of exact solutions, by Newton's method. Undamped peaks stay.
///
/// # Errors
/// The computation was interrupted.
pub(super) fn exact_peaks(response: &LinearResponse, curves: &mut [OutputResponse]) -> Result<()> {
    let all = curves.iter().enumerate();
    let places: Vec<(usize, f64)> = all
        .flat_map(|(place, curve)| curve.peaks.iter().map(move |peak| (place, peak.frequency_hz)))
        .collect();
    let found = in_halves(&places, |part| {
        let mut solver = response.solver()?;
        let mut one = |(place, hz): &(usize, f64)| {
            let mut at = *hz;
            for _ in 0..STEPS {
                let jet = match solver.jets(at, &[]) {
                    Ok(mut jets) => jets.swap_remove(*place),
                    Err(interrupted @ Error::Interrupted(_)) => return Err(interrupted),
                    Err(_) => return Ok(None),
                };
                let Some(peak) = Stationary::from_jet(&jet) else {
                    return Ok(None);
                };
                let step = -peak.slope / peak.curvature / TAU;
                at += step;
                if step.abs() <= FOUND * at {
                    return Ok(Some((at, jet.value + jet.rate * Complex::new(0.0, TAU * step))));
                }
                if (at - hz).abs() > NEAR * hz {
                    return Ok(None);
                }
            }
            Ok(None)
        };
        part.iter().map(&mut one).collect()
    })?;
    let peaks = curves.iter_mut().flat_map(|curve| &mut curve.peaks);
    for (peak, found) in peaks.zip(found) {
        if let Some((frequency_hz, value)) = found {
            *peak = BandPeak {
                frequency_hz,
                value,
                ..*peak
            };
        }
    }
    Ok(())
}

/// First two derivatives of `|H|²/2` by ω near a maximum.
pub(super) struct Stationary {
    pub slope: f64,
    pub curvature: f64,
}

impl Stationary {
    /// None if the curvature is not that of a maximum.
    pub fn from_jet(jet: &ResponseJet) -> Option<Self> {
        let conjugate = jet.value.conj();
        let found = Self {
            slope: -(conjugate * jet.rate).im,
            curvature: jet.rate.norm_sqr() - (conjugate * jet.curvature).re,
        };
        (found.curvature < 0.0).then_some(found)
    }
}
