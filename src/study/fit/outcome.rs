//! Result of a fit, as in its file.

use serde::{Deserialize, Serialize};

use super::abscissa::{DrivenNumber, FitAnalysis};
use super::robust::LossFunction;
use crate::run::json_null;
use crate::study::data::Match;
pub use crate::study::search_bounds::Bound;

/// Result of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Name of the case.
    pub case: String,
    /// File of the data.
    pub data: String,
    /// Checksum of the data file.
    pub data_crc32: u32,
    /// Analysis of the case: a run, equilibria or a frequency response.
    pub command: FitAnalysis,
    /// Input of a frequency response: the JSON pointer of a signal of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input: Option<String>,
    /// Numbers of the case that each row of the data sets.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drives: Vec<DrivenNumber>,
    /// True if the search ended at a minimum, as far as the data determine it.
    pub found: bool,
    /// True if the search was stopped early: estimates are the best so far.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub interrupted: bool,
    /// Estimates.
    pub parameters: Vec<FittedNumber>,
    /// Covariance of the estimates, in their units; `None` for a number that is held at a bound or not determined.
    pub covariance: Vec<Vec<Option<f64>>>,
    /// Correlation of the estimates; `None` as in `covariance`.
    pub correlation: Vec<Vec<Option<f64>>>,
    /// Columns of the data.
    pub columns: Vec<FittedColumn>,
    /// Headings of the columns that the fit does not use.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_alone: Vec<String>,
    /// Number of measured values.
    pub observations: usize,
    /// Weighted sum of the squares of residuals over their standard deviations.
    pub chi_square: f64,
    /// Number of measured values minus number of fitted numbers that are not at a bound.
    pub degrees_of_freedom: f64,
    /// Loss function.
    pub loss: LossFunction,
    /// Directions that the data do not determine, described in sentences.
    pub unseen: Vec<String>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Error of the simulator.
    pub simulator: SimulatorError,
    /// Searches from all starts.
    pub starts: Vec<FitStart>,
    /// Total number of steps of all searches.
    pub steps: usize,
    /// Number of simulations of all data.
    pub simulations: usize,
    /// Wall time [s].
    pub wall_s: f64,
}

/// Estimate of a number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedNumber {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// True if the search used its logarithm, in which the interval is symmetric.
    pub logarithmic: bool,
    /// Start of the search.
    pub start: f64,
    /// The estimate.
    pub value: f64,
    /// Standard error; `None` at a bound, or if the data determine it only together with a number at a bound, or not at
    /// all.
    pub standard_error: Option<f64>,
    /// Interval of 95 % confidence, limited to the bounds.
    pub interval_95: Option<[f64; 2]>,
    /// Bound at which it lies.
    pub at_bound: Option<Bound>,
    /// Change of the estimate on a finer mesh with a tenth of the tolerance.
    pub finer_change: Option<f64>,
}

/// Column of the data compared with its quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedColumn {
    /// Requested assignment.
    pub matched: Match,
    /// Name of the quantity with its unit.
    pub quantity: String,
    /// Deviations of the quantity from the column.
    #[serde(flatten)]
    pub left: ColumnResiduals,
    /// Standard deviation of its noise in the unit of the quantity; the mean if it differs between rows.
    pub noise: f64,
    /// True if the noise was given; otherwise it is estimated from the residuals.
    pub noise_given: bool,
}

/// Deviations of a quantity from a column, in the unit of the quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ColumnResiduals {
    /// Number of values.
    pub count: usize,
    /// Root mean square of quantity minus data.
    pub rms: f64,
    /// Largest absolute deviation.
    pub max: f64,
    /// `rms` relative to the largest value of the data; not finite if all data are zero.
    #[serde(deserialize_with = "json_null::number")]
    pub rms_relative: f64,
    /// `max` relative to the largest value of the data; not finite if all data are zero.
    #[serde(deserialize_with = "json_null::number")]
    pub max_relative: f64,
    /// Mean of quantity less data.
    pub bias: f64,
    /// `1 - sum e²/sum (y - mean y)²`; not finite if all data are equal.
    #[serde(deserialize_with = "json_null::number")]
    pub r_squared: f64,
    /// Correlation of the residuals of successive rows.
    #[serde(deserialize_with = "json_null::number")]
    pub lag_1: f64,
}

impl ColumnResiduals {
    /// Computes the deviations of model values from data.
    pub fn compare(model: &[f64], data: &[f64]) -> Self {
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

/// Error of the simulator in the estimates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SimulatorError {
    /// Mesh and tolerance of the additional, finer simulation at the estimates.
    pub finer: String,
    /// Reason why that simulation failed, if it did.
    pub unknown: Option<String>,
}

/// Search from one start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitStart {
    /// Start.
    pub from: Vec<f64>,
    /// End; `None` if the case could not be simulated.
    pub to: Option<Vec<f64>>,
    /// Sum of squares at the end, with the noise that was given or assumed first.
    pub chi_square: Option<f64>,
}
