//! Exports a result to other formats: tables of the fields, and moving surfaces.
//!
//! ```text
//! instants       choice of recorded times
//! staged_folder  a folder whose files appear together
//! tables         csv/: one table per field
//! vtk            vtk/: beam, bladders and tubes as surfaces and lines in space
//! ```

pub mod instants;
mod staged_folder;
pub mod tables;
pub mod vtk;

use std::path::{Path, PathBuf};

use super::folder::{CASE, FIELDS, RAW_FIELDS};
use super::kind::FolderKind;
use super::reading;
use crate::error::{Result, usage};
use crate::study::compare::Recording;

/// Files written in one format.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedFiles {
    /// File to open, or folder of the files.
    pub path: PathBuf,
    /// Number of files.
    pub files: usize,
    /// Total size of the files [bytes].
    pub bytes: u64,
}

impl ExportedFiles {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            files: 0,
            bytes: 0,
        }
    }

    fn count(&mut self, bytes: u64) {
        self.files += 1;
        self.bytes += bytes;
    }
}

/// Reads a result folder with its fields.
///
/// # Errors
/// [`Error::Usage`] if `dir` is no result folder or its run has not ended; [`Error::Output`] if a file cannot be read.
pub fn read(dir: &Path) -> Result<Recording> {
    let refuse = |what: &str| usage(format!("{} {what}", dir.display()));
    if let Some(what) = FolderKind::no_run(dir) {
        return usage(what);
    }
    if !dir.join(CASE).is_file() {
        return refuse("is no result folder: it has no case.json; `slcbeam run CASE --out DIR` creates one");
    }
    if !dir.join(FIELDS).is_file() {
        return if dir.join(RAW_FIELDS).is_dir() {
            refuse(
                "has no fields.npz yet: its run continues, or was killed; `slcbeam run CASE --out DIR --resume` resumes from its checkpoint",
            )
        } else {
            refuse("has no fields.npz: it contains no fields over time")
        };
    }
    reading::read(dir)
}
