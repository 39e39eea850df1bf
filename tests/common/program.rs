//! The program, and what it says.

#![allow(dead_code)] // each target looks at what it needs

use std::process::Command;

/// What it said, and how it ended.
pub struct Said {
    pub code: i32,
    pub out: String,
    pub err: String,
}

/// The program with arguments.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slcbeam"));
    command.args(arguments);
    command
}

/// Runs it to its end.
pub fn say(arguments: &[&str]) -> Said {
    let output = command(arguments).output().expect("a program");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    Said {
        code: output.status.code().unwrap_or(-1),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}
