//! Resumption of an interrupted run.

use std::path::Path;

use serde_json::Value;

use super::{Recorded, Way, complete, own, settle};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::cli::terminal;
use crate::discrete::System;
use crate::error::{Error, Result, usage};
use crate::output::Labels;
use crate::output::checkpoint;
use crate::output::folder::{CASE, ResultFolder, text_of};
use crate::output::recorder::FolderRecorder;
use crate::output::summary;
use crate::run::dynamics::{self, Outcome};
use crate::run::observe::Observer;
use crate::run::summary::Status;
use crate::study::companion;
use crate::study::compare::changes::changes;

/// Most differences between two cases that a message lists.
const DIFFERENCES: usize = 4;

/// Resumes from the newest checkpoint. A checkpoint that does not fit is rejected before any file changes; a finished run stays as it is.
pub(super) fn resume(case: &Case, system: System, asked: &[Parameter], out: &Path, way: &Way) -> Result<Recorded> {
    let folder = ResultFolder::again(out)?;
    let Some((saved, damage)) = checkpoint::read(out)? else {
        return Ok(Recorded {
            outcome: ended(case, asked, &folder)?,
            finished: None,
            aside: None,
            written: Ok(()),
        });
    };
    if saved.run.case != case.resolved_json() {
        return Err(another_case(&saved.run.case, case, "the checkpoint"));
    }
    saved.run.fits(case, &system)?;
    let kept = saved.run.forward.as_ref().map_or(&[][..], |kept| &kept.parameters);
    if !asked.is_empty() && asked != kept {
        return Err(other_derivatives(kept));
    }
    if let Some(damage) = damage {
        terminal::print_line(&format!("slcbeam: {damage}; going on from the one before"));
    }
    let header = Observer::header(case, &system);
    let mut recorder =
        FolderRecorder::resume(folder, Labels::from_case(case), own(&way.hook), &saved, &header)?.lean(way.lean);
    let outcome = match way.has_companion(case, kept) {
        true => companion::resume(case, system, &saved.run, &mut recorder)?,
        false => dynamics::resume(case, system, &saved.run, &mut recorder)?,
    };
    settle(case, complete(recorder, outcome, way)?, kept, way)
}

/// Outcome of a finished run without a checkpoint, from its summary; remaining raw arrays are removed.
fn ended(case: &Case, asked: &[Parameter], folder: &ResultFolder) -> Result<Outcome> {
    let summary = summary::read(folder.dir())
        .ok()
        .filter(|s| s.status == Status::Finished);
    let summary = summary.ok_or_else(|| {
        let dir = folder.dir().display();
        Error::Usage(format!(
            "{dir} contains no checkpoint to resume from; set /time/checkpoint_interval_s to write checkpoints"
        ))
    })?;
    let there = text_of(&folder.path(CASE))?;
    if there != case.resolved_json() {
        return Err(another_case(&there, case, "the result"));
    }
    if !asked.iter().all(|p| summary.sensitivities.contains_key(&p.pointer)) {
        return usage(
            "--sensitivity: the finished run does not contain these derivatives; run it again without --resume",
        );
    }
    folder.remove_raw()?;
    terminal::print_line("slcbeam: the run had ended; nothing to resume");
    Ok(Outcome { summary, fault: None })
}

/// Error with the numbers by which the resumed run is differentiated.
fn other_derivatives(kept: &[Parameter]) -> Error {
    let kept: Vec<&str> = kept.iter().map(|p| p.pointer.as_str()).collect();
    let kept = match kept.is_empty() {
        true => "no number".into(),
        false => kept.join(", "),
    };
    Error::Usage(format!(
        "--sensitivity: the run in the folder is differentiated by {kept}; resume it without --sensitivity. Nothing \
         was changed"
    ))
}

/// Error with the differences of two cases.
fn another_case(there: &str, here: &Case, whose: &str) -> Error {
    let value = |text: &str| serde_json::from_str::<Value>(text).unwrap_or_default();
    let (physics, numerics) = changes(&value(there), &value(&here.resolved_json()));
    let mut differences: Vec<String> = physics
        .iter()
        .chain(&numerics)
        .map(|c| format!("{} is {} there and {} here", c.pointer, c.a, c.b))
        .collect();
    let more = differences.len().saturating_sub(DIFFERENCES);
    differences.truncate(DIFFERENCES);
    if more > 0 {
        differences.push(format!("and {more} more"));
    }
    if differences.is_empty() {
        differences.push("name or description differs".into());
    }
    Error::Usage(format!(
        "{whose} belongs to another case: {}; nothing was changed",
        differences.join(", ")
    ))
}
