//! Differences between two cases.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Value that differs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// JSON pointer.
    pub pointer: String,
    /// Value in the first case, null if absent.
    pub a: Value,
    /// Value in the second case.
    pub b: Value,
}

/// Pointers of numerical settings, which are not part of the physics.
const NUMERICS: [&str; 7] = [
    "/mesh",
    "/solver",
    "/time/output_interval_s",
    "/time/fields_interval_s",
    "/time/window_s",
    "/time/checkpoint_interval_s",
    "/time/history",
];

/// Pointers of names and descriptions, which are not compared.
const WORDS: [&str; 3] = ["/name", "/about", "/$schema"];

/// Returns the changes of the physics, and the changes of the numerics.
pub fn changes(a: &Value, b: &Value) -> (Vec<Change>, Vec<Change>) {
    let mut all = vec![];
    walk(a, b, String::new(), &mut all);
    all.retain(|c| !WORDS.contains(&c.pointer.as_str()));
    all.into_iter()
        .partition(|c| !NUMERICS.iter().any(|n| c.pointer.starts_with(n)))
}

fn walk(a: &Value, b: &Value, pointer: String, out: &mut Vec<Change>) {
    match (a, b) {
        (Value::Object(x), Value::Object(y)) => {
            for (key, value) in x {
                walk(
                    value,
                    y.get(key).unwrap_or(&Value::Null),
                    format!("{pointer}/{key}"),
                    out,
                );
            }
            for (key, value) in y.iter().filter(|(key, _)| !x.contains_key(*key)) {
                walk(&Value::Null, value, format!("{pointer}/{key}"), out);
            }
        }
        (Value::Array(x), Value::Array(y)) if x.len() == y.len() => {
            for (k, (a, b)) in x.iter().zip(y).enumerate() {
                walk(a, b, format!("{pointer}/{k}"), out);
            }
        }
        // 1 and 1.0 are the same number.
        (Value::Number(x), Value::Number(y)) if x.as_f64() == y.as_f64() => {}
        _ if a == b => {}
        _ => out.push(Change {
            pointer,
            a: a.clone(),
            b: b.clone(),
        }),
    }
}
