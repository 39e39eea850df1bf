//! Rows of the table of a sweep.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::designs::Design;
use crate::study::analysis::AnalysisOutcome;

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Number of the design, from 0.
    pub number: usize,
    /// Index of its case in the list of cases, from 0.
    pub case: usize,
    /// Values of the varied numbers.
    pub values: Vec<Value>,
    /// Results.
    #[serde(flatten)]
    pub found: AnalysisOutcome,
    /// Wall time [s].
    pub wall_s: f64,
}

impl SweepRow {
    /// Creates the row of a design.
    pub fn new(design: Design, found: AnalysisOutcome, wall_s: f64) -> Self {
        Self {
            number: design.number,
            case: design.case,
            values: design.values,
            found,
            wall_s,
        }
    }
}
