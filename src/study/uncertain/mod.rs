//! What uncertain numbers of a case leave open of its figures: to first order, and by samples beside it.
//!
//! ```text
//! samples  which values sample number k has
//! first    derivatives of the figures about the means
//! nothing  figures that are round-off
//! spread   what the figures of all samples tell
//! indices  which share of a variance is whose (Sobol)
//! ```
//!
//! Numbers are taken as independent of each other. Samples are points of Sobol's sequence, its bits shifted by the seed, so that
//! the same seed gives the same spread on every machine.

pub mod first;
pub mod indices;
mod nothing;
pub mod samples;
pub mod spread;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub use first::{Slopes, slopes};
pub use indices::Index;
pub use samples::Plan;
pub use spread::judge;

use crate::run::band::{Band, Bands};

/// What uncertain numbers leave open of the figures of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uncertainty {
    /// Name of the case.
    pub case: String,
    /// Whose figures, as the command is typed.
    pub command: String,
    /// What is uncertain.
    pub inputs: Vec<Input>,
    /// Samples that were drawn.
    pub samples: usize,
    /// Those of them that finished; figures are those of these alone.
    pub finished: usize,
    /// What the others ended with, and how many did.
    pub unfinished: BTreeMap<String, usize>,
    /// The seed.
    pub seed: u64,
    /// Figures by name, unit included, as in the table of `slcbeam sweep`.
    pub figures: BTreeMap<String, Spread>,
    /// Why there are no derivatives; nothing where there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub no_first_order: Option<String>,
    /// What to know before trusting them.
    pub warnings: Vec<String>,
}

impl Uncertainty {
    /// Every figure with its band, as a result has it.
    pub fn bands(&self) -> Bands {
        let band = |one: &Spread| Band {
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
pub struct Input {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Its distribution, as it was asked for.
    pub distribution: String,
    /// Mean, in the unit that the key names.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// A figure and how far it spreads, in its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Of the case itself.
    pub value: f64,
    /// Estimated error of steps, mesh and effects left out, absolute.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub numerical_error: Option<f64>,
    /// To first order about the means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_order: Option<FirstOrder>,
    /// Samples that have the figure.
    pub samples: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation.
    pub sd: f64,
    /// Standard error of the latter, as of independent samples, which points of Sobol's sequence undercut.
    pub sd_error: f64,
    /// Quantile of 2.5 %.
    pub low: f64,
    /// Quantile of 97.5 %.
    pub high: f64,
    /// Sobol's indices, a number each in the order of the inputs, where they were asked for and the figure varies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub indices: Option<Vec<Index>>,
}

/// A spread by derivatives: `sd² = Σ (∂q/∂p sd_p)²`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FirstOrder {
    /// Standard deviation.
    pub sd: f64,
    /// Share of each input in the variance, in their order.
    pub shares: Vec<f64>,
}
