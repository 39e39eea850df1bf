//! Result of an optimization, as in its file.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::REACHED;
use super::problem::{FigureLimit, Goal};
use super::search::OptimizationOutcome;
use super::wiring::Alternative;
use crate::error::Result;
use crate::numerics::sqp::HELD;
use crate::study::analysis::AnalysisKind;
pub use crate::study::search_bounds::Bound;

/// Result of an optimization.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// Name of the case.
    pub case: String,
    /// Analysis of every design.
    pub command: AnalysisKind,
    /// Goal.
    pub goal: Goal,
    /// True if the search ended at an optimum within bounds and limits, according to derivatives.
    pub found: bool,
    /// Figure at the optimum, in its unit.
    pub value: f64,
    /// Figure of the plain command at the optimum; `None` if that failed.
    pub plain: Option<f64>,
    /// Estimated absolute error due to steps, mesh and omitted effects.
    pub error: Option<f64>,
    /// Figure at the first start.
    pub begin: Option<f64>,
    /// Compared alternatives, each at its optimum; empty if there was no choice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<ComparedAlternative>,
    /// Index of the best alternative, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chosen: Option<usize>,
    /// Optimized numbers.
    pub variables: Vec<Variable>,
    /// Limits of other figures.
    pub limits: Vec<LimitAtOptimum>,
    /// Second derivatives of the figure with respect to numbers between their bounds; `None` if a limit is active, or
    /// if they are not available.
    pub curvature: Option<Curvature>,
    /// Reason why the best search ended; `None` if no numbers were optimized.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ended: Option<String>,
    /// Source of the derivatives.
    pub derivatives: DerivativeSource,
    /// Searches; the first starts from the case's own numbers.
    pub starts: Vec<OptimizationStart>,
    /// Number of designs computed for the search.
    pub evaluations: usize,
    /// Number of failed designs by reason.
    pub failed: BTreeMap<String, usize>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Wall time [s].
    pub wall_s: f64,
}

/// Alternative at its optimum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedAlternative {
    /// Name.
    pub name: String,
    /// Settings in the case, each as `POINTER=JSON`.
    pub sets: Vec<String>,
    /// Figure at its optimum; `None` if no design could be computed.
    pub value: Option<f64>,
    /// True if the limits are met there.
    pub held: bool,
    /// Values of the numbers there.
    pub values: Vec<f64>,
    /// Reason why there is no result.
    pub reason: Option<String>,
}

impl ComparedAlternative {
    /// Summarizes the end of the search with an alternative.
    pub(super) fn new(alternative: &Alternative, reached: &Result<OptimizationOutcome>) -> Self {
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

/// Source of the derivatives of figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DerivativeSource {
    /// Exact derivatives, those of `--sensitivity`.
    Exact,
    /// Differences of designs, two for each number.
    Differences,
}

/// Optimized number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variable {
    /// JSON pointer into the case.
    pub pointer: String,
    /// Lower bound, in the unit that the key names.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
    /// True if the search used its logarithm.
    pub logarithmic: bool,
    /// Value at the first start.
    pub start: f64,
    /// Value at the optimum.
    pub value: f64,
    /// Bound at which it lies.
    pub at_bound: Option<Bound>,
    /// Gain of the figure per unit by which that bound is moved; positive for an improvement.
    pub gain: Option<f64>,
    /// Values on both sides at which the figure would be worse by 1 %, with the others fixed, according to the
    /// curvature.
    pub within_1_percent: Option<[f64; 2]>,
}

/// Limit at the optimum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LimitAtOptimum {
    /// The limit.
    #[serde(flatten)]
    pub limit: FigureLimit,
    /// Figure at the optimum.
    pub value: f64,
    /// True if the limit is active.
    pub reached: bool,
    /// Gain of the goal per unit by which the limit is relaxed; `None` if the limit is violated.
    pub gain: Option<f64>,
}

impl LimitAtOptimum {
    /// True if the figure violates the limit.
    pub fn beyond(&self) -> bool {
        self.limit.beyond(self.value) > REACHED * self.limit.bound.abs()
    }
}

impl Optimum {
    /// True if a limit is violated.
    pub fn beyond_limits(&self) -> bool {
        self.limits.iter().any(LimitAtOptimum::beyond)
    }
}

/// Second derivatives of the figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curvature {
    /// Pointers of the numbers, in the order of the rows.
    pub pointers: Vec<String>,
    /// Matrix; with respect to logarithms for numbers that were searched in their logarithms.
    pub matrix: Vec<Vec<f64>>,
}

/// Search from one start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OptimizationStart {
    /// Start.
    pub from: Vec<f64>,
    /// End; `None` if the start could not be computed.
    pub to: Option<Vec<f64>>,
    /// Figure at the end.
    pub value: Option<f64>,
    /// True if the limits are met there.
    pub held: bool,
    /// Number of steps.
    pub steps: usize,
}

/// Computed design: a row of `history.csv`.
#[derive(Clone, Debug, PartialEq)]
pub struct ComputedDesign {
    /// Index of its alternative.
    pub alternative: usize,
    /// Index of the search; the number of searches for designs about the optimum.
    pub start: usize,
    /// Values of the numbers.
    pub values: Vec<f64>,
    /// Figures of goal and limits; `None` if the design failed.
    pub figures: Option<Vec<f64>>,
    /// True if the limits are met.
    pub held: bool,
    /// Reason why it failed.
    pub reason: Option<String>,
    /// Wall time [s].
    pub wall_s: f64,
}
