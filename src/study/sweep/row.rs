//! Rows of the table of a sweep.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::designs::Design;
use crate::study::analysis::Found;

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number of the design, from 0.
    pub number: usize,
    /// Place of its case in the list of cases, from 0.
    pub case: usize,
    /// Values of what is varied.
    pub values: Vec<Value>,
    /// What was found.
    #[serde(flatten)]
    pub found: Found,
    /// Wall time [s].
    pub wall_s: f64,
}

impl Row {
    /// Of a design.
    pub fn of(design: Design, found: Found, wall_s: f64) -> Self {
        Self {
            number: design.number,
            case: design.case,
            values: design.values,
            found,
            wall_s,
        }
    }
}
