//! How many loads and terms a case may have: more is no case that a person means, and takes longer than anyone waits.

use serde_json::Value;

use super::faults::Violations;
use crate::error::{Code, Violation};

/// Bounds from this on say how much is looked at; smaller ones are rules about meaning.
pub(super) const MANY: u64 = 1000;

/// Terms of all sums and products of a case together, those inside each other counted at each level. Finding the extremes of a
/// sum takes time by the square of its terms.
const MOST_TERMS: usize = 4000;

/// The fault of an array of which nothing is looked at, it has so many entries.
pub(super) fn overfull(pointer: &str, count: u64, most: u64) -> Violation {
    let fault =
        Violation::new(Code::Count, pointer, format!("an array of {count} entries")).allowed(format!("at most {most}"));
    if pointer.ends_with("/sum") || pointer.ends_with("/product") {
        return fault.hint("a table says what many terms add up to");
    }
    fault
}

/// Adds a fault where sums and products have more terms together than are looked at.
pub(super) fn check(value: &Value, faults: &mut Violations) {
    let count = terms(value);
    if count > MOST_TERMS {
        let what = format!("sums and products of {count} terms in all");
        let fault = Violation::new(Code::Count, "", what).allowed(format!("at most {MOST_TERMS} in a case"));
        faults.push_overfull(fault.hint("a table says what many terms add up to"));
    }
}

fn terms(value: &Value) -> usize {
    match value {
        Value::Array(items) => items.iter().map(terms).sum(),
        Value::Object(members) => members
            .iter()
            .map(|(key, inner)| {
                let own = inner.as_array().filter(|_| key == "sum" || key == "product");
                own.map_or(0, Vec::len) + terms(inner)
            })
            .sum(),
        _ => 0,
    }
}
