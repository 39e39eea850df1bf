//! `history.csv`, thinned to the resolution of a screen without loss of peaks.

use serde_json::{Value, json};

use super::base64;
use crate::discrete::quantities::probes::tip_of_beam;
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
        let first = self
            .names
            .iter()
            .find_map(|(name, _)| tip_of_beam(name))
            .map(|(beam, _)| beam);
        let columns = self.names.iter().zip(&self.columns).map(|((name, unit), values)| {
            let one = Observable::named(name);
            // the tip of the observables is that of the first beam
            let of_first = first.filter(|_| one.is_some_and(|one| one.group() == Group::Tip));
            let group = match tip_of_beam(name) {
                Some(_) => Group::Tip.title(),
                None => one.map_or("More", |one| one.group().title()),
            };
            let label = match of_first {
                Some(beam) => format!("{} of {beam}", one.map_or("", Observable::label)),
                None => one.map_or_else(|| spoken(name), |one| one.label().into()),
            };
            let usual = match tip_of_beam(name) {
                Some((_, what)) => ["u1", "u3"].contains(&what),
                None => one.is_some_and(usual) && of_first.is_none(),
            };
            let mut column = json!({
                "name": name, "unit": unit, "group": group, "label": label, "about": one.map_or("", Observable::about),
                "usual": usual, "values": base64::numbers(values.iter().copied()),
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
    if let Some((beam, what)) = tip_of_beam(name) {
        let what = what.replace("u1", "u₁").replace("u3", "u₃");
        return format!("{beam} tip {what}");
    }
    name.replace("__", " −").replace('_', " ")
}

/// True if a quantity is shown by default: headlines, and all quantities of the pressure group.
fn usual(one: Observable) -> bool {
    one.role() == QuantityRole::Headline || one.group() == Group::Pressure
}

/// Labels of the headline quantities, by name; of a structure with the tips of these beams.
pub fn headlines(beams: &[&str]) -> Value {
    let all = Observable::ALL
        .iter()
        .filter(|one| one.role() == QuantityRole::Headline && (beams.is_empty() || one.group() != Group::Tip));
    let labelled = all.map(|one| (one.name().to_string(), one.label().into()));
    let tips = beams
        .iter()
        .flat_map(|beam| ["u1", "u3"].map(|axis| format!("{beam}.tip_{axis}")));
    let of_beams = tips.map(|name| {
        let label = spoken(&name).into();
        (name, label)
    });
    Value::Object(of_beams.chain(labelled).collect())
}
