//! `response.json`: a frequency response.

use serde::{Deserialize, Serialize};

use super::ResultFile;
pub use super::modes::LinearisedState;

/// A frequency response of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseRecord {
    /// Name of the case.
    pub case: String,
    /// JSON pointer of the input.
    pub input: String,
    /// State of linearization.
    pub state: LinearisedState,
    /// Cycle of linearization, if it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cycle: Option<ResponseCycle>,
    /// Instant of loads and valves [s].
    pub at_s: f64,
    /// Unknowns.
    pub unknowns: usize,
    /// Frequencies [Hz].
    pub frequency_hz: Vec<f64>,
    /// Curve of the first output.
    #[serde(flatten)]
    pub first: ResponseCurve,
    /// Curves of further outputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further: Vec<ResponseCurve>,
    /// Poles in the band, the lowest first.
    pub poles: Vec<ResponsePole>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl ResultFile for ResponseRecord {}

impl ResponseRecord {
    /// All outputs.
    pub fn curves(&self) -> impl Iterator<Item = &ResponseCurve> {
        std::iter::once(&self.first).chain(&self.further)
    }
}

/// Cycle about which a response is computed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseCycle {
    /// Period [s].
    pub period_s: f64,
    /// Steps in a period.
    pub steps: usize,
    /// Largest relative residual of the equations for the motion at the start of a period.
    pub residual: f64,
    /// Largest modulus of a multiplier of the cycle; absent if all disturbances vanish within a period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub largest_multiplier: Option<f64>,
}

/// Transfer function from exp(i ω t) to exp(i (ω + k Ω) t), Ω the frequency of the cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseSideband {
    /// k, not 0.
    pub harmonic: i32,
    /// Real part at each frequency.
    pub real: Vec<f64>,
    /// Imaginary part at each frequency.
    pub imag: Vec<f64>,
    /// Estimated absolute error by mesh and steps at each frequency; absent if unknown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub error: Vec<f64>,
}

impl ResponseSideband {
    /// Frequency [Hz] and amplitude of the largest value.
    pub fn largest(&self, frequencies: &[f64]) -> Option<[f64; 2]> {
        let sizes = self.real.iter().zip(&self.imag).map(|(re, im)| re.hypot(*im));
        let all = frequencies.iter().zip(sizes).map(|(hz, size)| [*hz, size]);
        all.max_by(|a, b| a[1].total_cmp(&b[1]))
    }
}

/// Transfer function to an output, in its unit over that of the input, for exp(i ω t).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseCurve {
    /// Key of the output: `tip_u1_m`.
    pub output: String,
    /// Unit of the output.
    pub unit: String,
    /// Real part at each frequency.
    pub real: Vec<f64>,
    /// Imaginary part at each frequency.
    pub imag: Vec<f64>,
    /// Estimated absolute error by the mesh at each frequency, about a cycle also by the steps; absent if unknown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub error: Vec<f64>,
    /// Local maxima of the amplitude.
    pub peaks: Vec<ResponsePeak>,
    /// Sidebands of a response about a cycle, in ascending order of k.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sidebands: Vec<ResponseSideband>,
}

impl ResponseCurve {
    /// Median of the relative error over the logarithm of the frequency, which does not depend on where samples are dense, and largest
    /// error relative to the largest amplitude.
    pub fn errors(&self, frequencies: &[f64]) -> Option<[f64; 2]> {
        let sizes = || self.real.iter().zip(&self.imag).map(|(re, im)| re.hypot(*im));
        let last = frequencies.len().checked_sub(1)?;
        let width = |k: usize| (frequencies[(k + 1).min(last)] / frequencies[k.saturating_sub(1)]).ln();
        let errors = self.error.iter().zip(sizes()).enumerate();
        let mut relative: Vec<(f64, f64)> = errors.map(|(k, (error, size))| (error / size, width(k))).collect();
        relative.sort_by(|a, b| a.0.total_cmp(&b.0));
        let half = 0.5 * relative.iter().map(|(_, width)| width).sum::<f64>();
        let mut below = 0.0;
        let median = relative.iter().find(|(_, width)| {
            below += width;
            below >= half
        });
        let largest = self.error.iter().copied().reduce(f64::max)? / sizes().fold(0.0, f64::max);
        Some([median?.0, largest]).filter(|both| both.iter().all(|e| e.is_finite()))
    }
}

/// A local maximum of the amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponsePeak {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Amplitude.
    pub amplitude: f64,
    /// Phase [deg].
    pub phase_deg: f64,
    /// Damping ratio of the nearest pole.
    pub damping_ratio: Option<f64>,
}

/// A pole `s`; of a conjugate pair the one with positive imaginary part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponsePole {
    /// Real part [1/s].
    pub re: f64,
    /// Imaginary part [1/s].
    pub im: f64,
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
}
