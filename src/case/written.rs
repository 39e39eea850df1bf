//! The case in a result folder: every default filled in, long tables in separate files.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::schema::Case;

/// Largest number of points of a table that is written into the case itself.
const INLINE: usize = 1000;

/// Text of `case.json`, and the tables it refers to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseText {
    /// The case as JSON.
    pub json: String,
    /// Names and texts of the CSV files beside it.
    pub tables: Vec<(String, String)>,
}

/// Times and values.
type Points = (Vec<f64>, Vec<f64>);

impl Case {
    /// The case as JSON text with every default filled in. A table of more than a thousand points is replaced by its file name and
    /// checksum. With the files of [`Case::written`] beside it, the text reads back as the same case.
    pub fn resolved_json(&self) -> String {
        self.set_apart().0
    }

    /// The case as JSON text, with the files of its tables.
    pub fn written(&self) -> CaseText {
        let (json, tables) = self.set_apart();
        CaseText {
            json,
            tables: tables.into_iter().map(|(name, points)| (name, csv(&points))).collect(),
        }
    }

    fn set_apart(&self) -> (String, BTreeMap<String, Points>) {
        let mut value = serde_json::to_value(self.resolved()).unwrap_or_default();
        let mut tables = BTreeMap::new();
        set_apart(&mut value, &mut tables);
        (format!("{value:#}\n"), tables)
    }
}

/// True if a file beside a case is one of its tables, by its name.
pub fn is_table(name: &str) -> bool {
    let sum = name.strip_prefix("table-").and_then(|rest| rest.strip_suffix(".csv"));
    sum.is_some_and(|sum| sum.len() == 8 && sum.bytes().all(|b| b.is_ascii_hexdigit()))
}

/// CRC-32 of the points, each time before its value, as little-endian doubles.
pub(super) fn checksum(times: &[f64], values: &[f64]) -> String {
    let mut sum = crc32fast::Hasher::new();
    for (time, value) in times.iter().zip(values) {
        sum.update(&time.to_le_bytes());
        sum.update(&value.to_le_bytes());
    }
    format!("{:08x}", sum.finalize())
}

fn set_apart(value: &mut Value, tables: &mut BTreeMap<String, Points>) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| set_apart(item, tables)),
        Value::Object(members) => {
            for (key, inner) in members.iter_mut() {
                match inner {
                    Value::Object(table) if key == "table" => name_file(table, tables),
                    _ => set_apart(inner, tables),
                }
            }
        }
        _ => {}
    }
}

/// Replaces many points by the name of a file.
fn name_file(table: &mut Map<String, Value>, tables: &mut BTreeMap<String, Points>) {
    let numbers = |key: &str| -> Option<Vec<f64>> { table.get(key)?.as_array()?.iter().map(Value::as_f64).collect() };
    let Some((times, values)) = numbers("times_s").zip(numbers("values")) else {
        return;
    };
    if times.len() <= INLINE || times.len() != values.len() {
        return;
    }
    let sum = checksum(&times, &values);
    let name = format!("table-{sum}.csv");
    table.shift_remove("times_s");
    table.shift_remove("values");
    table.shift_insert(0, "csv".into(), name.clone().into());
    table.shift_insert(1, "checksum".into(), sum.into());
    tables.insert(name, (times, values));
}

/// CSV text with every number in its shortest form that reads back as the same value.
fn csv((times, values): &Points) -> String {
    let mut out = csv::Writer::from_writer(vec![]);
    // writing to memory does not fail
    let _ = out.write_record(["t [s]", "value"]);
    for (time, value) in times.iter().zip(values) {
        let _ = out.write_record([format!("{time:?}"), format!("{value:?}")]);
    }
    String::from_utf8(out.into_inner().unwrap_or_default()).unwrap_or_default()
}
