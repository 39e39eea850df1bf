//! Journal of the evaluations of a search, in a hidden file of the result folder until the search is complete.

use std::path::PathBuf;

use super::checkpoint::build;
use super::folder::ResultFolder;
use super::journal::{Journal, Lines};
use crate::case::Case;
use crate::error::Result;
use crate::results::Provenance;
use crate::study::evaluations::{Evaluations, JournalEvaluation, Write};

/// Name of the journal file.
pub const EVALUATIONS: &str = ".slcbeam.evaluations.jsonl";

/// Format of rows. Increase it when a key or value of any command changes its meaning.
const FORMAT: u32 = 1;

/// Checksum of everything that determines the evaluations of a command: case with tables, settings as text, and build.
fn plan(command: &str, case: &Case, settings: &str) -> u32 {
    let written = case.written();
    let all = (
        FORMAT,
        (Provenance::new(None), build()),
        command,
        written.json,
        written.tables,
        settings,
    );
    crc32fast::hash(&serde_json::to_vec(&all).unwrap_or_default())
}

/// Opens the journal of a command in a folder and reads its rows. Returns a description of damaged rows.
///
/// # Errors
/// The journal cannot be read.
pub fn begin(
    evaluations: &Evaluations,
    folder: &ResultFolder,
    (command, case, settings): (&str, &Case, &str),
) -> Result<Option<String>> {
    let mut known: Vec<JournalEvaluation> = vec![];
    let plan = plan(command, case, settings);
    let path = path(folder);
    let lines = Lines::read(&path, plan, false, |_, row| known.push(row))?;
    let damage = lines.damage("case or command");
    // created with the first row: a search that computes nothing leaves no file
    let mut journal: Option<Journal> = None;
    let write: Write = Box::new(move |row: &JournalEvaluation| match &mut journal {
        Some(journal) => journal.put(row),
        None => journal.insert(Journal::go_on(path.clone(), &lines)?).put(row),
    });
    evaluations.begin(known, write);
    Ok(damage)
}

/// Path of the journal.
pub fn path(folder: &ResultFolder) -> PathBuf {
    folder.path(EVALUATIONS)
}

/// Removes the journal, whose content the result contains by then.
///
/// # Errors
/// The file cannot be removed.
pub fn remove(folder: &ResultFolder) -> Result<()> {
    folder.remove(EVALUATIONS)
}
