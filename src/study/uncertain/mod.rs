//! Uncertainty of figures due to uncertain numbers of a case: to first order, and by samples.
//!
//! ```text
//! samples           values of each sample, by its number
//! mean_derivatives  derivatives of the figures at the means
//! rounding_errors   figures that are rounding errors
//! statistics        statistics of the figures of all samples
//! indices           share of each number in a variance (Sobol)
//! ```
//!
//! Numbers are assumed to be independent of each other. Samples are points of Sobol's sequence, whose bits the seed
//! shifts: the same seed gives the same spread on every machine.

pub mod indices;
pub mod mean_derivatives;
mod rounding_errors;
pub mod samples;
pub mod statistics;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use indices::Index;
pub use mean_derivatives::{FirstOrderSlopes, slopes};
pub use samples::SamplePlan;
pub use statistics::judge;

use crate::run::uncertainty_band::{Band, Bands};

/// Uncertainty of the figures of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Name of the case.
    pub case: String,
    /// Command that computes the figures, as typed.
    pub command: String,
    /// Uncertain numbers.
    pub inputs: Vec<UncertainInput>,
    /// Number of samples drawn.
    pub samples: usize,
    /// Number of finished samples; only these enter the figures.
    pub finished: usize,
    /// Number of unfinished samples by reason.
    pub unfinished: BTreeMap<String, usize>,
    /// Seed.
    pub seed: u64,
    /// Figures by name, unit included, as in the table of `slcbeam sweep`.
    pub figures: BTreeMap<String, FigureSpread>,
    /// Reason why there are no derivatives; `None` if there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_first_order: Option<String>,
    /// Warnings.
    pub warnings: Vec<String>,
}

impl Uncertainty {
    /// Returns every figure with its band, as in a result.
    pub fn bands(&self) -> Bands {
        let band = |one: &FigureSpread| Band {
            value: one.value,
            numerical_error: one.numerical_error,
            sd: one.sd,
            low: one.low,
            high: one.high,
            samples: one.samples,
            drawn: self.samples,
        };
        let all = self.figures.iter();
        all.map(|(name, one)| (name.clone(), band(one))).collect()
    }
}

/// An uncertain number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UncertainInput {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Distribution, as typed.
    pub distribution: String,
    /// Mean, in the unit that the key names.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// Spread of a figure, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureSpread {
    /// Figure of the case itself.
    pub value: f64,
    /// Estimated absolute error due to steps, mesh and omitted effects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<f64>,
    /// Spread to first order about the means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_order: Option<FirstOrder>,
    /// Number of samples that have the figure.
    pub samples: usize,
    /// Mean of the samples.
    pub mean: f64,
    /// Standard deviation of the samples.
    pub sd: f64,
    /// Standard error of `sd` as for independent samples; that of points of Sobol's sequence is smaller.
    pub sd_error: f64,
    /// Quantile of 2.5 %.
    pub low: f64,
    /// Quantile of 97.5 %.
    pub high: f64,
    /// Sobol's indices of the inputs in their order, if they were requested and the figure varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub indices: Option<Vec<Index>>,
}

/// Spread from derivatives: `sd² = Σ (∂q/∂p sd_p)²`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FirstOrder {
    /// Standard deviation.
    pub sd: f64,
    /// Share of each input in the variance, in the order of the inputs.
    pub shares: Vec<f64>,
}
