//! `history.csv`, thinned to what a screen can show; no peak is lost.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::pack;
use crate::case::Case;
use crate::discrete::System;
use crate::error::Result;
use crate::output::envelope::{Envelope, Source, each_row};
use crate::output::folder::{ENVELOPE, HISTORY};
use crate::output::numbers::count;
use crate::run::observe::Observer;

/// Stretches of time of which least and largest value are kept.
const STRETCHES: usize = 2000;

/// A history and its first and last rows.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Thinned columns; the first is time.
    columns: Vec<Vec<f64>>,
    names: Vec<(String, String)>,
    first: Vec<f64>,
    last: Vec<f64>,
    rows: u64,
    /// Ends of stretches of which least and greatest values alone were written.
    stretches: u64,
}

impl History {
    /// Of a folder; empty when the run ended before its first row.
    pub fn read(dir: &Path) -> Result<Self> {
        let path = dir.join(HISTORY);
        if !path.is_file() {
            return Ok(Self::default());
        }
        let mut found = Self::default();
        let mut envelope = Envelope::default();
        each_row(dir, |names, source, row| {
            if found.names.is_empty() {
                found.names = names.to_vec();
                envelope = Envelope::new(found.names.clone(), STRETCHES);
            }
            if source != Source::Covered {
                envelope.push(row);
            }
            if source == Source::Rest {
                found.stretches += 1;
                return;
            }
            if found.rows == 0 {
                found.first = row.to_vec();
            }
            found.last = row.to_vec();
            found.rows += 1;
        })?;
        found.columns = envelope.columns();
        Ok(found)
    }

    /// First and last value of a column.
    pub fn ends(&self, name: &str) -> Option<(f64, f64)> {
        let k = self.names.iter().position(|n| n.0 == name)?;
        Some((*self.first.get(k)?, *self.last.get(k)?))
    }

    /// Columns with names, units, groups and meanings, and a note where rows were joined.
    pub fn json(&self, case: Option<&Case>) -> Value {
        if self.rows == 0 {
            return Value::Null;
        }
        let system = case.map(System::new);
        let header = case
            .zip(system.as_ref())
            .map(|(case, system)| Observer::header(case, system));
        let about = |name: &str| {
            let columns = header.iter().flat_map(|h| &h.columns);
            columns
                .into_iter()
                .find(|c| c.name == name)
                .map_or("", |c| c.about.as_str())
        };
        let columns = self.names.iter().zip(&self.columns).map(|((name, unit), values)| {
            let mut all = Map::new();
            all.insert("name".into(), name.as_str().into());
            all.insert("unit".into(), unit.as_str().into());
            all.insert("group".into(), group(name, unit).into());
            all.insert("about".into(), about(name).into());
            all.insert("values".into(), pack::numbers(values.iter().copied()));
            Value::Object(all)
        });
        let shown = self.columns.first().map_or(0, Vec::len) as u64;
        let note = (shown < self.rows && self.stretches == 0).then(|| {
            format!(
                "{} output times were written; of every stretch of {} the smallest and the largest value are shown.",
                count(self.rows),
                count(self.rows.div_ceil(shown.div_ceil(2).max(1)))
            )
        });
        let note = note.or_else(|| {
            (self.stretches > 0).then(|| {
                format!(
                    "{} output times were written, most of them in the window at the end; before it the smallest and the largest value \
                     of every stretch of {ENVELOPE} are shown.",
                    count(self.rows)
                )
            })
        });
        json!({"columns": columns.collect::<Vec<_>>(), "note": note, "rows": self.rows})
    }
}

/// Where a column belongs among those to choose from.
fn group(name: &str, unit: &str) -> &'static str {
    match (name, unit) {
        (n, _) if n.starts_with("tip_") => "Tip",
        (_, "Pa") => "Pressure",
        (n, "J") if n.ends_with("_energy") => "Energy stored",
        ("energy_residual", _) => "Unexplained",
        (_, "J") => "Work done and lost",
        _ => "More",
    }
}
