//! The result folder: made with care, filled file by file.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// The case as resolved.
pub const CASE: &str = "case.json";
/// What came out, in numbers; written last, so that its presence says the run was brought to an end.
pub const SUMMARY: &str = "summary.json";
/// One row an output time.
pub const HISTORY: &str = "history.csv";
/// Derivatives of the history's columns, one row an output time.
pub const SENSITIVITIES: &str = "sensitivities.csv";
/// Arrays over time and space.
pub const FIELDS: &str = "fields.npz";
/// Raw arrays while a run is under way.
pub const RAW_FIELDS: &str = "fields.part";
/// Where an interrupted run goes on.
pub const CHECKPOINT: &str = "checkpoint.json";
/// The page made by `slcbeam report`.
pub const REPORT: &str = "report.html";
/// Tables of the fields made by `slcbeam export`.
pub const TABLES: &str = "csv";
/// Surfaces made by `slcbeam export`.
pub const VTK: &str = "vtk";
/// Pictures.
pub const PICTURES: [&str; 4] = ["deflection.svg", "pressure.svg", "history.svg", "energy.svg"];

/// A folder that holds one result, or will.
#[derive(Clone, Debug)]
pub struct ResultFolder {
    dir: PathBuf,
    holds_older: bool,
}

impl ResultFolder {
    /// Makes the folder and its parents, or takes over one that is empty or holds an older result.
    ///
    /// The older result stays untouched until [`ResultFolder::clear`]. A folder with other files in it is refused.
    pub fn create(dir: &Path) -> Result<Self> {
        fs::create_dir_all(dir).map_err(|e| fault("create", dir, e))?;
        let holds_older = is_result(dir);
        if !holds_older && has_files(dir)? {
            let why = "it holds files but no slcbeam result; name another folder with --out";
            return Err(fault("use", dir, io::Error::new(io::ErrorKind::AlreadyExists, why)));
        }
        Ok(Self {
            dir: dir.to_path_buf(),
            holds_older,
        })
    }

    /// Where it is.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Whether an older result was found and still stands.
    pub fn holds_older(&self) -> bool {
        self.holds_older
    }

    /// Path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Writes a file whole or not at all: under another name first, then renamed.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<PathBuf> {
        let target = self.path(name);
        let part = part_of(&target);
        let put = || -> io::Result<()> {
            let mut file = File::create(&part)?;
            file.write_all(contents)?;
            file.sync_all()?;
            drop(file);
            fs::rename(&part, &target)
        };
        put().map_err(|e| {
            let _ = fs::remove_file(&part);
            fault("write", &target, e)
        })?;
        Ok(target)
    }

    /// Removes one file, if it is there.
    pub fn remove(&self, name: &str) -> Result<()> {
        remove(&self.path(name))
    }

    /// Removes the files of an older result, by name; whatever else lies there stays.
    pub fn clear(&mut self) -> Result<()> {
        // The summary goes first: without it the rest does not pass for a finished run.
        for name in [SUMMARY, CHECKPOINT, REPORT, FIELDS, HISTORY, SENSITIVITIES]
            .into_iter()
            .chain(PICTURES)
        {
            remove(&self.path(name))?;
        }
        let raw = self.path(RAW_FIELDS);
        if raw.is_dir() {
            fs::remove_dir_all(&raw).map_err(|e| fault("remove", &raw, e))?;
        }
        // What was exported from the older result would pass for the new one's.
        for (name, endings) in [(TABLES, &["csv"][..]), (VTK, &["vtp", "pvd"])] {
            remove_folder_of(&self.path(name), endings)?;
        }
        self.holds_older = false;
        Ok(())
    }

    /// Takes over the result in another folder of the same file system, in place of its own, and removes that folder.
    pub fn replace(&mut self, with: &Path) -> Result<()> {
        self.clear()?;
        let entries = fs::read_dir(with).map_err(|e| fault("read", with, e))?;
        for entry in entries {
            let entry = entry.map_err(|e| fault("read", with, e))?;
            let target = self.dir.join(entry.file_name());
            fs::rename(entry.path(), &target).map_err(|e| fault("write", &target, e))?;
        }
        fs::remove_dir(with).map_err(|e| fault("remove", with, e))
    }

    /// Removes a folder and the result in it.
    pub fn discard(dir: &Path) -> Result<()> {
        fs::remove_dir_all(dir).map_err(|e| fault("remove", dir, e))
    }
}

/// Writes files into a folder, which is made; each whole or not at all, other files in it stay. Returns their paths.
pub(crate) fn put(dir: &Path, files: Vec<(&str, String)>) -> Result<Vec<PathBuf>> {
    fs::create_dir_all(dir).map_err(|e| fault("create", dir, e))?;
    files
        .into_iter()
        .map(|(name, text)| {
            let path = dir.join(name);
            replace(&path, &text)?;
            Ok(path)
        })
        .collect()
}

/// Writes a file whole or not at all; one that is there keeps its permissions, and what a link points to is replaced.
pub fn replace(path: &Path, text: &str) -> Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let part = part_of(&target);
    let written = || {
        let old = match fs::OpenOptions::new().write(true).open(&target) {
            Ok(file) => Some(file.metadata()?.permissions()),
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => None,
            Err(e) => return Err(e),
        };
        fs::write(&part, text)?;
        if let Some(permissions) = old {
            fs::set_permissions(&part, permissions)?;
        }
        fs::rename(&part, &target)
    };
    written().map_err(|e| fault("write", path, e))
}

/// The name under which a file grows before it takes its own.
pub(crate) fn part_of(target: &Path) -> PathBuf {
    let name = target.file_name().map(|n| n.to_string_lossy()).unwrap_or_default();
    target.with_file_name(format!(".{name}.part"))
}

/// An output error with its place.
pub(crate) fn fault(action: &'static str, path: &Path, source: io::Error) -> Error {
    Error::Output {
        action,
        path: path.to_path_buf(),
        source,
    }
}

fn remove(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(fault("remove", path, e)),
        _ => Ok(()),
    }
}

/// Removes a folder that holds nothing but files with these endings.
fn remove_folder_of(dir: &Path, endings: &[&str]) -> Result<()> {
    let Ok(entries) = fs::read_dir(dir) else { return Ok(()) };
    let ours = |e: fs::DirEntry| {
        let path = e.path();
        path.is_file() && path.extension().is_some_and(|x| endings.iter().any(|e| x == *e))
    };
    if !entries.flatten().all(ours) {
        return Ok(());
    }
    fs::remove_dir_all(dir).map_err(|e| fault("remove", dir, e))
}

/// A result has a summary with the house's keys or, when interrupted, a history that begins with time.
fn is_result(dir: &Path) -> bool {
    let summary = fs::read_to_string(dir.join(SUMMARY))
        .ok()
        .and_then(|text| serde_json::from_str::<serde_json::Value>(&text).ok())
        .is_some_and(|v| v.get("case").is_some() && v.get("status").is_some());
    summary || history_begins_with_time(&dir.join(HISTORY))
}

fn history_begins_with_time(path: &Path) -> bool {
    let mut line = String::new();
    File::open(path)
        .and_then(|f| BufReader::new(f).read_line(&mut line))
        .is_ok_and(|_| line.starts_with("t [s]"))
}

/// Hidden files do not count: systems leave them everywhere.
fn has_files(dir: &Path) -> Result<bool> {
    for entry in fs::read_dir(dir).map_err(|e| fault("read", dir, e))? {
        let entry = entry.map_err(|e| fault("read", dir, e))?;
        if !entry.file_name().to_string_lossy().starts_with('.') {
            return Ok(true);
        }
    }
    Ok(false)
}
