//! What kind of result a folder holds, by the files in it.

use std::fs;
use std::io;
use std::path::Path;

use crate::error::Result;
use crate::output::folder::{HISTORY, SUMMARY, fault};

/// Which command filled a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `run`, or a cycle of `periodic`.
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
    /// `periodic --sweep`.
    Sweep,
}

/// Kind, the file that tells it, and the command.
const SIGNS: [(Kind, &str, &str); 8] = [
    (Kind::Run, SUMMARY, "run"),
    (Kind::Equilibrium, "equilibrium.json", "equilibrium"),
    (Kind::Modes, "modes.json", "modes"),
    (Kind::Study, "study.json", "study"),
    (Kind::Effects, "effects.json", "effects"),
    (Kind::Floquet, "floquet.json", "floquet"),
    (Kind::Map, "map.json", "floquet --map"),
    (Kind::Sweep, "sweep.json", "periodic --sweep"),
];

impl Kind {
    /// Name in the page.
    pub fn name(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Equilibrium => "equilibrium",
            Self::Modes => "modes",
            Self::Study => "study",
            Self::Effects => "effects",
            Self::Floquet => "floquet",
            Self::Map => "map",
            Self::Sweep => "sweep",
        }
    }

    /// Looks at the files of a folder.
    ///
    /// # Errors
    ///
    /// There is no such folder, or nothing in it is a result; the message names what would be one, and a result nearby.
    pub fn find(dir: &Path) -> Result<Self> {
        if let Some(kind) = within(dir) {
            return Ok(kind);
        }
        let exists = dir.is_dir();
        let what = if exists {
            let signs: Vec<String> = SIGNS.iter().map(|(_, file, of)| format!("{file} ({of})")).collect();
            format!("it holds no result, which would be one of {}", signs.join(", "))
        } else {
            "there is no such folder".into()
        };
        let hint = near(dir).map_or(String::new(), |found| format!("; did you mean {found}?"));
        let kind = if exists {
            io::ErrorKind::InvalidData
        } else {
            io::ErrorKind::NotFound
        };
        Err(fault("report on", dir, io::Error::new(kind, format!("{what}{hint}"))))
    }
}

fn within(dir: &Path) -> Option<Kind> {
    let sign = SIGNS.iter().find(|(_, file, _)| dir.join(file).is_file());
    // A run that was killed has a history, but no summary yet.
    sign.map(|s| s.0)
        .or_else(|| dir.join(HISTORY).is_file().then_some(Kind::Run))
}

/// A result in the folder, or else the one beside it whose name is most like it.
fn near(dir: &Path) -> Option<String> {
    let results = |of: &Path| -> Vec<std::path::PathBuf> {
        let entries = fs::read_dir(of).into_iter().flatten().flatten().map(|e| e.path());
        let mut all: Vec<_> = entries.filter(|p| within(p).is_some()).collect();
        all.sort();
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
    let likeness = |path: &Path| {
        let other = path.file_name().map(|n| n.to_string_lossy().into_owned());
        strsim::jaro_winkler(&name, &other.unwrap_or_default())
    };
    let beside = results(parent).into_iter().map(|p| (likeness(&p), p));
    let (alike, path) = beside.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (alike > 0.7).then(|| path.display().to_string())
}
