//! Spread of a result's figure due to uncertain numbers of the case.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Spread of a figure over samples of the uncertain numbers, in the unit of the figure, and its numerical error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// The figure of the case itself.
    pub value: f64,
    /// Estimated absolute error of time steps, mesh and neglected effects; absent if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<f64>,
    /// Standard deviation of the samples.
    pub sd: f64,
    /// Quantile of 2.5 % of the samples.
    pub low: f64,
    /// Quantile of 97.5 % of the samples.
    pub high: f64,
    /// Number of samples that have the figure.
    pub samples: usize,
    /// Number of samples drawn; the remaining ones ended early.
    pub drawn: usize,
}

/// Bands by figure; empty if the case declares no uncertain number.
pub type Bands = BTreeMap<String, Band>;
