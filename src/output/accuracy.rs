//! An accuracy that was asked for, in words.

use serde_json::Value;

use super::numbers::{count, significant};
use crate::run::summary::Accuracy;
use crate::study::refine::meshes::Meshes;

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
        "accuracy {} {}; estimated relative errors: {}\nwith {} cells a segment, {} a bladder, rtol {}, after {} computations\n",
        significant(found.asked, 2),
        if found.reached { "reached" } else { "not reached" },
        told.collect::<Vec<_>>().join("; "),
        found.cells_per_segment,
        found.cells_per_bladder,
        significant(found.rtol, 1),
        count(found.pilots.len() as u64)
    )
}

/// A JSON object with what to know of the case.
pub(super) fn with_warnings(mut value: Value, warnings: &[String]) -> Value {
    if let Some(object) = value.as_object_mut() {
        object.insert("warnings".into(), serde_json::to_value(warnings).unwrap_or_default());
    }
    value
}

/// A JSON object with what meshes do under its key, where they were compared.
pub(super) fn with_meshes(mut value: Value, found: Option<&Meshes>) -> Value {
    if let (Some(object), Some(found)) = (value.as_object_mut(), found) {
        object.insert("meshes".into(), serde_json::to_value(found).unwrap_or_default());
    }
    value
}

/// A JSON object with the accuracy under its key, where one was asked for.
pub(super) fn with_accuracy(mut value: Value, found: Option<&Accuracy>) -> Value {
    if let (Some(object), Some(found)) = (value.as_object_mut(), found) {
        object.insert("accuracy".into(), serde_json::to_value(found).unwrap_or_default());
    }
    value
}
