//! One writer per folder. The kernel holds the lock, so a killed program does not leave a folder locked.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use super::{fault, unlink};
use crate::error::Result;

/// The locked file. It names the holder and is removed with the lock.
pub const LOCK: &str = ".slcbeam.lock";

/// Attempts to lock a file that others remove at the same time.
const ATTEMPTS: usize = 100;

/// Errors of file systems without locks on Linux: ENOLCK, ENOSYS, EOPNOTSUPP.
const LOCKLESS: [i32; 3] = [37, 38, 95];

/// The right to write into a folder.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    /// `None` if the file system has no locks.
    file: Option<File>,
}

impl Lock {
    /// Locks a folder immediately, or fails.
    ///
    /// # Errors
    ///
    /// Another process holds the lock (the message names it), or the file cannot be created.
    pub fn take(dir: &Path) -> Result<Self> {
        let path = dir.join(LOCK);
        let take = || -> io::Result<Option<File>> {
            for _ in 0..ATTEMPTS {
                unlink(&path)?;
                let mut file = OpenOptions::new()
                    .read(true)
                    .write(true)
                    .create(true)
                    .truncate(false)
                    .open(&path)?;
                match file.try_lock() {
                    Ok(()) => {}
                    Err(TryLockError::WouldBlock) => {
                        let mut holder = String::new();
                        let _ = file.take(1 << 10).read_to_string(&mut holder);
                        let holder = if holder.trim().is_empty() {
                            "another process"
                        } else {
                            holder.trim()
                        };
                        let why = format!("{holder} writes into it; wait for it, or name another folder with --out");
                        return Err(io::Error::new(io::ErrorKind::ResourceBusy, why));
                    }
                    Err(TryLockError::Error(e)) if e.raw_os_error().is_some_and(|n| LOCKLESS.contains(&n)) => {
                        return Ok(None);
                    }
                    Err(TryLockError::Error(e)) => return Err(e),
                }
                // the previous holder may have removed the file after it was opened here
                if same(&file, &path) {
                    file.set_len(0)?;
                    file.rewind()?;
                    file.write_all(format!("process {} on {}\n", std::process::id(), host()).as_bytes())?;
                    return Ok(Some(file));
                }
            }
            Err(io::Error::new(
                io::ErrorKind::ResourceBusy,
                "others take and leave it all the time",
            ))
        };
        let file = take().map_err(|e| fault("use", dir, e))?;
        Ok(Self { path, file })
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // removed while still locked, so that nobody locks a file that is about to disappear
        if self.file.as_ref().is_some_and(|file| same(file, &self.path)) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// True if a path still refers to an open file.
fn same(file: &File, path: &Path) -> bool {
    let (Ok(here), Ok(there)) = (file.metadata(), fs::metadata(path)) else {
        return false;
    };
    (here.dev(), here.ino()) == (there.dev(), there.ino())
}

/// Name of this machine.
fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    match name.trim() {
        "" => "this machine".into(),
        name => name.into(),
    }
}
