//! Where a command's result goes.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::case::LoadedCase;
use crate::error::{Error, Result};
use crate::output::folder::{CASE, REPORT, ResultFolder};
use crate::output::kind::Kind;

/// A folder for results.
#[derive(Clone, Debug, Default, Args)]
pub struct PlaceArguments {
    /// Result folder [default: out/<case name>, with the command's name behind it where it is not run]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Take a folder that holds something else
    #[arg(long)]
    pub force: bool,
}

impl PlaceArguments {
    /// The folder, as asked or the usual one.
    pub fn folder(&self, name: &str, kind: Kind) -> PathBuf {
        let usual = || {
            PathBuf::from("out").join(match kind {
                Kind::Run => name.into(),
                Kind::Sweep => format!("{name}-cycles"),
                Kind::Map => format!("{name}-map"),
                other => format!("{name}-{}", other.command()),
            })
        };
        self.out.clone().unwrap_or_else(usual)
    }

    /// Takes it, before anything is computed.
    ///
    /// # Errors
    ///
    /// [`ResultFolder::claim`]; or the case itself would be written over.
    pub fn claim(&self, loaded: &LoadedCase, kind: Kind) -> Result<ResultFolder> {
        let dir = self.folder(&loaded.case.name, kind);
        if let Some(name) = overwritten(&dir, &loaded.path, kind) {
            return Err(Error::Usage(format!(
                "--out {}: its {name} is the case itself, which would be written over; name another folder",
                dir.display()
            )));
        }
        ResultFolder::claim(&dir, kind, self.force)
    }
}

/// The name under which a command would write over its case. A result's own case, as resolved, is written as it is.
fn overwritten(dir: &Path, case: &Path, kind: Kind) -> Option<String> {
    let (dir, case) = (fs::canonicalize(dir).ok()?, fs::canonicalize(case).ok()?);
    let name = case.file_name()?.to_str()?;
    let written = kind.files().into_iter().chain([CASE, REPORT]).any(|file| file == name);
    let own = name == CASE && Kind::within(&dir) == Some(kind);
    (case.parent() == Some(&dir) && written && !own).then(|| name.to_string())
}
