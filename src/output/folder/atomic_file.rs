//! Files that appear completely or not at all, and reading of files with a known end.

use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::thread;

use super::fault;
use crate::case::reading;
use crate::error::Result;
use crate::numerics::threads::{StartedTask, begin};
use crate::results::{self, ResultFile, StoredResult};

/// Writes a file that the user names, completely or not at all. An existing file keeps its permissions; the target of a link is replaced.
pub fn replace(path: &Path, text: impl AsRef<[u8]>) -> Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let old = match fs::OpenOptions::new()
        .write(true)
        .open(&target)
        .and_then(|file| file.metadata())
    {
        Ok(there) if !there.is_file() => {
            // a pipe or a device receives the text directly
            return fs::write(&target, text).map_err(|e| fault("write", path, e));
        }
        Ok(there) => Some(there.permissions()),
        Err(e) if e.kind() == io::ErrorKind::NotFound => None,
        Err(e) => return Err(fault("write", path, e)),
    };
    put_whole(&target, |file| {
        file.write_all(text.as_ref())?;
        old.map_or(Ok(()), |permissions| file.set_permissions(permissions))
    })
}

/// Writes a page or picture to a path of the user. It replaces only a file that has one of the `beginnings`, or an empty one.
///
/// # Errors
/// The existing file begins differently, or the file cannot be written.
pub fn replace_alike(path: &Path, text: impl AsRef<[u8]>, beginnings: &[&str]) -> Result<()> {
    let mut begin = vec![];
    let there = fs::metadata(path).is_ok_and(|there| there.is_file());
    let read = !there
        || open(path)
            .and_then(|file| file.take(64).read_to_end(&mut begin))
            .is_ok();
    let begin = String::from_utf8_lossy(&begin).trim_start().to_lowercase();
    if !read || !(begin.is_empty() || beginnings.iter().any(|b| begin.starts_with(b))) {
        let why = "it holds something else, which would be lost; name another file with --out";
        return Err(fault("write", path, io::Error::new(io::ErrorKind::AlreadyExists, why)));
    }
    replace(path, text)
}

/// Writes a picture, SVG or PDF, to a path of the user. An existing picture is replaced on request only.
///
/// # Errors
/// The file exists, or it cannot be written.
pub fn replace_picture(path: &Path, bytes: &[u8], force: bool) -> Result<()> {
    if path.is_file() && !force {
        let why = "it exists; name another file with --out, or replace it with --force";
        return Err(fault("write", path, io::Error::new(io::ErrorKind::AlreadyExists, why)));
    }
    replace_alike(path, bytes, &["<svg", "<?xml", "%pdf"])
}

/// Fills a file under a hidden name, syncs it to the disk and renames it. A file that cannot be filled is removed.
pub(crate) fn put_whole(target: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<()> {
    let file = AtomicFile::fill(target, fill)?;
    file.secure()?;
    file.name().map(|_| ())
}

/// A complete file with a hidden name; it is removed on drop unless it was renamed.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    target: PathBuf,
    /// Hidden name; `None` after renaming.
    part: Option<PathBuf>,
    file: File,
}

impl AtomicFile {
    /// Creates and fills the file.
    pub(crate) fn fill(target: &Path, fill: impl FnOnce(&mut File) -> io::Result<()>) -> Result<Self> {
        let part = part_of(target);
        let file = create(&part).map_err(|e| fault("write", target, e))?;
        let mut made = Self {
            target: target.to_path_buf(),
            part: Some(part),
            file,
        };
        match fill(&mut made.file) {
            Ok(()) => Ok(made),
            Err(e) => Err(fault("write", target, e)),
        }
    }

    /// Syncs the content to the disk.
    pub(crate) fn secure(&self) -> Result<()> {
        self.file.sync_all().map_err(|e| fault("write", &self.target, e))
    }

    /// [`AtomicFile::secure`] as a task for [`at_once`].
    pub(crate) fn wait(&self) -> Wait<'_> {
        Box::new(|| self.secure())
    }

    /// Renames the file to its final name, in place of an existing file.
    pub(crate) fn name(mut self) -> Result<Self> {
        if let Some(part) = &self.part {
            fs::rename(part, &self.target).map_err(|e| fault("write", &self.target, e))?;
        }
        self.part = None;
        Ok(self)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if let Some(part) = &self.part {
            let _ = fs::remove_file(part);
        }
    }
}

/// A task that waits for the disk.
pub(crate) type Wait<'a> = Box<dyn FnOnce() -> Result<()> + Send + 'a>;

/// Runs all tasks at the same time, each in a thread, so that they wait for the disk together.
///
/// # Errors
/// The first error in the order of the tasks; all tasks have ended.
pub(crate) fn at_once(mut all: Vec<Wait>) -> Result<()> {
    let Some(last) = all.pop() else { return Ok(()) };
    thread::scope(|scope| {
        let others: Vec<_> = all.into_iter().map(|one| begin(scope, one)).collect();
        let last = last();
        let ended = others.into_iter().map(StartedTask::join);
        ended.fold(Ok(()), Result::and).and(last)
    })
}

/// Paths of all entries of a folder, sorted.
pub(crate) fn entries(dir: &Path) -> Result<Vec<PathBuf>> {
    let list = || -> io::Result<Vec<PathBuf>> { fs::read_dir(dir)?.map(|entry| Ok(entry?.path())).collect() };
    let mut all = list().map_err(|e| fault("read", dir, e))?;
    all.sort();
    Ok(all)
}

/// Last part of a path.
pub(crate) fn name_of(path: &Path) -> String {
    path.file_name()
        .map(|n| n.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Hidden name of a file until it is complete.
fn part_of(target: &Path) -> PathBuf {
    let name = target.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
    target.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

/// Largest text of a result that is read in one piece [byte]; tables and arrays are read in parts.
const LARGEST: u64 = 64 << 20;

/// Creates an empty file of a result. A symbolic link in its place is removed, so that nothing is written through the link.
pub(crate) fn create(path: &Path) -> io::Result<File> {
    unlink(path)?;
    File::create(path)
}

/// Removes a symbolic link; anything else stays.
pub(crate) fn unlink(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink()) {
        true => fs::remove_file(path),
        false => Ok(()),
    }
}

/// Opens a file of a result for reading. Rejects pipes and devices, which may never end.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    reading::open(path)
}

/// Error of a damaged file.
pub(crate) fn damaged(why: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, why.into())
}

/// Reads the result in a file.
pub(crate) fn result<T: ResultFile>(path: &Path) -> Result<StoredResult<T>> {
    results::read(&text_of(path)?).map_err(|e| fault("read", path, e))
}

/// Reads the text of a file of a result.
pub(crate) fn text_of(path: &Path) -> Result<String> {
    let read = || -> io::Result<String> {
        let file = open(path)?;
        let there = file.metadata()?.len();
        if there > LARGEST {
            let why = format!("it has {there} bytes; no such file of a result has more than {LARGEST}");
            return Err(damaged(why));
        }
        let mut text = String::new();
        io::Read::take(file, LARGEST).read_to_string(&mut text)?;
        Ok(text)
    };
    read().map_err(|e| fault("read", path, e))
}
