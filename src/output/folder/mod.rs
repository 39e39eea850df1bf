//! The result folder: one writer at a time, no incomplete file, no foreign file removed.

mod atomic_file;
mod lock;
mod origin;
mod stored_case;
mod unsynced_files;

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::kind::FolderKind;
use super::uncertainty::UNCERTAINTY;
use crate::case::{CaseText, is_table};
use crate::error::{Error, Result, usage};
pub(crate) use atomic_file::{
    AtomicFile, Wait, at_once, create, damaged, entries, name_of, open, put_whole, result, text_of, unlink,
};
pub use atomic_file::{replace, replace_alike, replace_picture};
use lock::Lock;
pub use origin::other_origin;
use origin::{ORIGIN, foreign};

/// The resolved case.
pub const CASE: &str = "case.json";
/// Results as numbers. Written after history and arrays: its presence means that these are complete.
pub const SUMMARY: &str = "summary.json";
/// One row per output time.
pub const HISTORY: &str = "history.csv";
/// Statistics over output times that the history leaves out.
pub const ENVELOPE: &str = "envelope.csv";
/// Derivatives of the history's columns, one row per output time.
pub const SENSITIVITIES: &str = "sensitivities.csv";
/// Half widths of the error bands of the history's columns.
pub const ERRORS: &str = "errors.csv";
/// Arrays over time and space.
pub const FIELDS: &str = "fields.npz";
/// Raw arrays during a run.
pub const RAW_FIELDS: &str = "fields.part";
/// State from which an interrupted run resumes.
pub const CHECKPOINT: &str = "checkpoint.json";
/// The previous checkpoint, used if the newest is damaged.
pub const CHECKPOINT_BEFORE: &str = "checkpoint-before.json";
/// The page made by `slcbeam report`.
pub const REPORT: &str = "report.html";
/// Tables of the fields made by `slcbeam export`.
pub const TABLES: &str = "csv";
/// Surfaces made by `slcbeam export`.
pub const VTK: &str = "vtk";
/// Pictures.
pub const PICTURES: [&str; 4] = ["deflection.svg", "pressure.svg", "history.svg", "energy.svg"];
/// Prefix of the folders in which candidates are recorded.
const CANDIDATE: &str = ".next-";
/// Files of a run. The summary is removed first: without it the others do not count as a finished run.
pub const RUN_FILES: [&str; 13] = [
    SUMMARY,
    CHECKPOINT,
    CHECKPOINT_BEFORE,
    FIELDS,
    HISTORY,
    ENVELOPE,
    ERRORS,
    SENSITIVITIES,
    UNCERTAINTY,
    PICTURES[0],
    PICTURES[1],
    PICTURES[2],
    PICTURES[3],
];

/// A folder for one result. While this value lives, no other process of this program writes into the folder.
#[derive(Debug)]
pub struct ResultFolder {
    dir: PathBuf,
    kind: FolderKind,
    older: Option<FolderKind>,
    /// True if the folder was created here. It is removed on drop if it is empty.
    made: bool,
    lock: Option<Lock>,
    origin: origin::CaseOrigin,
    laid: unsynced_files::UnsyncedFiles,
}

impl ResultFolder {
    /// Creates the folder and its parents, or claims a folder that is empty or has an older result of the same command. The older result
    /// stays until [`ResultFolder::clear`].
    ///
    /// # Errors
    ///
    /// The folder has other content and `force` is not given, another process writes into it, or it cannot be created.
    pub fn claim(dir: &Path, kind: FolderKind, force: bool) -> Result<Self> {
        let made = !dir.exists();
        if made && dir.is_symlink() {
            let why = "it is a symbolic link whose target does not exist";
            return Err(fault("use", dir, io::Error::new(io::ErrorKind::NotFound, why)));
        }
        if dir.is_file() {
            let why = "it is a file; name a folder that is new or empty";
            return Err(fault("use", dir, io::Error::new(io::ErrorKind::AlreadyExists, why)));
        }
        fs::create_dir_all(dir).map_err(|e| fault("create", dir, e))?;
        let lock = Lock::take(dir)?;
        let older = FolderKind::within(dir);
        if !force {
            let why = match older {
                // a run that has not ended may belong to a cycle
                Some(FolderKind::Run) if kind == FolderKind::Cycle && !dir.join(SUMMARY).exists() => None,
                Some(older) if older == kind => foreign(dir, kind)?,
                Some(older) => Some(format!("it holds the result of `slcbeam {}`", older.command())),
                None if has_files(dir)? => Some("it holds files but no slcbeam result".into()),
                None => None,
            };
            if let Some(why) = why {
                let why = format!("{why}; name another folder with --out, or take this one with --force");
                return Err(fault("use", dir, io::Error::new(io::ErrorKind::AlreadyExists, why)));
            }
        }
        let folder = Self {
            dir: dir.to_path_buf(),
            kind,
            older,
            made,
            lock: Some(lock),
            origin: origin::CaseOrigin::default(),
            laid: unsynced_files::UnsyncedFiles::default(),
        };
        folder.sweep();
        Ok(folder)
    }

    /// Removes hidden incomplete files of a killed process; ignores those that cannot be removed.
    fn sweep(&self) {
        let own = |half: &str| {
            let name = half.rsplit_once('.').map_or(half, |(name, _)| name);
            FolderKind::owns(name) || [CASE, ORIGIN, REPORT].contains(&name) || is_table(name)
        };
        for path in entries(&self.dir).unwrap_or_default() {
            let name = name_of(&path);
            let half = name.strip_prefix('.').and_then(|name| name.strip_suffix(".part"));
            if half.is_some_and(own) {
                let _ = fs::remove_file(&path);
            } else if name.starts_with(CANDIDATE) && path.is_dir() {
                let _ = fs::remove_dir_all(&path);
            }
        }
    }

    /// Claims the folder of an interrupted run.
    ///
    /// # Errors
    /// There is no run, or another process writes into the folder.
    pub fn again(dir: &Path) -> Result<Self> {
        if FolderKind::within(dir) != Some(FolderKind::Run) {
            let what = if dir.exists() {
                "contains no run to resume"
            } else {
                "does not exist"
            };
            return usage(format!(
                "{} {what}; run without --resume, with /time/checkpoint_interval_s in the case",
                dir.display()
            ));
        }
        let mut folder = Self::claim(dir, FolderKind::Run, false)?;
        folder.origin.stays = true;
        Ok(folder)
    }

    /// Path of the folder.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Writes a file completely or not at all: under a hidden name first, then renamed when safe on disk.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<PathBuf> {
        self.record_origin()?;
        let target = self.path(name);
        put_whole(&target, |file| file.write_all(contents))?;
        Ok(target)
    }

    /// Writes files, each as [`ResultFolder::write`], together with laid files; waits for the disk once.
    fn write_all<T: AsRef<[u8]>>(&self, files: &[(&str, T)]) -> Result<()> {
        self.record_origin()?;
        let fill =
            |(name, bytes): &(&str, T)| AtomicFile::fill(&self.path(name), |file| file.write_all(bytes.as_ref()));
        let parts = files.iter().map(fill).collect::<Result<Vec<_>>>()?;
        let laid = self.laid();
        at_once(parts.iter().chain(&laid).map(AtomicFile::wait).collect())?;
        parts.into_iter().try_for_each(|part| part.name().map(|_| ()))
    }

    /// Writes all files of a result without a run in place of an older one: numbers, the file that identifies the kind, then pictures.
    /// If a picture cannot be written, the numbers stay. Page and pictures of an older result never remain beside new numbers.
    pub fn fill<'n, T: AsRef<[u8]>>(
        &mut self,
        files: impl IntoIterator<Item = (&'n str, T)>,
        pictures: impl IntoIterator<Item = (&'n str, Option<String>)>,
    ) -> Result<()> {
        if self.older.is_some_and(|older| older != self.kind) {
            self.clear()?;
        }
        let (sign, tables): (Vec<_>, Vec<_>) = files.into_iter().partition(|f| f.0 == self.kind.sign());
        let kept = |name: &str| tables.iter().chain(&sign).any(|f| f.0 == name);
        for name in self.kind.files().into_iter().filter(|name| !kept(name)) {
            self.remove(name)?;
        }
        self.write_all(&tables)?;
        self.write_all(&sign)?;
        self.secure()?;
        self.older = Some(self.kind);
        self.remove(REPORT)?;
        let drawn = pictures.into_iter().filter_map(|(name, text)| Some((name, text?)));
        self.write_all(&drawn.collect::<Vec<_>>())?;
        self.secure()
    }

    /// Writes all files of a result without a run, with its case, as [`ResultFolder::fill`].
    pub fn fill_with(
        &mut self,
        case: &CaseText,
        mut files: Vec<(&str, String)>,
        picture: (&str, Option<String>),
    ) -> Result<()> {
        files.push((CASE, case.json.clone()));
        self.write_tables(case)?;
        self.fill(files, [picture])?;
        self.remove_other_tables(case)
    }

    /// Writes a result with a second case of this name, whose tables are stored beside those of its own, as [`ResultFolder::fill_with`].
    pub fn fill_with_both(
        &mut self,
        own: &CaseText,
        (name, other): (&'static str, &CaseText),
        mut files: Vec<(&str, String)>,
        picture: (&str, Option<String>),
    ) -> Result<()> {
        files.push((name, other.json.clone()));
        let mut both = own.clone();
        let new = |table: &&(String, String)| own.tables.iter().all(|(name, _)| *name != table.0);
        both.tables.extend(other.tables.iter().filter(new).cloned());
        self.fill_with(&both, files, picture)
    }

    /// Removes a file, if it exists.
    pub fn remove(&self, name: &str) -> Result<()> {
        remove(&self.path(name)).map(|_| ())
    }

    /// Removes files. Returns true if any existed.
    pub fn remove_all(&self, names: &[&str]) -> Result<bool> {
        let mut any = false;
        for name in names {
            any |= remove(&self.path(name))?;
        }
        Ok(any)
    }

    /// Removes the raw arrays of a run, if they exist.
    pub fn remove_raw(&self) -> Result<()> {
        let raw = self.path(RAW_FIELDS);
        match fs::remove_dir_all(&raw) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(fault("remove", &raw, e)),
            _ => Ok(()),
        }
    }

    /// Removes the files of an older result by name; all others stay.
    pub fn clear(&mut self) -> Result<()> {
        self.record_origin()?;
        let Some(older) = self.older else { return Ok(()) };
        // A history stays until another run begins and empties it. Until then it identifies the folder as that of a run.
        let stays = |name: &str| name == HISTORY && matches!(self.kind, FolderKind::Run | FolderKind::Cycle);
        for name in older.files().into_iter().chain([REPORT]).filter(|name| !stays(name)) {
            self.remove(name)?;
        }
        self.remove_raw()?;
        self.remove_exports()?;
        self.older = None;
        Ok(())
    }

    /// Removes exports of an older or shorter result, which could be mistaken for those of the new one.
    pub fn remove_exports(&self) -> Result<()> {
        for (name, endings) in [(TABLES, &["csv"][..]), (VTK, &["vtp", "vtm", "pvd"])] {
            remove_folder_of(&self.path(name), endings)?;
        }
        Ok(())
    }

    /// Moves the older result into a new folder beside this one and returns its path; `None` if there is no older result.
    pub fn set_aside(&mut self) -> Result<Option<PathBuf>> {
        let Some(older) = self.older.take() else {
            return Ok(None);
        };
        let whole = fs::canonicalize(&self.dir).map_err(|e| fault("read", &self.dir, e))?;
        let name = |k: usize| {
            let mut name = whole.as_os_str().to_owned();
            name.push(if k == 0 {
                ".older".into()
            } else {
                format!(".older-{}", k + 1)
            });
            PathBuf::from(name)
        };
        let aside = (0..).map(name).find(|dir| !dir.exists()).unwrap_or_else(|| name(0));
        fs::create_dir_all(&aside).map_err(|e| fault("create", &aside, e))?;
        let names = [RAW_FIELDS, TABLES, VTK, CASE, ORIGIN, REPORT];
        // the identifying file last, so that an incomplete move does not count as a result
        let all = names.into_iter().chain(older.files().into_iter().rev());
        for from in self.tables()?.into_iter().chain(all.map(|name| self.path(name))) {
            if let Some(name) = from.file_name().filter(|_| from.exists()) {
                fs::rename(&from, aside.join(name)).map_err(|e| fault("move", &from, e))?;
            }
        }
        Ok(Some(aside))
    }

    /// Creates a folder inside this one for a result that may replace it; removed when dropped.
    pub fn candidate(&self) -> Result<tempfile::TempDir> {
        let inside = tempfile::Builder::new().prefix(CANDIDATE).tempdir_in(&self.dir);
        inside.map_err(|e| fault("create", &self.dir, e))
    }

    /// Replaces the result by that of another folder on the same file system. The summary is removed first and moved last: without it
    /// nothing counts as a result.
    pub fn replace(&mut self, with: &Path) -> Result<()> {
        self.clear()?;
        self.remove_all(&[SUMMARY, CHECKPOINT_BEFORE, CHECKPOINT])?;
        self.remove_raw()?;
        let mut names: Vec<String> = entries(with)?.iter().map(|path| name_of(path)).collect();
        names.retain(|name| !name.starts_with('.'));
        names.sort_by_key(|name| (name == self.kind.sign(), name == SUMMARY));
        for name in names {
            let target = self.path(&name);
            fs::rename(with.join(&name), &target).map_err(|e| fault("write", &target, e))?;
        }
        self.secure()
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        self.settle();
        self.lock.take();
        if self.made {
            // removes only an empty folder
            let _ = fs::remove_dir(&self.dir);
        }
    }
}

/// An output error with its path.
pub(crate) fn fault(action: &'static str, path: &Path, source: io::Error) -> Error {
    Error::Output {
        action,
        path: path.to_path_buf(),
        source,
    }
}

/// Removes a file. Returns true if it existed.
fn remove(path: &Path) -> Result<bool> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(fault("remove", path, e)),
        removed => Ok(removed.is_ok()),
    }
}

/// Removes a folder if it contains only files with these endings.
fn remove_folder_of(dir: &Path, endings: &[&str]) -> Result<()> {
    let Ok(entries) = entries(dir) else { return Ok(()) };
    let ours = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|x| endings.iter().any(|e| x == *e));
    if !entries.iter().all(ours) {
        return Ok(());
    }
    fs::remove_dir_all(dir).map_err(|e| fault("remove", dir, e))
}

/// True if a folder has visible files. Hidden files do not count: systems create them everywhere.
fn has_files(dir: &Path) -> Result<bool> {
    Ok(entries(dir)?.iter().any(|path| !name_of(path).starts_with('.')))
}
