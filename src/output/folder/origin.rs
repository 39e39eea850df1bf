//! Of which case file the result in a folder is.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use super::{CASE, ResultFolder, text_of};
use crate::case::Case;
use crate::error::Result;

/// The file that says it: the path from here to the case file, so that both may be moved together.
pub const ORIGIN: &str = ".slcbeam.case";

/// The case file of what is about to be written, and whether the folder says so by now.
#[derive(Debug, Default)]
pub(super) struct Origin {
    /// The way to it, where one is known.
    file: Option<String>,
    /// Whether what the folder says holds on: a run goes on, a result's own case is run.
    pub(super) stays: bool,
    told: AtomicBool,
}

impl ResultFolder {
    /// What is written from now on is of this case's file. A result's own case leaves what is there.
    #[must_use]
    pub fn of(mut self, case: &Case) -> Self {
        self.origin.file = way(&self.dir, &case.source.path);
        self.origin.stays = self.origin.file.is_none();
        self
    }

    /// Tells it, once; where it is not known nothing is told any more.
    pub(super) fn tell_origin(&self) -> Result<()> {
        if self.origin.stays || self.origin.told.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        match &self.origin.file {
            Some(file) => self.lay(ORIGIN, file.as_bytes()).map(|_| ()),
            None => self.remove(ORIGIN),
        }
    }
}

/// The other case file of which the result in a folder is; nothing where it is of this one or says the same, or where it is not known.
pub fn other_origin(dir: &Path, case: &Case) -> Option<String> {
    let there = text_of(&dir.join(ORIGIN)).ok()?;
    let here = way(dir, &case.source.path)?;
    let same = || text_of(&dir.join(CASE)).is_ok_and(|text| text == case.written().json);
    (there != here && !same()).then(|| shown(dir, &there))
}

/// The way from a folder to a file; the name alone where there is no such file, as of standard input, and nothing where it is
/// the result's own case.
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

/// A file as seen from here, as short as can be.
fn shown(dir: &Path, way: &str) -> String {
    let (Ok(whole), Ok(here)) = (fs::canonicalize(dir.join(way)), std::env::current_dir()) else {
        return way.to_owned();
    };
    whole.strip_prefix(here).unwrap_or(&whole).display().to_string()
}
