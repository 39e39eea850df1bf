//! Reads a result folder into memory, for comparison with another.

use std::io;
use std::path::Path;

use super::arrays::TIMES;
use super::envelope::table;
use super::folder::{CASE, FIELDS, HISTORY, damaged, fault, text_of};
use super::npz::Npz;
use super::summary;
use crate::error::Result;
use crate::output::numbers::counted;
use crate::results;
use crate::study::compare::{Array, Recording, Series};

/// Reads all files of a result.
pub fn read(dir: &Path) -> Result<Recording> {
    let path = dir.join(CASE);
    let text = text_of(&path)?;
    let wrong = |e| fault("read", &path, e);
    let (case, known) = (
        results::parse(&text).map_err(wrong)?,
        results::parse(&text).map_err(wrong)?,
    );
    let summary = summary::read(dir)?;
    summary::verify_table(dir, HISTORY, &summary)?;
    let path = dir.join(HISTORY);
    let mut columns = history(&path)?;
    if columns.is_empty() {
        let why = damaged("it has no columns");
        return Err(fault("read", &path, why));
    }
    let times = columns.remove(0).values;
    if let Err(k) = ascending(&times) {
        let why = damaged(format!("its times are not in order at row {k}"));
        return Err(fault("read", &path, why));
    }
    let mut out = Recording {
        label: dir.display().to_string(),
        case,
        known,
        summary,
        times,
        columns,
        field_times: vec![],
        axes: vec![],
        fields: vec![],
    };
    let path = dir.join(FIELDS);
    arrays(&path, &mut out).map_err(|e| fault("read", &path, e))?;
    Ok(out)
}

/// Reads the columns. Omits an incomplete last row of an interrupted run.
fn history(path: &Path) -> Result<Vec<Series>> {
    let (names, mut rows) = table(path)?;
    let empty = |(name, unit)| Series {
        name,
        unit,
        values: vec![],
    };
    let mut columns: Vec<Series> = names.into_iter().map(empty).collect();
    while let Some(row) = rows.next()?.filter(|row| row.len() == columns.len()) {
        for (column, value) in columns.iter_mut().zip(row) {
            column.values.push(*value);
        }
    }
    Ok(columns)
}

/// Reads axes and fields. Each field must have as many instants as there are times.
fn arrays(path: &Path, out: &mut Recording) -> io::Result<()> {
    let mut npz = Npz::open(path)?;
    for entry in npz.entries().to_vec() {
        let values = npz.read(&entry.name)?;
        match entry.shape.as_slice() {
            [_] if entry.name == TIMES => out.field_times = values,
            [_] => out.axes.push((entry.name, values)),
            _ => out.fields.push(Array {
                len: entry.width(),
                name: entry.name,
                values,
            }),
        }
    }
    let instants = out.field_times.len();
    for field in &out.fields {
        if field.len == 0 || field.values.len() != instants * field.len {
            let rows = field.values.len().checked_div(field.len).unwrap_or(0);
            return Err(damaged(format!(
                "{} has {} of {}, {TIMES} has {instants}",
                field.name,
                counted(rows as u64, "instant"),
                counted(field.len as u64, "place")
            )));
        }
    }
    ascending(&out.field_times).map_err(|k| damaged(format!("{TIMES} is not in order at its number {k}")))
}

/// Checks that numbers are finite and do not decrease. The error is the index of the first that violates this.
fn ascending(numbers: &[f64]) -> std::result::Result<(), usize> {
    let follows = |k: &usize| numbers[*k].is_finite() && (*k == 0 || numbers[*k] >= numbers[*k - 1]);
    (0..numbers.len()).find(|k| !follows(k)).map_or(Ok(()), Err)
}
