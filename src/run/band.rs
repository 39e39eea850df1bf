//! A figure of a result beside what uncertain numbers leave open of it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// How far a figure spreads, in its unit, beside its numerical error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// The figure of the case itself.
    pub value: f64,
    /// Estimated error of steps, mesh and effects left out, absolute, where it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<f64>,
    /// Standard deviation of samples.
    pub sd: f64,
    /// Their quantile of 2.5 %.
    pub low: f64,
    /// Their quantile of 97.5 %.
    pub high: f64,
    /// Samples that have the figure.
    pub samples: usize,
    /// Samples that were drawn; others than those ended early.
    pub drawn: usize,
}

/// Bands by figure; none where nothing was said to be uncertain.
pub type Bands = BTreeMap<String, Band>;
