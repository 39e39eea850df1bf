//! What the terminal can do, and how errors look on it.

use std::io::IsTerminal as _;

use crate::case;
use crate::error::{Error, SolverFault};

/// Whether standard output wants colour: a terminal, and `NO_COLOR` not set.
pub fn colour_out() -> bool {
    std::io::stdout().is_terminal() && wants_colour()
}

fn wants_colour() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
}

/// Columns of the terminal.
pub fn width() -> usize {
    std::env::var("COLUMNS")
        .ok()
        .and_then(|c| c.parse().ok())
        .unwrap_or(100)
}

/// Prints an error to standard error.
pub fn report(error: &Error) {
    let colour = std::io::stderr().is_terminal() && wants_colour();
    match error {
        Error::Case(fault) => eprint!("{}", case::render(fault, colour, width())),
        Error::Solver(fault) => eprintln!("{}", diagnosis(fault)),
        other => eprintln!("slcbeam: {other}"),
    }
}

/// A failed run in words.
pub fn diagnosis(fault: &SolverFault) -> String {
    let mut lines = vec![format!(
        "slcbeam: the run failed at t = {:.6e} s: {}",
        fault.time_s, fault.what
    )];
    for (what, text) in [
        ("worst unknown", &fault.unknown),
        ("likely cause", &fault.cause),
        ("try", &fault.hint),
    ] {
        if let Some(text) = text {
            lines.push(format!("  {what}: {text}"));
        }
    }
    lines.join("\n")
}
