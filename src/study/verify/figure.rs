//! Computed number with its exact value.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::fit::richardson;

/// Measure of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ErrorMeasure {
    /// `|computed - exact|/|exact|`.
    Relative,
    /// `|computed - exact|`, in the unit of the quantity.
    Absolute,
}

/// Number of a row.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactFigure {
    /// Name with unit: `tip angle [rad]`.
    pub quantity: String,
    /// Computed value, on the finest mesh if there are several.
    pub computed: f64,
    /// Exact value.
    pub exact: f64,
    /// Measure of the error that the tolerances limit.
    pub measure: ErrorMeasure,
    /// Largest accepted error.
    pub tolerance: f64,
    /// Order of convergence in the mesh size, observed between the two finer meshes.
    pub order: Option<f64>,
    /// Accepted orders.
    pub orders: RangeInclusive<f64>,
    /// Error of the limit extrapolated from the two finer meshes (Richardson), and the largest accepted one.
    pub limit: Option<(f64, f64)>,
    /// Error estimated from the meshes alone, and the rounding error; the larger of both must cover the true error.
    pub estimate: Option<(f64, f64)>,
}

/// Accepted orders for second-order convergence.
const SECOND_ORDER: RangeInclusive<f64> = 1.8..=2.2;

impl ExactFigure {
    /// Creates a number with a tolerance relative to its exact value.
    pub fn relative(quantity: impl Into<String>, computed: f64, exact: f64, tolerance: f64) -> Self {
        Self {
            quantity: quantity.into(),
            computed,
            exact,
            measure: ErrorMeasure::Relative,
            tolerance,
            order: None,
            orders: SECOND_ORDER,
            limit: None,
            estimate: None,
        }
    }

    /// Creates a number with a tolerance in its own unit.
    pub fn absolute(quantity: impl Into<String>, computed: f64, exact: f64, tolerance: f64) -> Self {
        Self {
            measure: ErrorMeasure::Absolute,
            ..Self::relative(quantity, computed, exact, tolerance)
        }
    }

    /// Creates a number from its values on three meshes, as [`ExactFigure::on_meshes`], with a tolerance relative to its
    /// exact value.
    pub fn converging(quantity: &str, values: [f64; 3], exact: f64, tolerance: f64, limit: f64) -> Self {
        Self::relative(quantity, values[2], exact, tolerance).on_meshes(values, limit)
    }

    /// Adds the values on three meshes, each twice as fine as the previous one. They must show second order, and an
    /// error of the limit of at most `limit`.
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

    /// Returns the error, relative or absolute according to [`Figure::measure`].
    pub fn error(&self) -> f64 {
        let difference = (self.computed - self.exact).abs();
        match self.measure {
            ErrorMeasure::Relative => difference / self.exact.abs(),
            ErrorMeasure::Absolute => difference,
        }
    }

    /// True if error, order, limit and estimate are acceptable; NaN is not.
    pub fn passed(&self) -> bool {
        self.error() <= self.tolerance
            && self.order.is_none_or(|order| self.orders.contains(&order))
            && self.limit.is_none_or(|(error, largest)| error <= largest)
            && self
                .estimate
                .is_none_or(|(shown, noise)| self.error() <= shown.max(noise))
    }
}
