//! An accuracy that was asked for, in words.

use super::numbers::{counted, significant};
use crate::run::summary::Accuracy;

/// Estimates told.
const TOLD: usize = 4;

/// What was asked, what is known of the worst numbers, and how it was reached; a line each.
pub fn words(found: &Accuracy) -> String {
    let mut worst: Vec<_> = found.quantities.iter().collect();
    worst.sort_by(|a, b| b.1.total.unwrap_or(f64::MAX).total_cmp(&a.1.total.unwrap_or(f64::MAX)));
    let told = worst
        .iter()
        .take(TOLD)
        .map(|(name, e)| match (e.total, e.time, e.space) {
            (Some(_), Some(time), Some(space)) => {
                format!(
                    "{name} {} by steps, {} by the mesh",
                    significant(time, 2),
                    significant(space, 2)
                )
            }
            (Some(total), ..) => format!("{name} {}", significant(total, 2)),
            _ => format!("{name} unknown"),
        });
    format!(
        "accuracy {} {}; estimated relative errors: {}\nwith {}, {} a bladder, rtol {}, after {}\n",
        significant(found.asked, 2),
        if found.reached { "reached" } else { "not reached" },
        told.collect::<Vec<_>>().join("; "),
        found.cells(),
        found.cells_per_bladder,
        significant(found.rtol, 1),
        counted(found.pilots.len() as u64, "computation")
    )
}
