//! Writes and reads `summary.json`. Numbers that are not finite are null, or omitted from maps.

use std::path::{Path, PathBuf};

use super::folder::{ResultFolder, SUMMARY, damaged, fault, open};
use super::stream::StreamMark;
use crate::error::Result;
use crate::results::run::{Quantity, Summary};
use crate::results::{self, StoredResult};

/// First format with a complete wall time. Earlier totals exclude the time before and after the run.
const WHOLE_WALL: u32 = 2;

/// The text of `summary.json`.
pub fn to_json(summary: &Summary) -> String {
    let mut summary = summary.clone();
    // serde_json writes non-finite numbers as null; keys that can be omitted are omitted.
    summary.balances.energy_j.retain(|_, x| x.is_finite());
    summary.characteristic.retain(|_, x| x.is_finite());
    let derivatives = summary
        .sensitivities
        .values_mut()
        .flat_map(|s| s.quantities.values_mut().chain(s.probes.values_mut()));
    let own = summary.quantities.values_mut().chain(summary.probes.values_mut());
    let own = own.chain(summary.ports.values_mut());
    for q in own.chain(derivatives) {
        *q = Quantity {
            last: finite(q.last),
            max_abs: finite(q.max_abs),
            max_abs_at_s: finite(q.max_abs_at_s),
            extreme: finite(q.extreme),
            window_extreme: finite(q.window_extreme),
            window_max_abs: finite(q.window_max_abs),
            window_rms: finite(q.window_rms),
            window: finite(q.window),
            window_power_w: finite(q.window_power_w),
            final_error: finite(q.final_error),
            window_error: finite(q.window_error),
            ..*q
        };
    }
    results::text(&summary)
}

/// Writes `summary.json` and returns its path.
pub fn write(folder: &ResultFolder, summary: &Summary) -> Result<PathBuf> {
    folder.write(SUMMARY, to_json(summary).as_bytes())
}

/// Reads the summary of a result folder; nulls come back as NaN.
pub fn read(dir: &Path) -> Result<Summary> {
    Ok(found(dir)?.result)
}

/// Reads the summary of a result folder with its header.
pub fn found(dir: &Path) -> Result<StoredResult<Summary>> {
    let mut found: StoredResult<Summary> = super::folder::result(&dir.join(SUMMARY))?;
    if found.head.format.is_none_or(|format| format < WHOLE_WALL) {
        let wall = &mut found.result.wall_s;
        wall.steps = wall.total - wall.known();
    }
    Ok(found)
}

/// Compares a table with its checksum in the summary of its folder; results of earlier versions have no checksum.
///
/// # Errors
/// The table cannot be read, or it was changed.
pub fn verify_table(dir: &Path, name: &str, summary: &Summary) -> Result<()> {
    let Some(expected) = summary.tables_crc32.get(name) else {
        return Ok(());
    };
    let path = dir.join(name);
    let found = open(&path)
        .and_then(StreamMark::from_reader)
        .map_err(|e| fault("read", &path, e))?;
    if found.crc32 != *expected {
        let why = "it was changed or cut short after the run: its checksum is not that in summary.json";
        return Err(fault("read", &path, damaged(why)));
    }
    Ok(())
}

fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}
