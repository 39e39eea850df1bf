//! `slcbeam compare` of frequency responses.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::arguments::CompareArguments;
use super::compare::{answerable, picture, same};
use crate::error::{Error, Result};
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
            let what = format!(
                "--out {}: for frequency responses a picture, a file that ends in .svg",
                path.display()
            );
            return Err(Error::Usage(what));
        }
        let parent = path.parent().map(|parent| {
            if parent.as_os_str().is_empty() {
                Path::new(".")
            } else {
                parent
            }
        });
        if let Some(folder) = asked
            .results
            .iter()
            .find(|one| parent.is_some_and(|parent| same(one, parent)))
        {
            let what = format!(
                "--out {}: {} is one of the results; choose another folder",
                path.display(),
                folder.display()
            );
            return Err(Error::Usage(what));
        }
        let text = response::overlay(&all).and_then(|picture| picture.svg());
        let text = text.ok_or_else(|| Error::Usage("nothing to draw".into()))?;
        replace_alike(path, &text, &["<svg", "<?xml"])
    });
    let written = answerable(written)?;
    super::print(&match asked.json {
        true => results::text(&all),
        false => response::peaks(&all),
    })?;
    written.map(|()| ExitCode::SUCCESS)
}
