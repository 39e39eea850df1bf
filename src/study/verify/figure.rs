//! One number, computed and exact.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::fit::richardson;

/// Whether an error is relative to the exact value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// `|computed - exact|/|exact|`.
    Relative,
    /// `|computed - exact|`, in the unit of the quantity.
    Absolute,
}

/// One number of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it is, with its unit: `tip angle [rad]`.
    pub quantity: String,
    /// As computed, on the finest mesh where there are several.
    pub computed: f64,
    /// Exact value.
    pub exact: f64,
    /// What the tolerances bound.
    pub measure: Measure,
    /// Largest error accepted.
    pub tolerance: f64,
    /// Order in the mesh size observed between the two finer meshes.
    pub order: Option<f64>,
    /// Orders accepted.
    pub orders: RangeInclusive<f64>,
    /// Error of the limit that the two finer meshes point to (Richardson), and the largest accepted.
    pub limit: Option<(f64, f64)>,
    /// Error that the meshes alone show, which is to cover the true one up to the round-off beside it.
    pub estimate: Option<(f64, f64)>,
}

/// Orders accepted where second order is due.
const SECOND_ORDER: RangeInclusive<f64> = 1.8..=2.2;

impl Figure {
    /// A number with a tolerance relative to its exact value.
    pub fn relative(quantity: impl Into<String>, computed: f64, exact: f64, tolerance: f64) -> Self {
        Self {
            quantity: quantity.into(),
            computed,
            exact,
            measure: Measure::Relative,
            tolerance,
            order: None,
            orders: SECOND_ORDER,
            limit: None,
            estimate: None,
        }
    }

    /// A number with a tolerance in its own unit.
    pub fn absolute(quantity: impl Into<String>, computed: f64, exact: f64, tolerance: f64) -> Self {
        Self {
            measure: Measure::Absolute,
            ..Self::relative(quantity, computed, exact, tolerance)
        }
    }

    /// Three meshes, each twice as fine as the one before: second order is due, and the limit within `limit`.
    pub fn on_meshes(self, values: [f64; 3], limit: f64) -> Self {
        let [_, middle, fine] = values;
        let order = ((middle - self.exact) / (fine - self.exact)).abs().log2();
        let extrapolated = Self {
            computed: richardson(middle, fine),
            ..self.clone()
        };
        Self {
            order: Some(order),
            limit: Some((extrapolated.error(), limit)),
            ..self
        }
    }

    /// Error, relative or absolute as [`Figure::measure`] says.
    pub fn error(&self) -> f64 {
        let difference = (self.computed - self.exact).abs();
        match self.measure {
            Measure::Relative => difference / self.exact.abs(),
            Measure::Absolute => difference,
        }
    }

    /// Whether error, order, limit and estimate are as they should be. Not a number is not.
    pub fn passed(&self) -> bool {
        self.error() <= self.tolerance
            && self.order.is_none_or(|order| self.orders.contains(&order))
            && self.limit.is_none_or(|(error, largest)| error <= largest)
            && self
                .estimate
                .is_none_or(|(shown, noise)| self.error() <= shown.max(noise))
    }
}
