//! Designs from a CSV file: columns are JSON pointers, rows are designs.

use std::path::Path;

use serde_json::Value;

use super::vary::{check_pointer, plain};
use crate::case;
use crate::error::{Error, Result};

/// Table of designs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DesignTable {
    /// JSON pointers of the columns.
    pub pointers: Vec<String>,
    /// Values, one row per design.
    pub rows: Vec<Vec<Value>>,
    /// Checksum of the text.
    pub crc32: u32,
}

impl DesignTable {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::Usage`] with the line and the column.
    pub fn read(path: &Path) -> Result<Self> {
        let text = case::text(path)?;
        Self::parse(&text).map_err(|what| Error::Usage(format!("--designs {}: {what}", path.display())))
    }

    fn parse(text: &str) -> std::result::Result<Self, String> {
        if let Some(line) = case::unclosed_quote(text.as_bytes()) {
            return Err(format!("line {line}: a quotation mark is not closed"));
        }
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let headings = reader.headers().map_err(|e| e.to_string())?;
        let pointers: Vec<String> = headings.iter().map(String::from).collect();
        if pointers.iter().all(String::is_empty) {
            return Err("no columns. The first line must contain a JSON pointer for each column".into());
        }
        for (k, pointer) in pointers.iter().enumerate() {
            check_pointer(pointer).map_err(|what| format!("column {} is `{pointer}`: {what}", k + 1))?;
        }
        let mut rows = vec![];
        for (k, record) in reader.records().enumerate() {
            let record = record.map_err(|e| e.to_string())?;
            let cells = pointers.iter().zip(&record);
            let row = cells.map(|(pointer, cell)| value(cell).ok_or((pointer, cell)));
            let row: std::result::Result<Vec<Value>, _> = row.collect();
            rows.push(row.map_err(|(pointer, cell)| match cell {
                "" => format!("design {k} (row {} of the table) has no {pointer}", k + 2),
                _ => format!(
                    "design {k} (row {} of the table): {pointer} is `{cell}`, which is not a JSON value",
                    k + 2
                ),
            })?);
        }
        if rows.is_empty() {
            return Err("no designs. Add one line per design below the first line".into());
        }
        Ok(Self {
            pointers,
            rows,
            crc32: crc32fast::hash(text.as_bytes()),
        })
    }
}

/// Parses a cell as JSON; a bare word is a text.
fn value(cell: &str) -> Option<Value> {
    if let Ok(value) = serde_json::from_str(cell) {
        return Some(plain(value));
    }
    let word = cell.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    let letter = cell.starts_with(|c: char| c.is_ascii_alphabetic());
    let none = ["nan", "inf", "infinity", "na"].contains(&cell.to_ascii_lowercase().as_str());
    (word && letter && !none).then(|| Value::from(cell))
}
