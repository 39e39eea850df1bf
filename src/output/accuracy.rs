//! Text about a requested accuracy.

use super::columns::{bracketed, if_any};
use super::numbers::{counted, error_percent, significant};
use crate::run::summary::{Accuracy, ErrorEstimate};

/// Largest number of errors listed.
const LISTED: usize = 4;

/// Requested accuracy, largest errors, and mesh and tolerance, as two lines.
pub fn describe(found: &Accuracy) -> String {
    format!(
        "accuracy {}; largest errors: {}\nwith {}\n",
        reached(found),
        largest(found).join("; "),
        setting(found)
    )
}

/// Requested accuracy, and whether it is reached.
pub fn reached(found: &Accuracy) -> String {
    let verb = if found.reached { "reached" } else { "not reached" };
    format!("{} {verb}", error_percent(found.asked))
}

/// Mesh, tolerance, and the number of coarser computations before.
pub fn setting(found: &Accuracy) -> String {
    let before = if_any(found.pilots.len(), |n| {
        format!(", after {}", counted(n as u64, "coarser computation"))
    });
    let rtol = significant(found.rtol, 1);
    format!(
        "{}, {} a bladder, rtol {rtol}{before}",
        found.cells(),
        found.cells_per_bladder
    )
}

/// The largest errors, with their contributions if known.
pub fn largest(found: &Accuracy) -> Vec<String> {
    let mut worst: Vec<(&String, &ErrorEstimate)> = found.quantities.iter().collect();
    worst.sort_by(|a, b| b.1.total.unwrap_or(f64::MAX).total_cmp(&a.1.total.unwrap_or(f64::MAX)));
    let texts = worst.into_iter().take(LISTED).map(|(name, e)| {
        let Some(total) = e.total else {
            return format!("{name} unknown");
        };
        let parts = [("steps", e.time), ("meshes", e.space), ("effects", e.effects)];
        let parts = parts
            .iter()
            .filter_map(|(what, part)| Some(format!("{what} {}", error_percent((*part)?))));
        format!("{name} {}{}", error_percent(total), bracketed(parts, ", "))
    });
    texts.collect()
}
