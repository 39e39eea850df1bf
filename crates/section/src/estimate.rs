//! Error estimates from successive meshes: Richardson extrapolation with the observed order.
//!
//! ```text
//! a_k = a + c h_k^p,  h_k = h_0 / 2^k     =>     2^p = (a_1 - a_0) / (a_2 - a_1),     a - a_2 = (a_2 - a_1) / (2^p - 1)     [R1]
//! ```
//!
//! p is limited to the range from 1/2 to a highest order: [SMOOTH] without singularities (a higher order may be an
//! accident of three meshes), [SHARP] for outlines with corners. There the error of an energy finally decreases with
//! h^(2 lambda), lambda >= 1/2, even if its smooth part decreases faster at first (Williams 1952: lambda 0.545 at a
//! right angle). If differences change sign, no order is observed, and the error is the last difference.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Highest order without singularities.
pub const SMOOTH: f64 = 2.0;
/// Highest order with corners.
pub const SHARP: f64 = 1.0;

/// A value with its relative error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// Value on the finest mesh.
    pub value: f64,
    /// Estimated discretization error over the value.
    pub relative_error: f64,
}

/// Observed order of the last three values; None if their differences change sign or vanish.
pub fn order(values: &[f64]) -> Option<f64> {
    let [a, b, c] = values.last_chunk::<3>()?;
    let ratio = (b - a) / (c - b);
    (ratio.is_finite() && ratio > 0.0).then(|| ratio.log2())
}

/// Error of the last value [R1], with an order of at most `most`.
pub fn error(values: &[f64], most: f64) -> f64 {
    let [b, c] = values.last_chunk::<2>().copied().unwrap_or([0.0; 2]);
    let factor = order(values).map_or(1.0, |p| 2.0_f64.powf(p.clamp(0.5, most)) - 1.0);
    (c - b).abs() / factor
}

/// The last value with its error [R1].
pub fn estimate(values: &[f64], most: f64) -> Estimate {
    let value = values.last().copied().unwrap_or(0.0);
    let relative_error = if value == 0.0 {
        0.0
    } else {
        error(values, most) / value.abs()
    };
    Estimate { value, relative_error }
}
