//! `slcbeam effects`: influence of each effect on a case, and the effects that the case should omit.

use std::process::ExitCode;

use super::arguments::EffectsArguments;
use super::progress_line::ProgressLine;
use super::{interrupt, journal, progress_line, resources, terminal};
use crate::case::schema::Effects;
use crate::case::{self, Case};
use crate::discrete::System;
use crate::error::{Error, Result, usage};
use crate::output::effects as files;
use crate::output::folder::replace;
use crate::output::kind::FolderKind;
use crate::output::numbers::duration;
use crate::output::report;
use crate::study::effects::choices::with;
use crate::study::effects::{Ablation, TrialEvent, TrialPlan, ablate};
use crate::study::evaluations::Evaluations;

/// Runs the models, writes the folder, prints the table and the recommendation, and writes it into the case on request.
pub fn effects(asked: &EffectsArguments) -> Result<ExitCode> {
    let case = resources::load(&asked.case)?;
    System::new(&case)?;
    System::new(&with(&case, Effects::Full))?;
    let plan = TrialPlan {
        repeats: asked.repeats,
        budget_s: super::study::seconds(&asked.budget)?,
    };
    let mut folder = asked.result.place.claim(&case, FolderKind::Effects)?;
    let evaluations = Evaluations::default();
    journal::begin(&evaluations, &folder, ("effects", &case, &format!("{plan:?}")))?;
    let flag = asked.result.wall.flag();
    let progress = ProgressLine::new(asked.result.quiet, progress_line::PLAIN);
    let found = ablate(&case, plan, asked.measure.as_deref(), &evaluations, &|event| {
        show(&progress, event);
    });
    drop(progress);
    let stopped = interrupt::raised(&flag);
    let found = journal::outcome(found, &folder, stopped)?;
    let shown = files::ShownQuantity::choose(&found, asked.measure.as_deref());
    let written = files::write(&mut folder, &found, &shown).and(report::complete(&folder, &case));
    let mut written = journal::end(&evaluations, &folder, stopped, written);
    let mut said = String::new();
    // effects that were not tried have no recommendation
    if asked.write && !stopped {
        match write(&case, &found) {
            Ok(words) => said = format!("\n{words}"),
            Err(error) => written = written.and(Err(error)),
        }
    }
    let words = || {
        let (table, sentence) = (files::table(&found, &shown), files::sentence(&found));
        format!("{table}\n{sentence}\n{said}")
    };
    super::print_result(asked.json, folder.dir(), written, || files::json(&found), words)?;
    Ok(ExitCode::from(if found.full.summary.is_none() { 4 } else { 0 }))
}

/// Writes the recommendation into the case file, whose new text must be a valid case; returns a message.
fn write(case: &Case, found: &Ablation) -> Result<String> {
    let path = &case.source.path;
    let Some(recommended) = &found.recommendation else {
        return Ok(format!("{} stays as it is", path.display()));
    };
    let wanted: Effects = serde_json::from_value(recommended.effects.clone()).unwrap_or_default();
    if case.effects == wanted {
        return Ok(format!("{} already has these effects", path.display()));
    }
    let now = case::text(path).unwrap_or_default();
    if now != case.source.text {
        let what = "changed during the search for its effects; nothing is written";
        return usage(format!("{} {what}", path.display()));
    }
    let text = case::rewrite(&case.source.text, "effects", &recommended.effects)
        .ok_or_else(|| Error::Usage(format!("{} is not a JSON object", path.display())))?;
    let again = case::parse(&text, path, path.parent().unwrap_or(path), &[])?;
    System::new(&again)?;
    replace(path, &text)?;
    Ok(format!("written into {}", path.display()))
}

/// Shows a moving line on a terminal, and a line per model elsewhere.
fn show(shown: &ProgressLine, event: &TrialEvent) {
    let spent = format!("{} of {} used", duration(event.spent_s), duration(event.budget_s));
    if let Some(bar) = &shown.bar {
        bar.set_message(format!("{} · {spent}", event.what));
        bar.tick();
    } else if shown.lines && !event.what.ends_with("again") {
        terminal::print_line(&format!("{}; {spent}", event.what));
    }
}
