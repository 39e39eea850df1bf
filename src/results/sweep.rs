//! `plan.json` and `sweep.json`: many designs of a case.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::ResultFile;
pub use crate::study::sweep::{Shard, SweepPlan, SweepRow};

/// Description and progress of a table of designs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Name of the first case.
    pub case: String,
    /// The requested plan.
    pub plan: SweepPlan,
    /// True if every design of the plan, or of its shard, has a row.
    pub complete: bool,
    /// Number of rows.
    pub rows: usize,
    /// Number of designs without a row.
    pub missing: usize,
    /// Number of rows by status.
    pub statuses: BTreeMap<String, usize>,
    /// Columns of the table, in its order.
    pub columns: Vec<SweepColumn>,
    /// Warnings about the table as a whole.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// A column of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepColumn {
    /// Heading of the column.
    pub name: String,
    /// Name of its array in `sweep.npz`; null for text.
    pub array: Option<String>,
    /// Unit: `1` if dimensionless, `as in the case` if the case's key contains it.
    pub unit: String,
}

impl ResultFile for SweepPlan {}

impl ResultFile for Sweep {}
