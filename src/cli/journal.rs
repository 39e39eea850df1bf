//! The journal of a search: what it is begun with, what is told of it, and when it goes.

use super::{embedded, terminal};
use crate::case::Case;
use crate::error::Result;
use crate::output::ResultFolder;
use crate::output::evaluations as files;
use crate::study::evaluations::Evaluations;

/// Begins the journal of a command, a case and its settings in words in a folder.
///
/// # Errors
/// It cannot be read.
pub fn begin(evaluations: &Evaluations, folder: &ResultFolder, of: (&str, &Case, &str)) -> Result<()> {
    if let Some(damage) = files::begin(evaluations, folder, of)? {
        terminal::tell(&format!("slcbeam: {damage}. They are computed again."));
    }
    Ok(())
}

/// What a search found. The journal of one that failed goes, that of one that was stopped stays.
///
/// # Errors
/// Those of the search.
pub fn outcome<T>(found: Result<T>, folder: &ResultFolder, stopped: bool) -> Result<T> {
    if found.is_err() && !stopped {
        let _ = files::remove(folder);
    }
    found
}

/// Says how many evaluations were read. The journal of a search that was stopped stays, as does that of a result that could not be
/// written.
pub fn end(evaluations: &Evaluations, folder: &ResultFolder, stopped: bool, written: Result<()>) -> Result<()> {
    let (counts, path) = (evaluations.counts(), files::path(folder));
    let all = counts.read + counts.stored;
    if counts.read > 0 {
        terminal::tell(&format!(
            "slcbeam: resumed: {} of {all} evaluations read from {}",
            counts.read,
            path.display()
        ));
    }
    if let Some(fault) = evaluations.fault() {
        terminal::tell(&format!("slcbeam: {fault}. Evaluations after it are not kept."));
    }
    match (stopped, &written) {
        // inside another program the answer says so
        (true, _) if all == 0 || embedded::stop().is_some() => {}
        (true, _) => terminal::tell(&format!(
            "slcbeam: stopped; the same command goes on after {all} evaluations, which {} holds",
            path.display()
        )),
        (false, Ok(())) => files::remove(folder)?,
        (false, Err(_)) => {}
    }
    written
}
