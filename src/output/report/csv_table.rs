//! CSV files as tables.

use std::path::Path;

use serde_json::{Value, json};

use super::MOST_ROWS;
use crate::output::folder::open;

/// Headings and rows of selected columns, numeric cells as JSON numbers; null if the file does not exist.
pub fn read(path: &Path, wanted: impl Fn(&str) -> bool) -> Value {
    let Ok(file) = open(path) else {
        return Value::Null;
    };
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(file);
    let Ok(headings) = reader.headers().cloned() else {
        return Value::Null;
    };
    let chosen: Vec<usize> = (0..headings.len()).filter(|&k| wanted(&headings[k])).collect();
    let cell = |text: &str| match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => json!(x),
        _ => json!(text),
    };
    let mut rows = vec![];
    let mut left_out = 0;
    for record in reader.records().flatten() {
        if rows.len() < MOST_ROWS {
            let row = chosen.iter().map(|&k| record.get(k).map_or(Value::Null, cell));
            rows.push(Value::Array(row.collect()));
        } else {
            left_out += 1;
        }
    }
    let file = path.file_name().map(|n| n.to_string_lossy().into_owned());
    json!({
        "headings": chosen.iter().map(|&k| &headings[k]).collect::<Vec<_>>(),
        "rows": rows, "left_out": left_out, "file": file,
    })
}
