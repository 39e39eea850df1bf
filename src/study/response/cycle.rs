//! Harmonic transfer functions of a cycle over a band, with errors by steps and meshes.

use nalgebra::Complex;

use super::meshes;
use super::peaks::NOISE;
use super::samples::Sampling;
use crate::case::Case;
use crate::error::{Error, Result};
use crate::numerics::golden_section;
use crate::run::record::HistoryColumn;
use crate::run::response::cycle::{CycleResponse, DrivenCycle};
use crate::run::stop::StopFlag;

/// Number of steps in a cycle of the fastest harmonic.
const STEPS: f64 = 16.0;
/// Part of the distance of the samples of the grid in which at most one is added.
const NARROW: f64 = 1.0 / 16.0;
/// Golden-section steps of the search for a peak; each leaves 0.62 of the interval.
const SEARCH: usize = 20;
/// Error on steps of half the length over the difference to the whole ones, of a method of order 4.
const OF_STEPS: f64 = 1.0 / 15.0;

/// Request for a response about a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleRequest {
    /// JSON pointer of a signal of the case.
    pub input: String,
    /// Names of outputs.
    pub outputs: Vec<String>,
    /// First and last frequency [Hz].
    pub band: [f64; 2],
    /// Number of samples, equally spaced in the logarithm; more are added where the response changes.
    pub points: usize,
    /// Largest harmonic K.
    pub harmonics: usize,
}

/// Harmonic transfer functions of one output.
#[derive(Clone, Debug, PartialEq)]
pub struct HarmonicCurves {
    /// The output.
    pub output: HistoryColumn,
    /// `H_k` for k from -K to K, at each frequency.
    pub values: Vec<Vec<Complex<f64>>>,
    /// Estimated absolute errors of the same; empty if unknown.
    pub errors: Vec<Vec<f64>>,
    /// Local maxima of the amplitude of `H_0`: frequency [Hz] and value.
    pub peaks: Vec<(f64, Complex<f64>)>,
}

/// A response about a cycle over a band.
pub struct CycleBand {
    /// The cycle.
    pub cycle: DrivenCycle,
    /// Frequencies [Hz].
    pub frequencies: Vec<f64>,
    /// One for each output.
    pub curves: Vec<HarmonicCurves>,
    /// Number of steps in a period.
    pub steps: usize,
    /// Largest relative residual of the equations for the motion at the start of a period.
    pub residual: f64,
    /// Reasons why errors are unknown.
    pub unknown: Vec<String>,
}

/// Values of all outputs and harmonics at one frequency.
type Sample = Vec<Vec<Complex<f64>>>;

impl CycleRequest {
    /// Finds the cycle of a case.
    ///
    /// # Errors
    /// Those of [`DrivenCycle::find`].
    pub fn find(&self, case: &Case, stop: &StopFlag) -> Result<DrivenCycle> {
        DrivenCycle::find(case, &self.input, &self.outputs, stop)
    }

    /// Longest step [s] that resolves the fastest harmonic.
    fn longest(&self, cycle: &DrivenCycle) -> f64 {
        1.0 / (STEPS * (self.band[1] + self.harmonics as f64 / cycle.period()))
    }

    /// Computes the response about a cycle of a case over the band.
    ///
    /// # Errors
    /// A frequency that is a pole; a cycle that cannot be followed.
    pub fn respond(&self, case: &Case, cycle: DrivenCycle, stop: &StopFlag) -> Result<CycleBand> {
        let longest = self.longest(&cycle);
        let (mut steps, mut residual) = (0, 0.0);
        let (frequencies, samples, peaks) = {
            let mut response = cycle.linearize(longest, 2)?;
            steps += response.steps();
            let (frequencies, samples) = self.sample(&mut response, &mut residual)?;
            let peaks = (0..cycle.outputs.len()).map(|place| self.peaks(&mut response, place, &frequencies, &samples));
            let peaks = peaks.collect::<Result<Vec<_>>>()?;
            (frequencies, samples, peaks)
        };
        let coarse = self.at_all(&mut cycle.linearize(longest, 1)?, &frequencies)?;
        let mut errors: Vec<Vec<Vec<f64>>> = difference(&samples, &coarse, OF_STEPS);
        let mut unknown = vec![];
        for (other, factor) in meshes(case)? {
            let on_other = self.find(&other, stop).and_then(|cycle| {
                let mut response = cycle.linearize(longest, 1)?;
                self.at_all(&mut response, &frequencies)
            });
            match on_other {
                Ok(on_other) => {
                    let more = difference(&coarse, &on_other, factor);
                    for (error, more) in errors
                        .iter_mut()
                        .flatten()
                        .flatten()
                        .zip(more.iter().flatten().flatten())
                    {
                        *error += more;
                    }
                }
                Err(interrupted @ Error::Interrupted(_)) => return Err(interrupted),
                Err(fault) => unknown.push(format!("errors due to the mesh: {fault}")),
            }
        }
        if !unknown.is_empty() {
            errors.clear();
        }
        let curve = |(place, output): (usize, &HistoryColumn)| {
            let all = 0..=2 * self.harmonics;
            HarmonicCurves {
                output: output.clone(),
                values: all
                    .clone()
                    .map(|k| samples.iter().map(|sample| sample[place][k]).collect())
                    .collect(),
                errors: all
                    .filter(|_| !errors.is_empty())
                    .map(|k| errors.iter().map(|error| error[place][k]).collect())
                    .collect(),
                peaks: peaks[place].clone(),
            }
        };
        Ok(CycleBand {
            curves: cycle.outputs.iter().enumerate().map(curve).collect(),
            cycle,
            frequencies,
            steps,
            residual,
            unknown,
        })
    }

    /// Evaluates a response on a grid, and between its frequencies where the direct response changes.
    fn sample(&self, response: &mut CycleResponse, residual: &mut f64) -> Result<(Vec<f64>, Vec<Sample>)> {
        let sampling = Sampling {
            band: self.band,
            points: self.points,
            narrow: NARROW,
            most: usize::MAX,
        };
        let at = |hz: f64| -> Result<Sample> {
            let found = response.at(hz, self.harmonics)?;
            *residual = residual.max(found.residual);
            Ok(found.values)
        };
        let direct = |sample: &Sample| sample.iter().map(|all| all[self.harmonics]).collect();
        sampling.refine(&sampling.grid(), at, direct)
    }

    /// Local maxima of the direct response of an output, each refined by golden-section search.
    fn peaks(
        &self,
        response: &mut CycleResponse,
        place: usize,
        frequencies: &[f64],
        samples: &[Sample],
    ) -> Result<Vec<(f64, Complex<f64>)>> {
        let size = |k: usize| samples[k][place][self.harmonics].norm();
        let largest = (0..samples.len()).map(size).fold(0.0, f64::max);
        let inner = 1..samples.len().saturating_sub(1);
        let mut all = vec![];
        for k in inner.filter(|k| size(*k) > size(k - 1) && size(*k) >= size(k + 1) && size(*k) > NOISE * largest) {
            let mut at = |hz: f64| Ok(response.at(hz, self.harmonics)?.values[place][self.harmonics]);
            let hz = golden_section::maximum([frequencies[k - 1], frequencies[k + 1]], SEARCH, |hz| {
                at(hz).map(Complex::norm)
            })?;
            all.push((hz, at(hz)?));
        }
        Ok(all)
    }

    fn at_all(&self, response: &mut CycleResponse, frequencies: &[f64]) -> Result<Vec<Sample>> {
        let all = frequencies.iter();
        all.map(|hz| Ok(response.at(*hz, self.harmonics)?.values)).collect()
    }
}

/// Moduli of differences of samples, times a factor.
fn difference(samples: &[Sample], others: &[Sample], factor: f64) -> Vec<Vec<Vec<f64>>> {
    let curve = |(a, b): (&Vec<Complex<f64>>, &Vec<Complex<f64>>)| {
        let all = a.iter().zip(b);
        all.map(|(a, b)| factor * (a - b).norm()).collect()
    };
    let of = |(a, b): (&Sample, &Sample)| a.iter().zip(b).map(curve).collect();
    samples.iter().zip(others).map(of).collect()
}
