//! `history.csv`, thinned to the resolution of a screen without loss of peaks.

use serde_json::{Value, json};

use super::base64;
use crate::discrete::quantities::{Group, Observable, QuantityRole};
use crate::error::Result;
use crate::output::envelope::{Envelope, HistorySource as Recorded, RowOrigin, each_row};
use crate::output::folder::{ENVELOPE, HISTORY};
use crate::output::numbers::count;
use crate::study::companion::band::ErrorBand;

/// Number of stretches of time whose least and largest values are kept.
const STRETCHES: usize = 2000;

/// A history and its first and last rows.
#[derive(Clone, Debug, Default)]
pub struct ReportHistory {
    /// Thinned columns; the first is time.
    columns: Vec<Vec<f64>>,
    /// Their names and units.
    names: Vec<(String, String)>,
    first: Vec<f64>,
    last: Vec<f64>,
    rows: u64,
    /// Number of ends of stretches of which only extremes were written.
    stretches: u64,
}

impl ReportHistory {
    /// Reads what was recorded; empty if the run ended before its first row.
    pub fn read(recorded: Recorded) -> Result<Self> {
        if let Recorded::Folder(dir) = recorded
            && !dir.join(HISTORY).is_file()
        {
            return Ok(Self::default());
        }
        let mut found = Self::default();
        let mut envelope = Envelope::new(STRETCHES);
        each_row(recorded, |names, source, row| {
            envelope.add(names, source, row);
            if source == RowOrigin::Rest {
                found.stretches += 1;
                return;
            }
            if found.rows == 0 {
                found.first = row.to_vec();
            }
            found.last = row.to_vec();
            found.rows += 1;
        })?;
        (found.columns, found.names) = (envelope.columns(), envelope.names().to_vec());
        Ok(found)
    }

    /// First and last value of a column.
    pub fn ends(&self, one: Observable) -> Option<(f64, f64)> {
        let k = self.names.iter().position(|n| n.0 == one.name())?;
        Some((*self.first.get(k)?, *self.last.get(k)?))
    }

    /// Times of the thinned columns [s].
    pub fn times(&self) -> &[f64] {
        self.columns.first().map_or(&[], Vec::as_slice)
    }

    /// A thinned column.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let k = self.names.iter().position(|n| n.0 == name)?;
        self.columns.get(k).map(Vec::as_slice)
    }

    /// True if values are the least and the largest of several rows.
    pub fn joined(&self) -> bool {
        (self.times().len() as u64) < self.rows || self.stretches > 0
    }

    /// Columns with names, units, groups, meanings and half widths of error bands, then `others`; and a note if rows were joined.
    pub fn json(&self, others: Vec<Value>, band: &ErrorBand) -> Value {
        if self.rows == 0 {
            return Value::Null;
        }
        let columns = self.names.iter().zip(&self.columns).map(|((name, unit), values)| {
            let one = Observable::named(name);
            let mut column = json!({
                "name": name, "unit": unit, "group": one.map_or("More", |one| one.group().title()),
                "label": one.map_or_else(|| spoken(name), |one| one.label().into()), "about": one.map_or("", Observable::about),
                "usual": one.is_some_and(usual), "values": base64::numbers(values.iter().copied()),
            });
            if let Some(widths) = band.column_widths(name) {
                column["widths"] = base64::numbers(widths.into_iter().map(|(_, width)| width));
            }
            column
        });
        let shown = self.columns.first().map_or(0, Vec::len) as u64;
        let rows = count(self.rows);
        let note = match self.stretches {
            0 if shown < self.rows => Some(format!(
                "{rows} output times were written; of every stretch of {} the smallest and the largest value are shown.",
                count(self.rows.div_ceil(shown.div_ceil(2).max(1)))
            )),
            0 => None,
            _ => Some(format!(
                "{rows} output times were written, most of them in the window at the end; before it the smallest and the largest value \
                 of every stretch of {ENVELOPE} are shown."
            )),
        };
        let banded = base64::numbers(band.rows.iter().map(|row| row[0]));
        json!({"columns": columns.chain(others).collect::<Vec<_>>(), "banded": banded, "note": note, "rows": self.rows})
    }
}

/// A column name as text; `__1` in a name is the number of a lower bladder.
fn spoken(name: &str) -> String {
    name.replace("__", " −").replace('_', " ")
}

/// True if a quantity is shown by default: headlines, and all quantities of the pressure group.
fn usual(one: Observable) -> bool {
    one.role() == QuantityRole::Headline || one.group() == Group::Pressure
}

/// Labels of the headline quantities, by name.
pub fn headlines() -> Value {
    let all = Observable::ALL
        .iter()
        .filter(|one| one.role() == QuantityRole::Headline);
    let labelled = all.map(|one| (one.name().to_string(), one.label().into()));
    Value::Object(labelled.collect())
}
