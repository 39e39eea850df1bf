//! Kind of result in a folder, identified by its files.

use std::io;
use std::path::{Path, PathBuf};

use super::columns::joined;
use super::folder::{HISTORY, RUN_FILES, SUMMARY, entries, fault, name_of};
use super::uncertainty::UNCERTAINTY;
use crate::error::{Error, Result};

/// Command that filled a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FolderKind {
    /// `run`.
    Run,
    /// `equilibrium`.
    Equilibrium,
    /// `modes`.
    Modes,
    /// `study`.
    Study,
    /// `effects`.
    Effects,
    /// `floquet`.
    Floquet,
    /// `floquet --map`.
    Map,
    /// `periodic`: a run of one cycle, with its stability.
    Cycle,
    /// `periodic --sweep`.
    Sweep,
    /// `sweep`, `merge`: many designs.
    Designs,
    /// `fit`.
    Fit,
    /// `sense`.
    Sense,
    /// `optimize`.
    Optimum,
    /// `response`.
    Response,
    /// `bands`.
    Bands,
}

impl FolderKind {
    /// All kinds. A cycle precedes the run in its folder; designs precede other kinds with a `sweep.json`.
    const ALL: [Self; 15] = [
        Self::Cycle,
        Self::Designs,
        Self::Run,
        Self::Equilibrium,
        Self::Modes,
        Self::Study,
        Self::Effects,
        Self::Floquet,
        Self::Map,
        Self::Sweep,
        Self::Fit,
        Self::Sense,
        Self::Optimum,
        Self::Response,
        Self::Bands,
    ];

    /// Name on the page, command, identifying file, and all other files that the command itself writes.
    #[rustfmt::skip]
    fn entry(self) -> (&'static str, &'static str, &'static str, &'static [&'static str]) {
        match self {
            Self::Run => ("run", "run", SUMMARY, &RUN_FILES),
            Self::Equilibrium => ("equilibrium", "equilibrium", "equilibrium.json", &["path.csv", "shapes.csv", "path.svg", UNCERTAINTY]),
            Self::Modes => ("modes", "modes", "modes.json", &["modes.csv", "modes.npz", "modes.svg", UNCERTAINTY]),
            Self::Study => ("study", "study", "study.json", &["study.csv", "study.svg"]),
            Self::Effects => ("effects", "effects", "effects.json", &["effects.csv", "effects.svg"]),
            Self::Floquet => ("floquet", "floquet", "floquet.json", &["floquet.csv", "floquet.svg", UNCERTAINTY]),
            Self::Map => ("map", "floquet --map", "map.json", &["map.csv", "map.svg"]),
            Self::Cycle => ("run", "periodic", "cycle.json", &RUN_FILES),
            Self::Sweep => ("sweep", "periodic --sweep", "sweep.json", &["sweep.csv", "sweep.svg"]),
            Self::Designs => ("designs", "sweep", "plan.json", &["designs.jsonl", "sweep.json", "sweep.csv", "sweep.npz", "sweep.svg", "map.svg"]),
            Self::Fit => ("fit", "fit", "fit.json", &["fit.csv", "fit.svg", "fitted-case.json"]),
            Self::Sense => ("sense", "sense", "sense.json", &["sense.csv", "sensors.csv", "sense.svg"]),
            Self::Optimum => ("optimum", "optimize", "optimum.json", &["designs.csv", "optimum.svg", "optimum-case.json"]),
            Self::Response => ("response", "response", "response.json", &["response.csv", "response.svg", "nyquist.svg", UNCERTAINTY]),
            Self::Bands => ("bands", "bands", "bands.json", &["bands.csv", "bands.svg"]),
        }
    }

    /// Name on the page.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// The command, as it is typed.
    pub fn command(self) -> &'static str {
        self.entry().1
    }

    /// File that identifies the kind. It is written last, except the plan of `sweep`, which is written first.
    pub fn sign(self) -> &'static str {
        self.entry().2
    }

    /// All files that the command itself writes, the identifying file first; case and page are additional.
    pub fn files(self) -> Vec<&'static str> {
        [self.sign()]
            .into_iter()
            .chain(self.entry().3.iter().copied())
            .collect()
    }

    /// True if a command writes a file of this name.
    pub fn owns(name: &str) -> bool {
        Self::ALL.into_iter().any(|kind| kind.files().contains(&name))
    }

    /// Kind of the result in a folder. A killed run has a history, but no summary.
    pub fn within(dir: &Path) -> Option<Self> {
        let found = Self::ALL.into_iter().find(|kind| dir.join(kind.sign()).is_file());
        found.or_else(|| dir.join(HISTORY).is_file().then_some(Self::Run))
    }

    /// Reason why a path is not the folder of a run, if apparent: it is a case or another file, or the folder of another command.
    pub fn no_run(path: &Path) -> Option<String> {
        if path.is_file() {
            return Some(format!("{} {}", path.display(), file(path)));
        }
        match Self::within(path) {
            None | Some(Self::Run | Self::Cycle) => None,
            Some(kind) => Some(format!(
                "{} contains the result of `slcbeam {}`; a result of run or periodic is needed",
                path.display(),
                kind.command()
            )),
        }
    }

    /// Determines the kind of a result folder, for `action`.
    ///
    /// # Errors
    ///
    /// The folder does not exist or contains no result; the message lists identifying files and a result nearby.
    pub fn find(action: &'static str, dir: &Path) -> Result<Self> {
        if let Some(kind) = Self::within(dir) {
            return Ok(kind);
        }
        if dir.is_file() {
            return Err(fault(
                action,
                dir,
                io::Error::new(io::ErrorKind::NotADirectory, format!("it {}", file(dir))),
            ));
        }
        let what = match dir.is_dir() {
            true => {
                let signs = Self::ALL.map(|kind| format!("{} ({})", kind.sign(), kind.command()));
                format!("it contains no result; expected one of {}", signs.join(", "))
            }
            false => NOWHERE.into(),
        };
        Err(unfit(action, dir, what, &|_| true))
    }

    /// Checks that a folder contains a result of one of these commands, for `action`.
    ///
    /// # Errors
    ///
    /// The folder does not exist or contains something else; the message names what is expected and found, and a suitable result nearby.
    pub fn wanted(action: &'static str, dir: &Path, kinds: &[Self]) -> Result<Self> {
        let commands = kinds.iter().map(|kind| format!("`slcbeam {}`", kind.command()));
        let wanted = format!("a result of {} is needed", joined(commands, " or "));
        let what = match Self::within(dir) {
            Some(kind) if kinds.contains(&kind) => return Ok(kind),
            Some(kind) => format!("it contains a result of `slcbeam {}`; {wanted}", kind.command()),
            None if dir.is_dir() => format!("it contains no result; {wanted}"),
            None if dir.exists() => format!("it {}; {wanted}", file(dir)),
            None => format!("{NOWHERE}; {wanted}"),
        };
        Err(unfit(action, dir, what, &|kind| kinds.contains(&kind)))
    }
}

/// Description of a file in place of a folder.
fn file(path: &Path) -> String {
    let around = path.parent().filter(|dir| FolderKind::within(dir).is_some());
    match around {
        Some(dir) => format!("is a file of the result in {}: name this folder", dir.display()),
        None if path.extension().is_some_and(|x| x == "json") => {
            "is a file (perhaps a case), not a result folder; `slcbeam run CASE --out DIR` creates one".into()
        }
        None => "is a file, not a result folder".into(),
    }
}

const NOWHERE: &str = "there is no such folder";

/// Error for an unsuitable folder, with a suitable result nearby.
fn unfit(action: &'static str, dir: &Path, what: String, fits: &dyn Fn(FolderKind) -> bool) -> Error {
    let hint = near(dir, fits).map_or(String::new(), |found| format!("; did you mean {found}?"));
    let kind = match dir.is_dir() {
        true => io::ErrorKind::InvalidData,
        false => io::ErrorKind::NotFound,
    };
    fault(action, dir, io::Error::new(kind, format!("{what}{hint}")))
}

/// A result inside the folder, or else the result beside it with the most similar name.
fn near(dir: &Path, fits: &dyn Fn(FolderKind) -> bool) -> Option<String> {
    let results = |of: &Path| -> Vec<PathBuf> {
        let mut all = entries(of).unwrap_or_default();
        all.retain(|p| FolderKind::within(p).is_some_and(fits));
        all
    };
    if let Some(inside) = results(dir).first() {
        return Some(inside.display().to_string());
    }
    let name = dir.file_name()?.to_string_lossy().into_owned();
    let parent = dir
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let likeness = |path: &Path| strsim::jaro_winkler(&name, &name_of(path));
    let beside = results(parent).into_iter().map(|p| (likeness(&p), p));
    let (alike, path) = beside.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (alike > 0.7).then(|| path.display().to_string())
}
