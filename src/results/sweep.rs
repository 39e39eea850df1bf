//! `plan.json` and `sweep.json`: many designs of a case.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::Kept;
pub use crate::study::sweep::{Plan, Row, Shard};

/// What a table of designs is about, and how far it has come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// Name of the first case.
    pub case: String,
    /// As it was asked for.
    pub plan: Plan,
    /// Whether every design of the plan, or of its shard, has a row.
    pub complete: bool,
    /// Rows.
    pub rows: usize,
    /// Designs without one.
    pub missing: usize,
    /// Rows by status.
    pub statuses: BTreeMap<String, usize>,
    /// Columns of the table, in its order.
    pub columns: Vec<Column>,
    /// What to know of the table as a whole.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// A column of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Column {
    /// Its heading.
    pub name: String,
    /// Its array in `sweep.npz`; nothing where it is text.
    pub array: Option<String>,
    /// Its unit: `1` where there is none, `as in the case` where the case's key has it.
    pub unit: String,
}

impl Kept for Plan {}

impl Kept for Sweep {}
