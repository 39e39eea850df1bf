//! The program and what it says.

use serde_json::Value;
use tempfile::TempDir;

pub use crate::program::say;

/// The best that is found, by what is asked besides the folder.
pub fn best(dir: &TempDir, arguments: &[&str]) -> Value {
    ended(dir, arguments, 0)
}

/// What is found by a command that ends with an exit code.
pub fn ended(dir: &TempDir, arguments: &[&str], code: i32) -> Value {
    let out = path(dir, "out");
    let said = say(&[
        &["optimize"],
        arguments,
        &["--out", &out, "--force", "--quiet", "--json"],
    ]
    .concat());
    assert_eq!(said.code, code, "{}\n{}", said.out, said.err);
    serde_json::from_str(&said.out).expect("JSON")
}

pub fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

/// A number of a result.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}
