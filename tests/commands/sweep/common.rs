//! The program, a small case, and what is read of a sweep.

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

pub use crate::program::{Said, command, say};

pub const CASE: &str = "cases/two-bladders.json";
pub const AREA: &str = "/bladders/area_per_pressure_m2_per_pa";
pub const SHORT: [&str; 4] = ["--set", "/time/end_s=0.0005", "--set", "/mesh/cells_per_segment=4"];

pub fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

/// Sweeps the small case with these options besides.
pub fn swept(out: &str, more: &[&str]) -> Said {
    say(&[&["sweep", CASE, "--quiet", "--lean", "--out", out], &SHORT[..], more].concat())
}

pub fn well(said: &Said) {
    assert_eq!(said.code, 0, "{}\n{}", said.out, said.err);
}

/// Rows of a table by heading.
pub fn rows(out: &str) -> Vec<std::collections::BTreeMap<String, String>> {
    let mut table = csv::Reader::from_path(Path::new(out).join("sweep.csv")).expect("a table");
    let names = table.headers().expect("headings").clone();
    let row = |record: csv::StringRecord| {
        names
            .iter()
            .map(String::from)
            .zip(record.iter().map(String::from))
            .collect()
    };
    table.records().map(|record| row(record.expect("a row"))).collect()
}

/// A table without its last column, the wall times.
pub fn table(out: &str) -> String {
    let text = fs::read_to_string(Path::new(out).join("sweep.csv")).expect("a table");
    assert!(text.lines().next().is_some_and(|line| line.ends_with(",wall_s")));
    text.lines()
        .map(|line| line.rsplit_once(',').map_or(line, |(rest, _)| rest).to_owned() + "\n")
        .collect()
}

pub fn json(out: &str, name: &str) -> Value {
    let text = fs::read_to_string(Path::new(out).join(name)).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}
