//! Warnings in the box: the most severe in full, the others by their titles.

use crate::error::Code;

/// Largest number of warnings in full.
const IN_FULL: usize = 3;
/// Warnings that precede all others: results may be invalid.
const SEVERE: [Code; 5] = [
    Code::Growth,
    Code::EnergyFigure,
    Code::Mathieu,
    Code::EnergyOpen,
    Code::BeyondRange,
];

/// Warnings in full, and a line with the titles of the others.
pub(super) fn divide(warnings: &[String]) -> (Vec<&str>, Option<String>) {
    let mut all: Vec<&str> = warnings.iter().map(String::as_str).collect();
    all.sort_by_key(|warning| rank(code(warning)));
    let others = all.split_off(all.len().min(IN_FULL));
    (all, titles(&others))
}

/// Code of a warning.
fn code(warning: &str) -> Option<Code> {
    Code::find(warning.split_once(' ')?.0)
}

/// Place in the order of severity.
fn rank(code: Option<Code>) -> usize {
    let place = SEVERE.iter().position(|severe| code == Some(*severe));
    place.unwrap_or(SEVERE.len())
}

/// Each code once, with its title; warnings without code are counted.
fn titles(warnings: &[&str]) -> Option<String> {
    let mut codes: Vec<Code> = vec![];
    let mut others = 0;
    for warning in warnings {
        match code(warning) {
            Some(code) if codes.contains(&code) => {}
            Some(code) => codes.push(code),
            None => others += 1,
        }
    }
    let mut all: Vec<String> = codes.iter().map(|c| format!("{} {}", c.id(), c.title())).collect();
    if others > 0 {
        all.push(format!("{others} more"));
    }
    let explain = codes.first().map(|code| format!(" (slcbeam explain {})", code.id()));
    let explain = explain.unwrap_or_default();
    (!all.is_empty()).then(|| format!("others in summary.json: {}{explain}", all.join(", ")))
}
