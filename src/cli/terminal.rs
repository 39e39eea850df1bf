//! Capabilities of the terminal, and printing of errors on it.

use std::ffi::OsString;
use std::io::{IsTerminal as _, Write as _};
use std::process::ExitCode;

use clap::error::ErrorKind;

use super::embedded;
use crate::case;
use crate::error::{Error, SolverError, visible};
pub use crate::output::errors::{diagnosis, json};

/// True if standard output is colored: a terminal, and `NO_COLOR` not set.
pub fn colour_out() -> bool {
    std::io::stdout().is_terminal() && wants_colour()
}

fn wants_colour() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()) && std::env::var_os("TERM").is_none_or(|t| t != "dumb")
}

/// Width in columns: that of `COLUMNS`, that of the terminal, or 100.
pub fn width() -> usize {
    let set = std::env::var("COLUMNS").ok().and_then(|c| c.parse().ok());
    let own = || terminal_size::terminal_size().map(|(width, _)| width.0.into());
    set.or_else(own).unwrap_or(100)
}

/// Writes a line to standard error, with terminal control sequences made visible; ignores failures of writing.
pub fn print_line(line: &str) {
    print_painted_line(&visible(line));
}

/// Writes text with the program's own colors, in which foreign control sequences are already visible.
fn print_painted_line(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Prints an error to standard error.
pub fn report(error: &Error) {
    if embedded::kept_fault(error) {
        return;
    }
    let colour = std::io::stderr().is_terminal() && wants_colour();
    match error {
        Error::Case(fault) => print_painted_line(case::render(fault, colour, width()).trim_end_matches('\n')),
        Error::Solver(fault) => print_line(&diagnosis(fault)),
        other => print_line(&format!("slcbeam: {other} (slcbeam explain {})", other.code().id())),
    }
}

/// Exit code of a result that is written in any case; prints the reason if the computation ended early.
pub fn exit_code(fault: Option<&SolverError>) -> ExitCode {
    fault.map_or(ExitCode::SUCCESS, |fault| {
        print_line(&diagnosis(fault));
        ExitCode::from(4)
    })
}

/// Prints help and errors of the argument parser, with control sequences in the user's words made visible.
pub fn answer(answer: &clap::Error, words: &[OsString]) {
    let text = answer.render().to_string();
    let known = *visible(&text) == text && answer.kind() != ErrorKind::UnknownArgument;
    if known {
        let _ = answer.print();
    } else {
        print_line(with_tip(&text, words).trim_end());
    }
}

/// An error of the argument parser with a tip for the usual mistakes: one dash, and a pointer apart from its value.
fn with_tip(text: &str, words: &[OsString]) -> String {
    let words: Vec<&str> = words.iter().skip(1).filter_map(|word| word.to_str()).collect();
    let one_dash = |word: &&&str| {
        let name = word.strip_prefix('-').unwrap_or_default();
        name.len() > 1 && name.starts_with(|c: char| c.is_ascii_lowercase())
    };
    let apart = words.windows(3).find(|three| {
        ["--set", "--vary", "--uncertain"].contains(&three[0]) && three[1].starts_with('/') && !three[1].contains('=')
    });
    let tip = match (apart, words.iter().find(one_dash)) {
        (Some(three), _) => format!(
            "write the value behind the pointer: {} '{}={}'",
            three[0], three[1], three[2]
        ),
        (_, Some(word)) => format!("options of several letters have two dashes: -{word}"),
        _ => String::new(),
    };
    let own = text.lines().filter(|line| !line.contains("tip: to pass"));
    let mut lines: Vec<String> = own.map(str::to_owned).collect();
    if !tip.is_empty() {
        lines.insert(lines.len().min(1), format!("\n  tip: {tip}"));
    }
    lines.dedup_by(|line, before| line.is_empty() && before.is_empty());
    visible(&lines.join("\n")).into_owned()
}
