//! What a fit finds, as its file holds it.

use serde::{Deserialize, Serialize};

use super::problem::{Drive, Through};
use super::robust::Loss;
use crate::run::null;
use crate::study::data::Match;
pub use crate::study::span::Bound;

/// A fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Name of the case.
    pub case: String,
    /// File of the data.
    pub data: String,
    /// Check sum of its text.
    pub data_crc32: u32,
    /// What the case went through.
    pub command: Through,
    /// Numbers of the case that rows set.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drives: Vec<Drive>,
    /// Whether the search ended at a minimum, as far as the data tell.
    pub found: bool,
    /// Whether somebody ended the search early: estimates are the best so far.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub interrupted: bool,
    /// Estimates.
    pub parameters: Vec<Estimate>,
    /// Covariance of the estimates, in their units; nothing where a number is held at a bound or not determined.
    pub covariance: Vec<Vec<Option<f64>>>,
    /// Their correlation, likewise.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Columns of the data.
    pub columns: Vec<Column>,
    /// Headings of those that say nothing here.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_alone: Vec<String>,
    /// Measured values.
    pub observations: usize,
    /// Sum of the squares of residuals in their standard deviations, weighted.
    pub chi_square: f64,
    /// Measured values less numbers that were fitted.
    pub degrees_of_freedom: f64,
    /// What large residuals count.
    pub loss: Loss,
    /// What the data do not tell, in sentences.
    pub unseen: Vec<String>,
    /// What to know first.
    pub warnings: Vec<String>,
    /// What the simulator itself adds.
    pub simulator: Simulator,
    /// Searches.
    pub starts: Vec<Start>,
    /// Steps of all searches.
    pub steps: usize,
    /// Simulations of the whole of the data.
    pub simulations: usize,
    /// Wall time.
    pub wall_s: f64,
}

/// A number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Whether it was sought by its logarithm, in which its interval is even.
    pub logarithmic: bool,
    /// Where the search began.
    pub start: f64,
    /// The estimate.
    pub value: f64,
    /// Its standard error; nothing at a bound, or where the data determine it only together with a number at a bound, or not at all.
    pub standard_error: Option<f64>,
    /// The interval that holds the truth in 95 of 100 repetitions, cut at the bounds.
    pub interval_95: Option<[f64; 2]>,
    /// The bound at which it lies.
    pub at_bound: Option<Bound>,
    /// How far it would move on a finer mesh with a tenth of the tolerance.
    pub finer_change: Option<f64>,
}

/// A column of the data beside its quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// As it was asked for.
    pub matched: Match,
    /// Name of the quantity with its unit.
    pub quantity: String,
    /// What the column leaves.
    #[serde(flatten)]
    pub left: Left,
    /// Standard deviation of its noise in the quantity's unit, the mean where it differs from row to row.
    pub noise: f64,
    /// Whether the noise was given; else it is what the fit leaves.
    pub noise_given: bool,
}

/// What is between a column and its quantity, in the quantity's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// Values.
    pub count: usize,
    /// Root of the mean square of quantity less data.
    pub rms: f64,
    /// The largest.
    pub max: f64,
    /// Both over the largest value of the data; not finite where all data are zero.
    #[serde(deserialize_with = "null::number")]
    pub rms_relative: f64,
    /// The largest over the largest value of the data, likewise.
    #[serde(deserialize_with = "null::number")]
    pub max_relative: f64,
    /// Mean of quantity less data.
    pub bias: f64,
    /// `1 - sum e²/sum (y - mean y)²`; not finite where all data are alike.
    #[serde(deserialize_with = "null::number")]
    pub r_squared: f64,
    /// Correlation of what is left of one row with that of the next.
    #[serde(deserialize_with = "null::number")]
    pub lag_1: f64,
}

impl Left {
    /// Of values of a model and the data beside them.
    pub fn of(model: &[f64], data: &[f64]) -> Self {
        let count = data.len();
        let n = count.max(1) as f64;
        let errors: Vec<f64> = model.iter().zip(data).map(|(model, data)| model - data).collect();
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let mean = data.iter().sum::<f64>() / n;
        let about: f64 = data.iter().map(|y| (y - mean).powi(2)).sum();
        let largest = |all: &[f64]| all.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let (rms, max) = ((squares / n).sqrt(), largest(&errors));
        let size = largest(data).max(f64::MIN_POSITIVE);
        let beside: f64 = errors.windows(2).map(|pair| pair[0] * pair[1]).sum();
        Self {
            count,
            rms,
            max,
            rms_relative: rms / size,
            max_relative: max / size,
            bias: errors.iter().sum::<f64>() / n,
            r_squared: 1.0 - squares / about,
            lag_1: beside / squares,
        }
    }
}

/// What the simulator adds to the errors of the estimates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Simulator {
    /// With what the data were simulated once more at the estimates.
    pub finer: String,
    /// Why it was not, where it was not.
    pub unknown: Option<String>,
}

/// A search from one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Where it began.
    pub from: Vec<f64>,
    /// Where it ended; nothing where the case could not be simulated.
    pub to: Option<Vec<f64>>,
    /// Sum of the squares there, with the noise that was given or first assumed.
    pub chi_square: Option<f64>,
}
