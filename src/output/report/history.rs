//! `history.csv`, thinned to what a screen can show; no peak is lost.

use std::io;
use std::path::Path;

use serde_json::{Map, Value, json};

use super::pack;
use crate::case::Case;
use crate::discrete::System;
use crate::error::Result;
use crate::output::envelope::Envelope;
use crate::output::folder::{HISTORY, fault, open};
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
}

impl History {
    /// Of a folder; empty when the run ended before its first row.
    pub fn read(dir: &Path) -> Result<Self> {
        let path = dir.join(HISTORY);
        if !path.is_file() {
            return Ok(Self::default());
        }
        Self::of(&path).map_err(|e| fault("read", &path, io::Error::from(e)))
    }

    fn of(path: &Path) -> csv::Result<Self> {
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(open(path)?);
        let names: Vec<(String, String)> = reader.headers()?.iter().map(split).collect();
        let mut envelope = Envelope::new(names.clone(), STRETCHES);
        let mut found = Self {
            names,
            ..Self::default()
        };
        let mut record = csv::StringRecord::new();
        while reader.read_record(&mut record)? {
            let row: Vec<f64> = record.iter().map_while(|x| x.trim().parse().ok()).collect();
            // A last line may be cut short where a run was killed.
            if row.len() != found.names.len() {
                continue;
            }
            envelope.push(&row);
            if found.rows == 0 {
                found.first.clone_from(&row);
            }
            found.last = row;
            found.rows += 1;
        }
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
        let note = (shown < self.rows).then(|| {
            format!(
                "{} output times were written; of every stretch of {} the smallest and the largest value are shown.",
                count(self.rows),
                count(self.rows.div_ceil(shown.div_ceil(2).max(1)))
            )
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

/// `tip_u1 [m]` into name and unit.
fn split(heading: &str) -> (String, String) {
    match heading.trim().strip_suffix(']').and_then(|h| h.rsplit_once(" [")) {
        Some((name, unit)) => (name.to_string(), unit.to_string()),
        None => (heading.trim().to_string(), "1".to_string()),
    }
}
