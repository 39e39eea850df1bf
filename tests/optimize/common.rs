//! The program and what it says.

use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

pub fn say(arguments: &[&str]) -> Said {
    let output = Command::new(env!("CARGO_BIN_EXE_slcbeam"))
        .args(arguments)
        .output()
        .expect("a program");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    Said {
        code: output.status.code().unwrap_or(-1),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

/// The best that is found, by what is asked besides the folder.
pub fn best(dir: &TempDir, arguments: &[&str]) -> Value {
    let out = path(dir, "out");
    let said = say(&[
        &["optimize"],
        arguments,
        &["--out", &out, "--force", "--quiet", "--json"],
    ]
    .concat());
    assert_eq!(said.code, 0, "{}\n{}", said.out, said.err);
    serde_json::from_str(&said.out).expect("JSON")
}

pub fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

/// A number of a result.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}
