//! `slcbeam run`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::arguments::RunArguments;
use super::progress::Watcher;
use super::{interrupt, summary_box, terminal};
use crate::case;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::model::characteristic;
use crate::output::checkpoint;
use crate::output::folder::ResultFolder;
use crate::output::recorder::{FolderRecorder, Hook, Labels};
use crate::output::summary;
use crate::run::dynamics;
use crate::run::record::Control;

/// Runs a case into a result folder.
pub fn run(asked: &RunArguments) -> Result<ExitCode> {
    let loaded = case::load(&asked.case.case, &asked.case.sets)?;
    let case = &loaded.case;
    super::refuse(&loaded, &System::new(case))?;
    let out = asked
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(&case.name));
    let folder = ResultFolder::create(&out)?;
    let interrupted = interrupt::flag();
    let mut watcher = Watcher::new(asked.quiet);
    let deadline = asked
        .max_wall
        .map(|seconds| Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, 1e9)));
    let hook: Hook = Box::new(move |progress| {
        watcher.step(progress);
        if interrupt::raised(&interrupted) {
            Control::Stop(format!("interrupted at t = {:.6} s", progress.t))
        } else if deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            Control::Stop(format!("the wall time allowed is used up at t = {:.6} s", progress.t))
        } else {
            Control::Continue
        }
    });
    let labels = Labels {
        case_name: case.name.clone(),
        case_json: case.resolved_json(),
        frequency_hz: characteristic::forcing_period(case).map(|p| 1.0 / p),
    };
    let (recorder, outcome) = if asked.resume {
        let saved = checkpoint::read(&out)?
            .ok_or_else(|| Error::Usage(format!("{} holds no checkpoint to resume from", out.display())))?;
        let mut recorder = FolderRecorder::resume(folder, labels, hook, &saved, &dynamics::header(case))?;
        let outcome = dynamics::resume(case, &saved.run, &mut recorder)?;
        (recorder, outcome)
    } else {
        let mut recorder = FolderRecorder::new(folder, labels, hook);
        let outcome = dynamics::run(case, &mut recorder)?;
        (recorder, outcome)
    };
    recorder.finish(&outcome.summary)?;
    if asked.json {
        super::print(&summary::to_json(&outcome.summary))?;
    } else {
        let box_text = summary_box::render(&outcome.summary, &out, terminal::colour_out(), terminal::width());
        super::print(&box_text)?;
    }
    Ok(match outcome.fault {
        None => ExitCode::SUCCESS,
        Some(fault) => {
            eprintln!("{}", terminal::diagnosis(&fault));
            ExitCode::from(4)
        }
    })
}
