//! Files of a folder that have their final names but are not yet safe on the disk. One wait for the disk covers all of them.

use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::{mem, panic};

use super::atomic_file::{AtomicFile, Wait, at_once};
use super::{ResultFolder, fault};
use crate::error::Result;

/// Files that are not yet synced to the disk.
#[derive(Debug, Default)]
pub(super) struct UnsyncedFiles {
    files: Mutex<Vec<AtomicFile>>,
    /// Thread that syncs files to the disk.
    behind: Mutex<Option<JoinHandle<Result<()>>>>,
}

impl ResultFolder {
    /// Writes a file completely or not at all, unless the disk fails. [`ResultFolder::secure`] syncs it to the disk.
    pub fn lay(&self, name: &str, contents: &[u8]) -> Result<PathBuf> {
        self.record_origin()?;
        let target = self.path(name);
        let file = AtomicFile::fill(&target, |file| file.write_all(contents))?;
        let file = file.name()?;
        held(&self.laid.files, |files| files.push(file));
        Ok(target)
    }

    /// Takes the laid files, to sync them to the disk along with others.
    pub(crate) fn laid(&self) -> Vec<AtomicFile> {
        held(&self.laid.files, mem::take)
    }

    /// Syncs laid files, and the names of all files, to the disk.
    pub fn secure(&self) -> Result<()> {
        self.record_origin()?;
        let brought = bring(&self.laid(), &self.dir);
        self.secured_behind().and(brought)
    }

    /// Does the work of [`ResultFolder::secure`] in a thread. The next [`ResultFolder::secure`] waits for it and returns its error.
    pub fn secure_behind(&self) -> Result<()> {
        self.record_origin()?;
        self.secured_behind()?;
        let (files, dir) = (Arc::new(Mutex::new(self.laid())), self.dir.clone());
        let there = Arc::clone(&files);
        match Builder::new().spawn(move || bring(&held(&there, mem::take), &dir)) {
            Ok(behind) => held(&self.laid.behind, |place| *place = Some(behind)),
            // the system cannot start a thread
            Err(_) => bring(&held(&files, mem::take), &self.dir)?,
        }
        Ok(())
    }

    fn secured_behind(&self) -> Result<()> {
        let behind = held(&self.laid.behind, Option::take).map(JoinHandle::join);
        behind.map_or(Ok(()), |ended| {
            ended.unwrap_or_else(|panicked| panic::resume_unwind(panicked))
        })
    }

    /// Syncs the rest to the disk and waits for the thread; ignores errors.
    pub(super) fn settle(&self) {
        let files = self.laid();
        if !files.is_empty() {
            let _ = bring(&files, &self.dir);
        }
        let _ = held(&self.laid.behind, Option::take).map(JoinHandle::join);
    }
}

/// Syncs files and the names in a folder to the disk.
fn bring(files: &[AtomicFile], dir: &Path) -> Result<()> {
    let names = || {
        let sync = || File::open(dir)?.sync_all();
        sync().map_err(|e| fault("write", dir, e))
    };
    let mut all: Vec<Wait> = files.iter().map(AtomicFile::wait).collect();
    all.push(Box::new(names));
    at_once(all)
}

fn held<T, R>(what: &Mutex<T>, change: impl FnOnce(&mut T) -> R) -> R {
    change(&mut what.lock().unwrap_or_else(PoisonError::into_inner))
}
