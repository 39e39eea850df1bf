//! `slcbeam compare` of frequency responses.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::arguments::CompareArguments;
use super::compare::{answer, picture, same};
use crate::error::{Error, Result, usage};
use crate::output::folder::{self, replace_alike};
use crate::output::response;
use crate::results;
use crate::results::response::{ComparedResponses, NamedResponse};

/// Frequency responses over each other, and their peaks.
pub fn compare(asked: &CompareArguments) -> Result<ExitCode> {
    let read = |dir: &PathBuf| -> Result<NamedResponse> {
        Ok(NamedResponse {
            folder: dir.display().to_string(),
            response: folder::result(&dir.join(response::JSON))?.result,
        })
    };
    let all = ComparedResponses {
        results: asked.results.iter().map(read).collect::<Result<_>>()?,
    };
    let written = asked.out.as_ref().map_or(Ok(()), |path| {
        if !picture(path) {
            return usage(format!(
                "--out {}: for frequency responses a picture, a file that ends in .svg",
                path.display()
            ));
        }
        let here = |parent: &Path| match parent.as_os_str().is_empty() {
            true => PathBuf::from("."),
            false => parent.to_path_buf(),
        };
        let inside = |one: &&PathBuf| path.parent().is_some_and(|parent| same(one, &here(parent)));
        if let Some(folder) = asked.results.iter().find(inside) {
            return usage(format!(
                "--out {}: {} is one of the results; choose another folder",
                path.display(),
                folder.display()
            ));
        }
        let text = response::overlay(&all).and_then(|picture| picture.svg());
        let text = text.ok_or_else(|| Error::Usage("nothing to draw".into()))?;
        replace_alike(path, &text, &["<svg", "<?xml"])
    });
    answer(asked, written, || results::value(&all), || response::peaks(&all))
}
