//! Limits on the number of loads and terms of a case. Larger numbers are never intended, and would take too long.

use serde_json::Value;

use super::faults::Violations;
use crate::error::{Code, Violation};

/// Array limits from this value on bound the work; smaller ones are rules about the meaning.
pub(super) const MANY: u64 = 1000;

/// Largest number of terms of all sums and products of a case; nested terms count at each level. The time to find the extremes of a sum
/// grows with the square of its terms.
const MOST_TERMS: usize = 4000;

/// Fault of an array with too many entries to be checked.
pub(super) fn overfull(pointer: &str, count: u64, most: u64) -> Violation {
    let fault =
        Violation::new(Code::Count, pointer, format!("an array of {count} entries")).allowed(format!("at most {most}"));
    if pointer.ends_with("/sum") || pointer.ends_with("/product") {
        return fault.hint("give a table of the result in place of many terms");
    }
    fault
}

/// Reports sums and products that together have more than `MOST_TERMS` terms.
pub(super) fn check(value: &Value, faults: &mut Violations) {
    let count = terms(value);
    if count > MOST_TERMS {
        let what = format!("sums and products of {count} terms in all");
        let fault = Violation::new(Code::Count, "", what).allowed(format!("at most {MOST_TERMS} in a case"));
        faults.push_overfull(fault.hint("give a table of the result in place of many terms"));
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
