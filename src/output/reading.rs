//! A result folder back into memory, to be compared with another.

use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::Path;

use npyz::NpyFile;
use serde_json::Value;
use zip::ZipArchive;

use super::arrays::TIMES;
use super::folder::{CASE, FIELDS, HISTORY, fault};
use super::summary;
use crate::error::Result;
use crate::study::compare::{Array, Recording, Series};

/// Reads all files of a result.
pub fn read(dir: &Path) -> Result<Recording> {
    let path = dir.join(CASE);
    let text = fs::read_to_string(&path).map_err(|e| fault("read", &path, e))?;
    let case: Value = serde_json::from_str(&text).map_err(|e| fault("read", &path, io::Error::from(e)))?;
    let summary = summary::read(dir)?;
    let path = dir.join(HISTORY);
    let mut columns = history(&path).map_err(|e| fault("read", &path, e))?;
    if columns.is_empty() {
        let why = io::Error::new(io::ErrorKind::InvalidData, "it has no columns");
        return Err(fault("read", &path, why));
    }
    let times = columns.remove(0).values;
    let mut out = Recording {
        label: dir.display().to_string(),
        case,
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

/// Columns `name [unit]`. A last row that an interruption cut short is left out.
fn history(path: &Path) -> io::Result<Vec<Series>> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path)?;
    let mut columns: Vec<Series> = reader
        .headers()?
        .iter()
        .map(|heading| {
            let (name, unit) = heading.split_once(" [").unwrap_or((heading, ""));
            Series {
                name: name.into(),
                unit: unit.trim_end_matches(']').into(),
                values: vec![],
            }
        })
        .collect();
    for row in reader.records() {
        let row = row?;
        let values: Vec<f64> = row.iter().filter_map(|x| x.parse().ok()).collect();
        if values.len() != columns.len() {
            break;
        }
        for (column, value) in columns.iter_mut().zip(values) {
            column.values.push(value);
        }
    }
    Ok(columns)
}

fn arrays(path: &Path, out: &mut Recording) -> io::Result<()> {
    let mut npz = ZipArchive::new(BufReader::new(File::open(path)?))?;
    for k in 0..npz.len() {
        let entry = npz.by_index(k)?;
        let Some(name) = entry.name()?.strip_suffix(".npy").map(String::from) else {
            continue;
        };
        let array = NpyFile::new(entry)?;
        let shape = array.shape().to_vec();
        let values: Vec<f64> = array.into_vec()?;
        match shape.as_slice() {
            [_] if name == TIMES => out.field_times = values,
            [_] => out.axes.push((name, values)),
            [_, len] => out.fields.push(Array {
                name,
                len: *len as usize,
                values,
            }),
            _ => {}
        }
    }
    Ok(())
}
