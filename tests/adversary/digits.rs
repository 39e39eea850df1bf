//! Numbers that people read.

use serde_json::{Value, json};

/// A number with four digits: scenes are read by people.
pub fn short(value: f64) -> Value {
    digits(value, 3)
}

/// A number with so many digits behind the first.
pub fn digits(value: f64, count: usize) -> Value {
    json!(format!("{value:.count$e}").parse::<f64>().unwrap_or(value))
}
