//! Checks that the machine can hold a case and its results.

use std::io::IsTerminal as _;
use std::path::Path;

use super::arguments::CaseArguments;
use super::terminal;
use crate::case::{self, Case};
use crate::discrete::System;
use crate::error::{Code, Result, Violation};
use crate::output::disk::Disk;
use crate::output::machine;
use crate::output::numbers::{duration, significant};
use crate::run::observe::Observer;
use crate::run::resource_estimate::ResourceEstimate;

/// Set-up time beyond which a run prints a notice [s].
const LONG_S: f64 = 10.0;

/// Reads and checks a case whose size the machine can hold; allocates nothing of that size yet.
///
/// # Errors
/// As [`case::load`]; E006 with the numbers if the memory is insufficient.
pub fn load(asked: &CaseArguments) -> Result<Case> {
    load_with(&asked.case, &asked.sets, 0)
}

/// Reads and checks a case as `load`, for derivatives by `parameters` numbers.
pub fn load_with(path: &Path, sets: &[String], parameters: usize) -> Result<Case> {
    load_varied(path, [sets, &[]], parameters)
}

/// Reads and checks a case as `load_with`, with arguments that are varied after those of the case, as [`case::parse_varied`] reads them.
pub fn load_varied(path: &Path, [sets, varied]: [&[String]; 2], parameters: usize) -> Result<Case> {
    if path == Path::new("-") && std::io::stdin().is_terminal() {
        terminal::print_line("slcbeam: reading a case from standard input; Ctrl-D ends it");
    }
    let beside = path.parent().unwrap_or(Path::new(""));
    let case = case::parse_varied(&case::text(path)?, path, beside, sets, varied)?;
    fits(&case, parameters, 1)?;
    Ok(case)
}

/// Rejects a case if `at_once` copies exceed the available memory.
///
/// # Errors
/// E006 with the numbers.
pub fn fits(case: &Case, parameters: usize, at_once: usize) -> Result<()> {
    let mut needs = ResourceEstimate::estimate(case, parameters);
    needs.memory *= at_once as f64;
    if let Some(there) = machine::memory().filter(|there| needs.memory > *there) {
        let what = format!(
            "{:.3e} unknowns need about {} of memory, but {} are available",
            needs.unknowns,
            bytes(needs.memory),
            bytes(there)
        );
        let hint = match at_once {
            1 => "use fewer cells per segment, fewer cells per bladder, or fewer segments",
            _ => "use fewer designs at once, --jobs, or fewer cells per segment or per bladder",
        };
        let fault = Violation::new(Code::Range, "/mesh", what).hint(hint);
        return Err(case.source.fault(vec![fault]));
    }
    Ok(())
}

/// True if the memory holds a case and its companion, which has up to twice the cells. Prints the reason if it does not.
pub fn holds_companion(case: &Case, parameters: usize) -> bool {
    let needed = ResourceEstimate::estimate(case, parameters).memory + 2.0 * ResourceEstimate::estimate(case, 0).memory;
    let held = machine::memory().is_none_or(|there| needed <= there);
    if !held {
        terminal::print_line(&format!(
            "slcbeam: no error bars: a companion run needs {} of memory in all",
            bytes(needed)
        ));
    }
    held
}

/// Disk space for the files of a run.
pub fn disk(case: &Case, system: &System, parameters: usize) -> Disk {
    Disk::estimate(case, &Observer::header(case, system), system.layout.len, parameters)
}

/// Rejects a run whose files exceed the free disk space, and prints a notice if the set-up takes long.
///
/// # Errors
/// E006 with the numbers.
pub fn run_fits(case: &Case, system: &System, parameters: usize, out: &Path) -> Result<()> {
    let disk = disk(case, system, parameters);
    if let Some(free) = machine::free(out).filter(|free| disk.all() > *free) {
        let key = if disk.history > disk.fields { "output" } else { "fields" };
        let what = format!(
            "the files of this run need about {}, but {} are free on the disk of the result folder",
            bytes(disk.all()),
            bytes(free)
        );
        let fault = Violation::new(Code::Range, format!("/time/{key}_interval_s"), what);
        let fault = fault.hint("use a longer interval, or another folder with --out");
        return Err(case.source.fault(vec![fault]));
    }
    let needs = ResourceEstimate::estimate(case, parameters);
    if needs.set_up_s > LONG_S {
        terminal::print_line(&format!(
            "slcbeam: the set-up of {} unknowns takes about {}; Ctrl-C and --max-wall act only after it (a second \
             Ctrl-C ends the program at once)",
            system.layout.len,
            duration(needs.set_up_s)
        ));
    }
    Ok(())
}

/// Formats a number of bytes.
pub fn bytes(count: f64) -> String {
    let (scale, unit) = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB")]
        .into_iter()
        .find(|(scale, _)| count >= *scale)
        .unwrap_or((1e3, "kB"));
    format!("{} {unit}", significant(count / scale, 3))
}
