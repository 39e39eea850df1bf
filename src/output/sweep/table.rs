//! `sweep.csv`: one row per design.

use std::collections::HashMap;
use std::io::{BufWriter, Write as _};

use serde_json::Value;

use super::TABLE;
use super::journal::JournalSummary;
use crate::error::Result;
use crate::output::folder::{ResultFolder, put_whole};
use crate::output::numbers::shortest;
use crate::output::records;
use crate::results::sweep::{SweepColumn, SweepPlan};
use crate::study::analysis::word;
use crate::study::sweep::SweepRow;

/// Writes the table.
///
/// # Errors
/// The file cannot be written, or the journal cannot be read.
pub fn write(folder: &ResultFolder, plan: &SweepPlan, survey: &JournalSummary, columns: &[SweepColumn]) -> Result<()> {
    let mut reading = Ok(());
    put_whole(&folder.path(TABLE), |file| {
        let mut table = csv::Writer::from_writer(BufWriter::new(file));
        table.write_record(columns.iter().map(|column| &column.name))?;
        reading = survey.each(|row| Ok(table.write_record(cells(plan, survey, &row).into_iter().map(records::cell))?));
        table.into_inner().map_err(|e| e.into_error())?.flush()
    })?;
    reading
}

/// A varied value as a cell.
pub fn cell(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.as_f64().map_or_else(|| number.to_string(), shortest),
        other => other.to_string(),
    }
}

/// A row in the order of the columns.
pub fn cells(plan: &SweepPlan, survey: &JournalSummary, row: &SweepRow) -> Vec<String> {
    let found = &row.found;
    let by_name: HashMap<&str, f64> = found.figures.iter().map(|(name, x)| (name.as_str(), *x)).collect();
    let mut all = Vec::with_capacity(survey.figures.len() + row.values.len() + 7);
    all.push(row.number.to_string());
    all.push(plan.cases[row.case].name.clone());
    all.extend(row.values.iter().map(cell));
    all.push(word(found.status).into());
    all.push(found.reason.clone().unwrap_or_default());
    all.extend(
        survey
            .figures
            .iter()
            .map(|name| by_name.get(name.as_str()).map_or(String::new(), |x| shortest(*x))),
    );
    all.push(found.warnings.join(" "));
    all.push(found.steps.map_or(String::new(), |steps| steps.to_string()));
    all.push(shortest(row.wall_s));
    all
}
