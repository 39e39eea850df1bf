//! A row of `verify --json`: an exact result against a computed one.

use serde::{Deserialize, Serialize};

use super::Kept;
use crate::error;
use crate::run::null;
use crate::study::verify::{self, Measure};

/// An exact result with what came of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name.
    pub name: String,
    /// Where the answer comes from.
    pub source: String,
    /// What it shows.
    pub goal: String,
    /// Why the tolerances are what they are.
    pub tolerance_reason: String,
    /// Whether all figures are as they should be, and there is one.
    pub passed: bool,
    /// The figures, where they could be computed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figures: Option<Vec<Figure>>,
    /// Why they could not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl Kept for Row {}

impl Row {
    /// Of a row and its figures.
    pub fn of(row: &verify::Row, figures: &error::Result<Vec<verify::Figure>>) -> Self {
        Self {
            name: row.name.clone(),
            source: row.source.into(),
            goal: row.goal.into(),
            tolerance_reason: row.reason.into(),
            passed: figures
                .as_ref()
                .is_ok_and(|all| !all.is_empty() && all.iter().all(verify::Figure::passed)),
            figures: figures.as_ref().ok().map(|all| all.iter().map(Figure::of).collect()),
            failure: figures.as_ref().err().map(ToString::to_string),
        }
    }
}

/// One number, computed and exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// What it is, with its unit.
    pub quantity: String,
    /// As computed.
    #[serde(deserialize_with = "null::number")]
    pub computed: f64,
    /// Exact value.
    #[serde(deserialize_with = "null::number")]
    pub exact: f64,
    /// Error.
    #[serde(deserialize_with = "null::number")]
    pub error: f64,
    /// Relative or absolute.
    pub error_is: Measure,
    /// Largest error accepted.
    pub tolerance: f64,
    /// Order in the mesh size.
    pub order: Option<f64>,
    /// Error of the limit to which meshes point.
    pub limit_error: Option<f64>,
    /// The largest accepted.
    pub limit_tolerance: Option<f64>,
    /// Error that the meshes alone show.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimate: Option<f64>,
    /// Whether error, order, limit and estimate are as they should be.
    pub passed: bool,
}

impl Figure {
    fn of(figure: &verify::Figure) -> Self {
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
