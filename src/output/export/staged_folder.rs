//! A folder whose files appear only when all are written.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::error::Result;
use crate::output::folder::{entries, fault, name_of};

/// Files on their way into a folder. If dropped before [`StagedFolder::place`], they leave nothing behind.
pub struct StagedFolder {
    inside: TempDir,
    target: PathBuf,
}

impl StagedFolder {
    /// Prepares files for the folder `name` in `result`, which is created if necessary.
    pub fn new(result: &Path, name: &str) -> Result<Self> {
        fs::create_dir_all(result).map_err(|e| fault("create", result, e))?;
        let inside = tempfile::Builder::new().prefix(".export-").tempdir_in(result);
        Ok(Self {
            inside: inside.map_err(|e| fault("create", result, e))?,
            target: result.join(name),
        })
    }

    /// Path at which a file is written first.
    pub fn path(&self, name: &str) -> PathBuf {
        self.inside.path().join(name)
    }

    /// The final folder.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Moves the files into their folder. Removes files with `older` names there first; others stay.
    pub fn place(self, older: impl Fn(&str) -> bool) -> Result<()> {
        fs::create_dir_all(&self.target).map_err(|e| fault("create", &self.target, e))?;
        for path in entries(&self.target)?.iter().filter(|path| older(&name_of(path))) {
            fs::remove_file(path).map_err(|e| fault("remove", path, e))?;
        }
        for from in entries(self.inside.path())? {
            let to = self.target.join(name_of(&from));
            fs::rename(&from, &to).map_err(|e| fault("write", &to, e))?;
        }
        Ok(())
    }
}
