//! Exact results, beside what the crate computes on successive meshes.

mod channels;
mod prisms;
mod tube;

use crate::error::Error;
use crate::estimate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One exact result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Comparison {
    /// What is compared, with its unit.
    pub name: String,
    /// Where the exact value is from.
    pub source: String,
    /// The exact value.
    pub exact: f64,
    /// Computed on successive meshes, the coarsest first.
    pub computed: Vec<f64>,
    /// Observed order of the last two errors; None where they are round-off or change sign.
    pub order: Option<f64>,
}

/// Relative errors below this are round-off: the condition number of a cell near incompressibility times 1e-16.
pub const ROUND_OFF: f64 = 1e-10;

impl Comparison {
    /// Of a value on successive meshes with an exact one.
    pub fn new(name: impl Into<String>, source: &str, exact: f64, computed: Vec<f64>) -> Self {
        let scale = if exact == 0.0 { 1.0 } else { exact.abs() };
        let errors: Vec<f64> = computed.iter().map(|c| (c - exact) / scale).collect();
        // Errors that change sign on their way show no order.
        let one_sided = errors.iter().all(|e| e * errors[0] > 0.0);
        let last = errors.last_chunk::<2>().filter(|e| one_sided && e[1].abs() > ROUND_OFF);
        let order = last.map(|[a, b]| (a / b).log2());
        Self {
            name: name.into(),
            source: source.to_owned(),
            exact,
            computed,
            order,
        }
    }

    /// Relative error on the finest mesh; absolute where the exact value is zero.
    pub fn error(&self) -> f64 {
        let scale = if self.exact == 0.0 { 1.0 } else { self.exact.abs() };
        self.computed
            .last()
            .map_or(f64::NAN, |c| (c - self.exact).abs() / scale)
    }

    /// Whether the error estimated from the meshes alone covers the true one.
    pub fn is_covered(&self) -> bool {
        self.error() <= ROUND_OFF || estimate::estimate(&self.computed, estimate::SMOOTH).relative_error >= self.error()
    }
}

/// All comparisons.
pub fn verify() -> Result<Vec<Comparison>, Error> {
    let mut all = prisms::compare()?;
    all.extend(tube::compare()?);
    all.extend(channels::compare()?);
    all.extend(prisms::others()?);
    Ok(all)
}
