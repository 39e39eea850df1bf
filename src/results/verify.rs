//! A row of `verify --json`: a computed result compared with an exact one.

use serde::{Deserialize, Serialize};

use super::ResultFile;
use crate::error;
use crate::run::json_null;
use crate::study::verify::{self, ErrorMeasure};

/// An exact result, and the computed figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct VerifiedRow {
    /// Name.
    pub name: String,
    /// Source of the exact result.
    pub source: String,
    /// Goal of the comparison.
    pub goal: String,
    /// Reason for the tolerances.
    pub tolerance_reason: String,
    /// True if there is at least one figure and all figures pass.
    pub passed: bool,
    /// Figures, if they could be computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figures: Option<Vec<VerifiedFigure>>,
    /// Reason why the figures could not be computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl ResultFile for VerifiedRow {}

impl VerifiedRow {
    /// Combines a row and its figures.
    pub fn new(row: &verify::SolvedProblem, figures: &error::Result<Vec<verify::ExactFigure>>) -> Self {
        Self {
            name: row.name.clone(),
            source: row.source.into(),
            goal: row.goal.into(),
            tolerance_reason: row.reason.into(),
            passed: figures
                .as_ref()
                .is_ok_and(|all| !all.is_empty() && all.iter().all(verify::ExactFigure::passed)),
            figures: figures
                .as_ref()
                .ok()
                .map(|all| all.iter().map(VerifiedFigure::new).collect()),
            failure: figures.as_ref().err().map(ToString::to_string),
        }
    }
}

/// One number, computed and exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VerifiedFigure {
    /// Quantity with its unit.
    pub quantity: String,
    /// Computed value.
    #[serde(deserialize_with = "json_null::number")]
    pub computed: f64,
    /// Exact value.
    #[serde(deserialize_with = "json_null::number")]
    pub exact: f64,
    /// Error.
    #[serde(deserialize_with = "json_null::number")]
    pub error: f64,
    /// Measure of the error: relative or absolute.
    pub error_is: ErrorMeasure,
    /// Largest error accepted.
    pub tolerance: f64,
    /// Order of convergence in the mesh size.
    pub order: Option<f64>,
    /// Error of the value extrapolated over the meshes.
    pub limit_error: Option<f64>,
    /// Largest accepted error of the extrapolated value.
    pub limit_tolerance: Option<f64>,
    /// Error estimated from the meshes alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
    /// True if error, order, extrapolated value and estimate are as required.
    pub passed: bool,
}

impl VerifiedFigure {
    fn new(figure: &verify::ExactFigure) -> Self {
        Self {
            quantity: figure.quantity.clone(),
            computed: figure.computed,
            exact: figure.exact,
            error: figure.error(),
            error_is: figure.measure,
            tolerance: figure.tolerance,
            order: figure.order,
            limit_error: figure.limit.map(|l| l.0),
            limit_tolerance: figure.limit.map(|l| l.1),
            estimate: figure.estimate.map(|e| e.0),
            passed: figure.passed(),
        }
    }
}
