//! Result folder of a command.

use std::path::{Path, PathBuf};
use std::{fs, io};

use clap::Args;

use super::terminal;
use crate::case::Case;
use crate::error::{Result, usage};
use crate::output::folder::{CASE, RAW_FIELDS, REPORT, ResultFolder, TABLES, VTK, fault, other_origin, text_of};
use crate::output::kind::FolderKind;

/// A folder for results.
#[derive(Clone, Debug, Default, Args)]
pub struct PlaceArguments {
    /// Result folder [default: out/<case name>, with the command's name behind it where it is not run]
    #[arg(short, long, value_name = "DIR", value_parser = super::progress_line::output_path())]
    pub out: Option<PathBuf>,
    /// Accept a folder that contains other files
    #[arg(long)]
    pub force: bool,
}

impl PlaceArguments {
    /// The requested folder, or the default one.
    pub fn folder(&self, name: &str, kind: FolderKind) -> PathBuf {
        let usual = || {
            PathBuf::from("out").join(match kind {
                FolderKind::Run => name.into(),
                FolderKind::Sweep => format!("{name}-cycles"),
                FolderKind::Map => format!("{name}-map"),
                other => format!("{name}-{}", other.command()),
            })
        };
        self.out.clone().unwrap_or_else(usual)
    }

    /// Claims the folder, before anything is computed.
    ///
    /// # Errors
    ///
    /// Those of [`ResultFolder::claim`]; or the case itself would be overwritten.
    pub fn claim(&self, case: &Case, kind: FolderKind) -> Result<ResultFolder> {
        let dir = self.folder(&case.name, kind);
        if overwritten(&dir, case, kind) {
            return usage(format!(
                "--out {}: the case itself, {}, would be overwritten; name another folder",
                dir.display(),
                case.source.path.display()
            ));
        }
        // the user knows the content of a folder that the user names; the default one has the name in the case, which copies of a file
        // share
        if let Some(other) = other_origin(&dir, case).filter(|_| !self.force && FolderKind::within(&dir) == Some(kind))
        {
            if self.out.is_none() {
                let why = format!(
                    "it contains the result of another case file, {other}, with the same name \"{}\"; give this case \
                     a name of its own, name another folder with --out, or use this one with --force",
                    case.name
                );
                return Err(fault("use", &dir, io::Error::new(io::ErrorKind::AlreadyExists, why)));
            }
            terminal::print_line(&format!("slcbeam: {} contained the result of {other}", dir.display()));
        }
        Ok(ResultFolder::claim(&dir, kind, self.force)?.with_case(case))
    }
}

/// True if a command would overwrite its case, or remove it with the files of an older result. A result's own case, as resolved, is written
/// unchanged.
fn overwritten(dir: &Path, case: &Case, kind: FolderKind) -> bool {
    let (Ok(dir), Ok(path)) = (fs::canonicalize(dir), fs::canonicalize(&case.source.path)) else {
        return false;
    };
    if [RAW_FIELDS, TABLES, VTK]
        .iter()
        .any(|name| path.starts_with(dir.join(name)))
    {
        return true;
    }
    let name = path.file_name().unwrap_or_default();
    let written = kind.files().into_iter().chain([CASE, REPORT]).any(|file| name == file);
    let same = || text_of(&path).is_ok_and(|text| text == case.written().json);
    path.parent() == Some(&dir) && written && !(name == CASE && FolderKind::within(&dir) == Some(kind) && same())
}
