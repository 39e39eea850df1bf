//! Bounds and text forms of numbers.

use serde_json::{Number, Value};

use crate::error::{Code, Violation, numbers};

/// Fault of a number that violates its `schema`.
pub fn fault(number: &Number, schema: &Value, pointer: &str) -> Option<Violation> {
    let whole = schema.get("type").and_then(Value::as_str) == Some("integer");
    if whole && !(number.is_i64() || number.is_u64()) {
        let fault = Violation::new(Code::Range, pointer, format!("{number} is not a whole number"));
        let value = number.as_f64().unwrap_or(f64::NAN);
        let hint = (value.fract() == 0.0 && value.abs() < 1e15).then(|| format!("write {value:.0}"));
        return Some(Violation {
            hint,
            ..fault.allowed(range(schema))
        });
    }
    let value = number.as_f64()?;
    let bound = |key: &str| schema.get(key).and_then(Value::as_f64);
    let inside = one_of(schema).is_none_or(|all| all.contains(&value))
        && bound("minimum").is_none_or(|b| value >= b)
        && bound("maximum").is_none_or(|b| value <= b)
        && bound("exclusiveMinimum").is_none_or(|b| value > b)
        && bound("exclusiveMaximum").is_none_or(|b| value < b);
    (!inside).then(|| Violation::new(Code::Range, pointer, format!("{number} is out of range")).allowed(range(schema)))
}

/// Allowed numbers, if the schema lists them.
fn one_of(schema: &Value) -> Option<Vec<f64>> {
    let all = schema.get("enum")?.as_array()?;
    Some(all.iter().filter_map(Value::as_f64).collect())
}

/// Range of a number, as text.
fn range(schema: &Value) -> String {
    if let Some(all) = one_of(schema) {
        return all.into_iter().map(plain).collect::<Vec<_>>().join(" or ");
    }
    let bound = |key: &str, words: &str| schema.get(key)?.as_f64().map(|b| format!("{words} {}", plain(b)));
    let low = bound("minimum", "at least").or_else(|| bound("exclusiveMinimum", "greater than"));
    let high = bound("maximum", "at most").or_else(|| bound("exclusiveMaximum", "less than"));
    let kind = match schema.get("type").and_then(Value::as_str) {
        Some("integer") => "whole numbers",
        _ => "numbers",
    };
    match (low, high) {
        (Some(low), Some(high)) => format!("{kind} {low} and {high}"),
        (Some(one), None) | (None, Some(one)) => format!("{kind} {one}"),
        (None, None) => kind.to_owned(),
    }
}

/// Formats a number in its usual form: `0` for `0.0`, `1e-13` for a very small one.
pub fn plain(number: f64) -> String {
    let size = number.abs();
    if size == 0.0 || (1e-3..1e6).contains(&size) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

/// Formats a computed number without the rounding errors of binary fractions.
pub fn rounded(number: f64) -> String {
    plain(numbers::rounded(number, 9))
}

/// Formats a number with three significant digits.
pub fn digits(number: f64) -> String {
    plain(numbers::rounded(number, 3))
}
