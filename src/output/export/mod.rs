//! A result in other programs' formats: tables of the fields, surfaces that move.
//!
//! ```text
//! instants  which of the recorded times
//! staged    a folder that appears whole
//! tables    csv/: one table a field
//! vtk       vtk/: beam, bladders and tubes as surfaces and lines in space
//! ```

pub mod instants;
mod staged;
pub mod tables;
pub mod vtk;

use std::path::{Path, PathBuf};

use super::folder::{CASE, FIELDS, RAW_FIELDS};
use super::kind::Kind;
use super::reading;
use crate::error::{Error, Result};
use crate::study::compare::Recording;

/// What was written in one format.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The file to open, or the folder of them.
    pub path: PathBuf,
    /// Number of files.
    pub files: usize,
    /// Their size [bytes].
    pub bytes: u64,
}

impl Written {
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
/// [`Error::Usage`] when it is none, or when its run has not come to an end; [`Error::Output`] when a file cannot be read.
pub fn read(dir: &Path) -> Result<Recording> {
    let usage = |what: &str| Err(Error::Usage(format!("{} {what}", dir.display())));
    if let Some(what) = Kind::no_run(dir) {
        return Err(Error::Usage(what));
    }
    if !dir.join(CASE).is_file() {
        return usage("is no result folder: it has no case.json; `slcbeam run CASE --out DIR` makes one");
    }
    if !dir.join(FIELDS).is_file() {
        return if dir.join(RAW_FIELDS).is_dir() {
            usage(
                "has no fields.npz yet: its run goes on, or was killed; `slcbeam run CASE --out DIR --resume` goes on from its checkpoint",
            )
        } else {
            usage("has no fields.npz: it holds no fields over time")
        };
    }
    reading::read(dir)
}
