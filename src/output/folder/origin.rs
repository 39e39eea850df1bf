//! Case file to which the result in a folder belongs.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::{CASE, ResultFolder, text_of};
use crate::case::Case;
use crate::error::Result;

/// File with the relative path from the folder to the case file. Both can be moved together.
pub const ORIGIN: &str = ".slcbeam.case";

/// Case file of the next result, and whether the folder already names it.
#[derive(Debug, Default)]
pub(super) struct CaseOrigin {
    /// Path to the case file, if known.
    file: Option<String>,
    /// True if the recorded path stays: a run resumes, or the case in the folder itself is run.
    pub(super) stays: bool,
    recorded: AtomicBool,
}

impl ResultFolder {
    /// Assigns the next results to the file of this case. A case in the folder itself leaves the recorded path as it is.
    #[must_use]
    pub fn with_case(mut self, case: &Case) -> Self {
        self.origin.file = way(&self.dir, &case.source.path);
        self.origin.stays = self.origin.file.is_none();
        self
    }

    /// Records the path once; removes an old record if the path is unknown.
    pub(super) fn record_origin(&self) -> Result<()> {
        if self.origin.stays || self.origin.recorded.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        match &self.origin.file {
            Some(file) => self.lay(ORIGIN, file.as_bytes()).map(|_| ()),
            None => self.remove(ORIGIN),
        }
    }
}

/// The recorded case file of a folder; `None` if it is the file of `case`, has the same content, or is unknown.
pub fn other_origin(dir: &Path, case: &Case) -> Option<String> {
    let there = text_of(&dir.join(ORIGIN)).ok()?;
    let here = way(dir, &case.source.path)?;
    let same = || text_of(&dir.join(CASE)).is_ok_and(|text| text == case.written().json);
    (there != here && !same()).then(|| shown(dir, &there))
}

/// Relative path from a folder to a file. A file that does not exist, such as standard input, keeps its name; the case in the folder itself
/// gives `None`.
fn way(dir: &Path, file: &Path) -> Option<String> {
    let (Ok(dir), Ok(whole)) = (fs::canonicalize(dir), fs::canonicalize(file)) else {
        return Some(file.display().to_string());
    };
    if whole == dir.join(CASE) {
        return None;
    }
    let common = dir
        .components()
        .zip(whole.components())
        .take_while(|(a, b)| a == b)
        .count();
    let up = dir.components().skip(common).map(|_| "..");
    let down = whole.components().skip(common);
    let way: PathBuf = up
        .map(Path::new)
        .chain(down.map(|part| Path::new(part.as_os_str())))
        .collect();
    Some(way.display().to_string())
}

/// Path of a file, relative to the current directory if it lies there.
fn shown(dir: &Path, way: &str) -> String {
    let (Ok(whole), Ok(here)) = (fs::canonicalize(dir.join(way)), std::env::current_dir()) else {
        return way.to_owned();
    };
    whole.strip_prefix(here).unwrap_or(&whole).display().to_string()
}
