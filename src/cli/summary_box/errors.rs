//! Errors of figures in the box.

use super::{BETWEEN, hold};
use crate::output::numbers::{counted, duration, quantity, significant, with_error};
use crate::run::summary::{Status, Summary};

/// A figure with its error, if known.
pub(super) fn figure(summary: &Summary, (name, figure): (&str, &str), value: f64, unit: &str) -> String {
    hold(match summary.error(name, figure) {
        Some(error) => with_error(value, error, unit),
        None => quantity(value, unit, 3),
    })
}

/// Source of the errors of figures, or the reason why there are none.
pub(super) fn errors(summary: &Summary) -> Option<String> {
    if summary.accuracy.is_some() || summary.status != Status::Finished {
        return None;
    }
    let Some(companion) = &summary.companion else {
        return Some("no error bars: no companion ran".into());
    };
    if let Some(reason) = &companion.reason {
        return Some(format!("no error bars: {reason}"));
    }
    let effects = match companion.added_effects.len() {
        0 => String::new(),
        n => format!(", {} more", counted(n as u64, "effect")),
    };
    Some(format!(
        "± by a companion run: {} per segment, {} per bladder, rtol {}{effects}{BETWEEN}{}",
        counted(companion.cells_per_segment as u64, "cell"),
        companion.cells_per_bladder,
        significant(companion.rtol, 1),
        hold(duration(companion.wall_s))
    ))
}
