//! What a search for the best finds, as its file holds it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::REACHED;
use super::problem::{Goal, Limit};
use super::search::Reached;
use super::wiring::Alternative;
use crate::error::Result;
use crate::numerics::sqp::HELD;
use crate::study::analysis::AnalysisKind;
pub use crate::study::span::Bound;

/// The best that was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// Name of the case.
    pub case: String,
    /// What every design went through.
    pub command: AnalysisKind,
    /// What is sought.
    pub goal: Goal,
    /// Whether the search ended at a best within bounds and limits, as far as derivatives tell.
    pub found: bool,
    /// The figure there, in its unit.
    pub value: f64,
    /// The same as the plain command gives it; nothing where that failed.
    pub plain: Option<f64>,
    /// Estimated error of steps, mesh and effects left out, absolute.
    pub error: Option<f64>,
    /// The figure where the first search began.
    pub begin: Option<f64>,
    /// Alternatives that were compared, each at its best; nothing where there was no choice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Compared>,
    /// Which of them is best, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen: Option<usize>,
    /// Numbers that were sought.
    pub variables: Vec<Variable>,
    /// What was to be held.
    pub limits: Vec<Held>,
    /// Second derivatives of the figure by numbers between their bounds; nothing where a limit is reached, or where they were not to be
    /// had.
    pub curvature: Option<Curvature>,
    /// Why the search that found the best ended, in words; nothing where no numbers were sought.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended: Option<String>,
    /// Where derivatives came from.
    pub derivatives: Derivatives,
    /// Searches, the first from the case's own numbers.
    pub starts: Vec<Start>,
    /// Designs that were computed for the search.
    pub evaluations: usize,
    /// Why designs had nothing to offer, and how many.
    pub failed: BTreeMap<String, usize>,
    /// What to know first.
    pub warnings: Vec<String>,
    /// Wall time.
    pub wall_s: f64,
}

/// One of what was chosen from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// What it is called.
    pub name: String,
    /// What it sets in the case, each as `POINTER=JSON`.
    pub sets: Vec<String>,
    /// The figure at its best; nothing where no design was to be had.
    pub value: Option<f64>,
    /// Whether limits are held there.
    pub held: bool,
    /// Values of the numbers there.
    pub values: Vec<f64>,
    /// Why there is nothing.
    pub reason: Option<String>,
}

impl Compared {
    /// Of where a search with an alternative ended.
    pub(super) fn of(alternative: &Alternative, reached: &Result<Reached>) -> Self {
        let there = reached.as_ref().ok();
        Self {
            name: alternative.name.clone(),
            sets: alternative.sets.clone(),
            value: there.map(|reached| reached.figures[0]),
            held: there.is_some_and(|reached| reached.minimum.at.violation() <= HELD),
            values: there.map_or_else(Vec::new, |reached| reached.values.clone()),
            reason: reached.as_ref().err().map(ToString::to_string),
        }
    }
}

/// Where derivatives of figures came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Derivatives {
    /// They are exact: those of `--sensitivity`.
    Exact,
    /// Differences of designs, two for each number.
    Differences,
}

/// A number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variable {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// Whether it was sought by its logarithm.
    pub logarithmic: bool,
    /// Where the first search began.
    pub start: f64,
    /// The best.
    pub value: f64,
    /// The bound at which it lies.
    pub at_bound: Option<Bound>,
    /// What the figure would gain for each unit by which that bound were moved; above 0 for better.
    pub gain: Option<f64>,
    /// Values to either side at which the figure would be worse by 1 %, others held, as far as the curvature tells.
    pub within_1_percent: Option<[f64; 2]>,
}

/// A limit at the best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// The limit.
    #[serde(flatten)]
    pub limit: Limit,
    /// The figure.
    pub value: f64,
    /// Whether the figure lies at it.
    pub reached: bool,
    /// What the goal would gain for each unit by which the limit were let go; nothing where it is not held.
    pub gain: Option<f64>,
}

impl Held {
    /// Whether the figure lies beyond it.
    pub fn beyond(&self) -> bool {
        self.limit.beyond(self.value) > REACHED * self.limit.bound.abs()
    }
}

impl Optimum {
    /// Whether a limit is not held.
    pub fn beyond_limits(&self) -> bool {
        self.limits.iter().any(Held::beyond)
    }
}

/// Second derivatives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curvature {
    /// Numbers by which, in their order.
    pub pointers: Vec<String>,
    /// The matrix, by the logarithms of numbers that were sought so.
    pub matrix: Vec<Vec<f64>>,
}

/// A search from one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Where it began.
    pub from: Vec<f64>,
    /// Where it ended; nothing where there was nothing to begin with.
    pub to: Option<Vec<f64>>,
    /// The figure there.
    pub value: Option<f64>,
    /// Whether limits are held there.
    pub held: bool,
    /// Steps it took.
    pub steps: usize,
}

/// A design that was computed: a row of `history.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// Place of its alternative.
    pub alternative: usize,
    /// Number of the search; one more than there are for what is computed about the best.
    pub start: usize,
    /// Values of the numbers.
    pub values: Vec<f64>,
    /// What is sought and what is limited; nothing where the design failed.
    pub figures: Option<Vec<f64>>,
    /// Whether limits are held.
    pub held: bool,
    /// Why it failed.
    pub reason: Option<String>,
    /// Wall time [s].
    pub wall_s: f64,
}
