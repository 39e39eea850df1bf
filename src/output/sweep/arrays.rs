//! `sweep.npz`: one array per numeric column, as long as the table; NaN if a row has no value.

use std::collections::HashMap;
use std::io::{BufWriter, Write as _};

use zip::ZipWriter;

use super::journal::JournalSummary;
use super::{ARRAYS, numeric};
use crate::error::Result;
use crate::output::arrays::{FirstErrorWriter, write_array};
use crate::output::folder::{ResultFolder, put_whole};
use crate::results::sweep::{SweepColumn, SweepPlan};
use crate::run::summary::Status;
use crate::study::sweep::SweepRow;

/// Largest number of values in memory. The journal is read once per group of columns within this limit.
const HELD: usize = 4 << 20;

/// Writes the arrays.
///
/// # Errors
/// The file cannot be written, or the journal cannot be read.
pub fn write(folder: &ResultFolder, plan: &SweepPlan, survey: &JournalSummary, columns: &[SweepColumn]) -> Result<()> {
    let rows = survey.count();
    let named: Vec<(&str, &str)> = columns
        .iter()
        .filter_map(|column| Some((column.name.as_str(), column.array.as_deref()?)))
        .collect();
    let at_once = (HELD / rows.max(1)).max(1);
    let mut reading = Ok(());
    put_whole(&folder.path(ARRAYS), |file| {
        let mut npz = ZipWriter::new(BufWriter::new(FirstErrorWriter::new(file)));
        for group in named.chunks(at_once) {
            let mut held = vec![Vec::with_capacity(rows); group.len()];
            let read = survey.each(|row| {
                let by_name = numbers(plan, &row);
                for ((name, _), array) in group.iter().zip(&mut held) {
                    array.push(by_name.get(name).copied().unwrap_or(f64::NAN));
                }
                Ok(())
            });
            if read.is_err() {
                reading = read;
                break;
            }
            for ((_, array), values) in group.iter().zip(held) {
                write_array(&mut npz, array, &[values.len() as u64], values)?;
            }
        }
        npz.finish()?.flush()
    })?;
    reading
}

/// Numbers of a row, by heading.
fn numbers<'a>(plan: &'a SweepPlan, row: &'a SweepRow) -> HashMap<&'a str, f64> {
    let mut all: HashMap<&str, f64> = row.found.figures.iter().map(|(name, x)| (name.as_str(), *x)).collect();
    all.insert("design", row.number as f64);
    all.insert("case", row.case as f64);
    let values = plan.axes.iter().zip(&row.values);
    all.extend(values.filter_map(|(axis, value)| Some((axis.pointer.as_str(), numeric(value)?))));
    all.insert("status", code(row.found.status));
    all.insert("steps", row.found.steps.map_or(f64::NAN, |steps| steps as f64));
    all.insert("wall_s", row.wall_s);
    all
}

/// A status as a number.
fn code(status: Status) -> f64 {
    match status {
        Status::Finished => 0.0,
        Status::Stopped => 1.0,
        Status::OutOfRange => 2.0,
        Status::Failed => 3.0,
    }
}
