//! The result folder: one writer at a time, no file half written, nothing of others taken.

mod cased;
mod laid;
mod lock;
mod origin;
mod whole;

use std::fs;
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::kind::Kind;
use super::uncertainty::UNCERTAINTY;
use crate::case::{Written, is_table};
use crate::error::{Error, Result};
use crate::results;
use lock::Lock;
use origin::ORIGIN;
pub use origin::other_origin;
pub(crate) use whole::{
    Wait, Whole, at_once, create, damaged, entries, name_of, open, put_whole, result, text_of, unlink,
};
pub use whole::{replace, replace_alike};

/// The case as resolved.
pub const CASE: &str = "case.json";
/// What came out, in numbers; written after history and arrays, so that its presence says that these are whole.
pub const SUMMARY: &str = "summary.json";
/// One row an output time.
pub const HISTORY: &str = "history.csv";
/// What is left of output times that the history leaves out.
pub const ENVELOPE: &str = "envelope.csv";
/// Derivatives of the history's columns, one row an output time.
pub const SENSITIVITIES: &str = "sensitivities.csv";
/// Arrays over time and space.
pub const FIELDS: &str = "fields.npz";
/// Raw arrays while a run is under way.
pub const RAW_FIELDS: &str = "fields.part";
/// Where an interrupted run goes on.
pub const CHECKPOINT: &str = "checkpoint.json";
/// The checkpoint before it, for when that is damaged.
pub const CHECKPOINT_BEFORE: &str = "checkpoint-before.json";
/// The page made by `slcbeam report`.
pub const REPORT: &str = "report.html";
/// Tables of the fields made by `slcbeam export`.
pub const TABLES: &str = "csv";
/// Surfaces made by `slcbeam export`.
pub const VTK: &str = "vtk";
/// Pictures.
pub const PICTURES: [&str; 4] = ["deflection.svg", "pressure.svg", "history.svg", "energy.svg"];
/// How the names of folders begin in which candidates are recorded.
const CANDIDATE: &str = ".next-";
/// Files of a run; the summary goes first: without it the rest does not pass for a finished run.
pub const RUN_FILES: [&str; 12] = [
    SUMMARY,
    CHECKPOINT,
    CHECKPOINT_BEFORE,
    FIELDS,
    HISTORY,
    ENVELOPE,
    SENSITIVITIES,
    UNCERTAINTY,
    PICTURES[0],
    PICTURES[1],
    PICTURES[2],
    PICTURES[3],
];

/// A folder that holds one result, or will. While this lives, no other process writes into it by this program.
#[derive(Debug)]
pub struct ResultFolder {
    dir: PathBuf,
    kind: Kind,
    older: Option<Kind>,
    /// Whether it was made here; it goes again if nothing comes into it.
    made: bool,
    lock: Option<Lock>,
    origin: origin::Origin,
    laid: laid::Laid,
}

impl ResultFolder {
    /// Makes the folder and its parents, or takes one that is empty or holds an older result of the same command, which stays
    /// untouched until [`ResultFolder::clear`].
    ///
    /// # Errors
    ///
    /// It holds something else and `force` is not given, another process writes into it, or it cannot be made.
    pub fn claim(dir: &Path, kind: Kind, force: bool) -> Result<Self> {
        let made = !dir.exists();
        if made && dir.is_symlink() {
            let why = "it is a symbolic link to what is not there";
            return Err(fault("use", dir, io::Error::new(io::ErrorKind::NotFound, why)));
        }
        fs::create_dir_all(dir).map_err(|e| fault("create", dir, e))?;
        let lock = Lock::take(dir)?;
        let older = Kind::within(dir);
        if !force {
            let why = match older {
                // a run that has not ended may be that of a cycle
                Some(Kind::Run) if kind == Kind::Cycle && !dir.join(SUMMARY).exists() => None,
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
            origin: origin::Origin::default(),
            laid: laid::Laid::default(),
        };
        folder.sweep();
        Ok(folder)
    }

    /// Removes what a killed process had half written here, which is hidden; what cannot be removed does no harm.
    fn sweep(&self) {
        let own = |half: &str| {
            let name = half.rsplit_once('.').map_or(half, |(name, _)| name);
            Kind::owns(name) || [CASE, ORIGIN, REPORT].contains(&name) || is_table(name)
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

    /// Takes the folder of a run that was interrupted.
    ///
    /// # Errors
    ///
    /// There is none, or another process writes into it.
    pub fn again(dir: &Path) -> Result<Self> {
        if Kind::within(dir) != Some(Kind::Run) {
            return Err(Error::Usage(format!("{} holds no run to go on with", dir.display())));
        }
        let mut folder = Self::claim(dir, Kind::Run, false)?;
        folder.origin.stays = true;
        Ok(folder)
    }

    /// Where it is.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Path of a file in it.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Writes a file whole or not at all: under another name first, safe on disk, then renamed.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<PathBuf> {
        self.tell_origin()?;
        let target = self.path(name);
        put_whole(&target, |file| file.write_all(contents))?;
        Ok(target)
    }

    /// Writes files, each as [`ResultFolder::write`], with what was laid before; the disk is waited for once.
    fn write_all<T: AsRef<[u8]>>(&self, files: &[(&str, T)]) -> Result<Vec<PathBuf>> {
        self.tell_origin()?;
        let fill = |(name, bytes): &(&str, T)| Whole::fill(&self.path(name), |file| file.write_all(bytes.as_ref()));
        let parts = files.iter().map(fill).collect::<Result<Vec<_>>>()?;
        let laid = self.laid();
        at_once(parts.iter().chain(&laid).map(Whole::wait).collect())?;
        parts.into_iter().try_for_each(|part| part.name().map(|_| ()))?;
        Ok(files.iter().map(|(name, _)| self.path(name)).collect())
    }

    /// Writes all files of a result that has no run in place of an older one: its numbers, its sign, then its pictures. Returns their
    /// paths. A picture that cannot be written costs no number, and the page and pictures of an older result never stay beside new numbers.
    pub fn fill<T: AsRef<[u8]>>(&mut self, files: Vec<(&str, T)>) -> Result<Vec<PathBuf>> {
        if self.older.is_some_and(|older| older != self.kind) {
            self.clear()?;
        }
        let (pictures, numbers): (Vec<_>, Vec<_>) = files.into_iter().partition(|f| f.0.ends_with(".svg"));
        let (sign, tables): (Vec<_>, Vec<_>) = numbers.into_iter().partition(|f| f.0 == self.kind.sign());
        let kept = |name: &str| tables.iter().chain(&sign).any(|f| f.0 == name);
        for name in self.kind.files().into_iter().filter(|name| !kept(name)) {
            self.remove(name)?;
        }
        let mut written = self.write_all(&tables)?;
        written.extend(self.write_all(&sign)?);
        self.secure()?;
        self.older = Some(self.kind);
        self.remove(REPORT)?;
        written.extend(self.write_all(&pictures)?);
        self.secure()?;
        Ok(written)
    }

    /// Writes all files of a result that has no run with its case, as [`ResultFolder::fill`].
    pub fn fill_with<T: AsRef<[u8]>>(&mut self, case: &Written, files: Vec<(&str, T)>) -> Result<Vec<PathBuf>> {
        self.write_tables(case)?;
        let written = self.fill(files)?;
        self.remove_other_tables(case)?;
        Ok(written)
    }

    /// The same of a result that has another case, whose tables stand beside those of its own.
    pub fn fill_with_both<T: AsRef<[u8]>>(
        &mut self,
        [own, other]: [&Written; 2],
        files: Vec<(&str, T)>,
    ) -> Result<Vec<PathBuf>> {
        let mut both = own.clone();
        let new = |table: &&(String, String)| own.tables.iter().all(|(name, _)| *name != table.0);
        both.tables.extend(other.tables.iter().filter(new).cloned());
        self.fill_with(&both, files)
    }

    /// Removes one file, if it is there.
    pub fn remove(&self, name: &str) -> Result<()> {
        remove(&self.path(name)).map(|_| ())
    }

    /// Removes files; whether any was there.
    pub fn remove_all(&self, names: &[&str]) -> Result<bool> {
        let mut any = false;
        for name in names {
            any |= remove(&self.path(name))?;
        }
        Ok(any)
    }

    /// Removes the raw arrays of a run, if they are there.
    pub fn remove_raw(&self) -> Result<()> {
        let raw = self.path(RAW_FIELDS);
        match fs::remove_dir_all(&raw) {
            Err(e) if e.kind() != io::ErrorKind::NotFound => Err(fault("remove", &raw, e)),
            _ => Ok(()),
        }
    }

    /// Removes the files of an older result, by name; whatever else lies there stays.
    pub fn clear(&mut self) -> Result<()> {
        self.tell_origin()?;
        let Some(older) = self.older else { return Ok(()) };
        // A history stays until another run's is begun, which empties it: by it the folder is known for a run's, whenever this ends.
        let stays = |name: &str| name == HISTORY && matches!(self.kind, Kind::Run | Kind::Cycle);
        for name in older.files().into_iter().chain([REPORT]).filter(|name| !stays(name)) {
            self.remove(name)?;
        }
        self.remove_raw()?;
        self.remove_exports()?;
        self.older = None;
        Ok(())
    }

    /// Removes what was exported from an older or shorter result, which would pass for the new one's.
    pub fn remove_exports(&self) -> Result<()> {
        for (name, endings) in [(TABLES, &["csv"][..]), (VTK, &["vtp", "vtm", "pvd"])] {
            remove_folder_of(&self.path(name), endings)?;
        }
        Ok(())
    }

    /// Moves the older result into a folder of its own beside this one, which is returned; `None` where there is none.
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
        // the sign last, so that what was cut short does not pass for a result
        let all = names.into_iter().chain(older.files().into_iter().rev());
        for from in self.tables()?.into_iter().chain(all.map(|name| self.path(name))) {
            if let Some(name) = from.file_name().filter(|_| from.exists()) {
                fs::rename(&from, aside.join(name)).map_err(|e| fault("move", &from, e))?;
            }
        }
        Ok(Some(aside))
    }

    /// A folder inside this one for a result that may take its place; removed when dropped.
    pub fn candidate(&self) -> Result<tempfile::TempDir> {
        let inside = tempfile::Builder::new().prefix(CANDIDATE).tempdir_in(&self.dir);
        inside.map_err(|e| fault("create", &self.dir, e))
    }

    /// Takes over the result in another folder of the same file system, in place of its own. Its summary goes first and comes last: without one
    /// nothing passes for a result.
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
            // only an empty one can be removed so
            let _ = fs::remove_dir(&self.dir);
        }
    }
}

/// An output error with its place.
pub(crate) fn fault(action: &'static str, path: &Path, source: io::Error) -> Error {
    Error::Output {
        action,
        path: path.to_path_buf(),
        source,
    }
}

/// Removes a file; whether it was there.
fn remove(path: &Path) -> Result<bool> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(fault("remove", path, e)),
        removed => Ok(removed.is_ok()),
    }
}

/// Removes a folder that holds nothing but files with these endings.
fn remove_folder_of(dir: &Path, endings: &[&str]) -> Result<()> {
    let Ok(entries) = entries(dir) else { return Ok(()) };
    let ours = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|x| endings.iter().any(|e| x == *e));
    if !entries.iter().all(ours) {
        return Ok(());
    }
    fs::remove_dir_all(dir).map_err(|e| fault("remove", dir, e))
}

/// Why the sign of a kind in a folder is not that of a result of this program, if it is not: a JSON object with a case, or, of a run
/// that was interrupted, a history that begins with time.
fn foreign(dir: &Path, kind: Kind) -> Result<Option<String>> {
    let sign = dir.join(kind.sign());
    if !sign.exists() {
        let own = history_begins_with_time(&dir.join(HISTORY));
        return Ok((!own).then(|| format!("its {HISTORY} is none of slcbeam's")));
    }
    let text = text_of(&sign).ok();
    let own = text.is_some_and(|text| results::is_one(&text));
    Ok((!own).then(|| format!("its {} is none of slcbeam's", kind.sign())))
}

fn history_begins_with_time(path: &Path) -> bool {
    // one that was killed at once has nothing in it yet
    let mut begin = vec![];
    open(path)
        .and_then(|file| file.take(5).read_to_end(&mut begin))
        .is_ok_and(|_| begin.is_empty() || begin == b"t [s]")
}

/// Hidden files do not count: systems leave them everywhere.
fn has_files(dir: &Path) -> Result<bool> {
    Ok(entries(dir)?.iter().any(|path| !name_of(path).starts_with('.')))
}
