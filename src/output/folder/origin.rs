//! Origin of the result in a folder: its case file, and the program that wrote it.

use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::{CASE, HISTORY, ResultFolder, open, text_of};
use crate::case::Case;
use crate::error::Result;
use crate::output::kind::FolderKind;
use crate::results;

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

/// Reason why the identifying file of a kind is foreign; `None` if it belongs to this program. It is then a JSON object with a case or, for
/// an interrupted run, a history that begins with time.
pub(super) fn foreign(dir: &Path, kind: FolderKind) -> Result<Option<String>> {
    let sign = dir.join(kind.sign());
    if !sign.exists() {
        let own = history_begins_with_time(&dir.join(HISTORY));
        return Ok((!own).then(|| format!("its {HISTORY} was not written by slcbeam")));
    }
    let text = text_of(&sign).ok();
    let own = text.is_some_and(|text| results::is_one(&text));
    Ok((!own).then(|| format!("its {} was not written by slcbeam", kind.sign())))
}

fn history_begins_with_time(path: &Path) -> bool {
    // a run that was killed immediately leaves an empty file
    let mut begin = vec![];
    open(path)
        .and_then(|file| file.take(5).read_to_end(&mut begin))
        .is_ok_and(|_| begin.is_empty() || begin == b"t [s]")
}
