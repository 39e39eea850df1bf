//! The journal of a search: its evaluations, in a hidden file of the result folder until the search is complete.

use std::path::PathBuf;

use super::checkpoint::build;
use super::folder::ResultFolder;
use super::journal::{Journal, Lines};
use crate::case::Case;
use crate::error::Result;
use crate::results::Provenance;
use crate::study::evaluations::{Evaluation, Evaluations, Write};

/// Its file.
pub const EVALUATIONS: &str = ".slcbeam.evaluations.jsonl";

/// Format of rows: one more where a key or a value of any command means something else.
const FORMAT: u32 = 1;

/// Checksum of everything that decides the evaluations of a command: its case with tables, its settings in words, the build.
fn plan(command: &str, case: &Case, settings: &str) -> u32 {
    let written = case.written();
    let all = (
        FORMAT,
        (Provenance::of(None), build()),
        command,
        written.json,
        written.tables,
        settings,
    );
    crc32fast::hash(&serde_json::to_vec(&all).unwrap_or_default())
}

/// Begins the journal of a command in a folder with the rows that are there; returns what of it is damaged, in words.
///
/// # Errors
/// It cannot be read.
pub fn begin(
    evaluations: &Evaluations,
    folder: &ResultFolder,
    (command, case, settings): (&str, &Case, &str),
) -> Result<Option<String>> {
    let mut known: Vec<Evaluation> = vec![];
    let plan = plan(command, case, settings);
    let path = path(folder);
    let lines = Lines::read(&path, plan, false, |_, row| known.push(row))?;
    let damage = lines.damage("case or command");
    // made by the first row: a search that computes nothing leaves no file
    let mut journal: Option<Journal> = None;
    let write: Write = Box::new(move |row: &Evaluation| match &mut journal {
        Some(journal) => journal.put(row),
        None => journal.insert(Journal::go_on(path.clone(), &lines)?).put(row),
    });
    evaluations.begin(known, write);
    Ok(damage)
}

/// Where it is.
pub fn path(folder: &ResultFolder) -> PathBuf {
    folder.path(EVALUATIONS)
}

/// Removes it: the result has all that it was for.
///
/// # Errors
/// It cannot be removed.
pub fn remove(folder: &ResultFolder) -> Result<()> {
    folder.remove(EVALUATIONS)
}
