//! `response.json`: a frequency response.

use serde::{Deserialize, Serialize};

use super::ResultFile;
pub use super::modes::LinearisedState;
use super::ordered::Ordered;

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
    /// Motion at peaks and at requested frequencies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shapes: Option<ResponseShapes>,
    /// Mean powers at each frequency, if requested: put in, harvested and lost, those that are not zero.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub powers: Vec<PowerCurve>,
    /// Derivatives of peaks and values, by JSON pointers of numbers of the case.
    #[serde(default, skip_serializing_if = "Ordered::is_empty")]
    pub sensitivities: Ordered<ResponseDerivatives>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl ResultFile for ResponseRecord {}

/// Responses of several results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedResponses {
    /// The results.
    pub results: Vec<NamedResponse>,
}

/// A response and its folder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedResponse {
    /// Path of the folder.
    pub folder: String,
    /// The response.
    pub response: ResponseRecord,
}

impl ResultFile for ComparedResponses {}

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
    /// Values at requested frequencies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<ResponseValue>,
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

/// Shapes of the response at frequencies, per unit of the input, with six digits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseShapes {
    /// Position of each node along the undeformed beam [m].
    pub theta_m: Vec<f64>,
    /// Beam of each node in `/beams`, from 1; empty for a single beam.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub beam: Vec<usize>,
    /// Shapes, in ascending order of frequency.
    pub at: Vec<ResponseShape>,
}

/// Motion of the beam at a frequency: real and imaginary parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseShape {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Displacement across of each node [m over the unit of the input].
    pub u1: [Vec<f64>; 2],
    /// Displacement along of each node [m over the unit of the input].
    pub u3: [Vec<f64>; 2],
    /// Mean pressure of each bladder, upper row first [Pa over the unit of the input]; empty without bladders.
    pub pressure: [Vec<f64>; 2],
}

/// Mean power over a cycle, for an input of unit amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PowerCurve {
    /// Key of the power, as in [`data`](crate::results): `input`, `harvested`, `dissipated_tubes`.
    pub power: String,
    /// Power at each frequency [W over the squared unit of the input].
    pub mean_w: Vec<f64>,
}

impl PowerCurve {
    /// Index of the largest power.
    pub fn largest(&self) -> Option<usize> {
        let all = self.mean_w.iter().enumerate();
        all.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map(|(k, _)| k)
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

/// The transfer function at a requested frequency.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseValue {
    /// Frequency [Hz].
    pub frequency_hz: f64,
    /// Real part.
    pub real: f64,
    /// Imaginary part.
    pub imag: f64,
    /// Amplitude.
    pub amplitude: f64,
    /// Phase [deg].
    pub phase_deg: f64,
}

/// Derivatives of a response with respect to one number of the case, per unit of the number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResponseDerivatives {
    /// Value of the number.
    pub value: f64,
    /// Derivatives of each output, by its key.
    pub outputs: Ordered<OutputDerivatives>,
}

/// Derivatives of one output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutputDerivatives {
    /// Derivatives of the peaks, in their order.
    pub peaks: Vec<PeakDerivatives>,
    /// Derivatives of the values at requested frequencies, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<ValueDerivatives>,
}

/// Derivatives of a peak; null where it is no smooth maximum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PeakDerivatives {
    /// Of the frequency [Hz].
    pub frequency_hz: Option<f64>,
    /// Of the amplitude.
    pub amplitude: Option<f64>,
    /// Of the damping ratio of the nearest pole.
    pub damping_ratio: Option<f64>,
}

/// Derivatives of a value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ValueDerivatives {
    /// Of the real part.
    pub real: f64,
    /// Of the imaginary part.
    pub imag: f64,
    /// Of the amplitude; null if the response is 0.
    pub amplitude: Option<f64>,
    /// Of the phase [deg]; null if the response is 0.
    pub phase_deg: Option<f64>,
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
