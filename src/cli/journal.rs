//! Journal of a search: its beginning, its messages, and its removal.

use super::{embedded, terminal};
use crate::case::Case;
use crate::error::Result;
use crate::output::ResultFolder;
use crate::output::evaluations as files;
use crate::study::evaluations::Evaluations;

/// Begins the journal of a command in a folder, for a case and its settings as text.
///
/// # Errors
/// The journal cannot be read.
pub fn begin(evaluations: &Evaluations, folder: &ResultFolder, of: (&str, &Case, &str)) -> Result<()> {
    if let Some(damage) = files::begin(evaluations, folder, of)? {
        terminal::print_line(&format!("slcbeam: {damage}. They are computed again."));
    }
    Ok(())
}

/// Returns the outcome of a search. Removes the journal of a failed search, and keeps that of a stopped one.
///
/// # Errors
/// Those of the search.
pub fn outcome<T>(found: Result<T>, folder: &ResultFolder, stopped: bool) -> Result<T> {
    if found.is_err() && !stopped {
        let _ = files::remove(folder);
    }
    found
}

/// Reports the number of evaluations read, and removes the journal. Keeps the journal if the search was stopped or its result could not be
/// written.
pub fn end(evaluations: &Evaluations, folder: &ResultFolder, stopped: bool, written: Result<()>) -> Result<()> {
    let (counts, path) = (evaluations.counts(), files::path(folder));
    let all = counts.read + counts.stored;
    if counts.read > 0 {
        terminal::print_line(&format!(
            "slcbeam: resumed: {} of {all} evaluations read from {}",
            counts.read,
            path.display()
        ));
    }
    if let Some(fault) = evaluations.fault() {
        terminal::print_line(&format!("slcbeam: {fault}. Evaluations after it are not kept."));
    }
    match (stopped, &written) {
        // inside another program, the answer reports it
        (true, _) if all == 0 || embedded::stop().is_some() => {}
        (true, _) => terminal::print_line(&format!(
            "slcbeam: stopped after {all} evaluations, stored in {}; the same command resumes from them",
            path.display()
        )),
        (false, Ok(())) => files::remove(folder)?,
        (false, Err(_)) => {}
    }
    written
}
