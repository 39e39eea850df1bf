//! `slcbeam run`.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::rc::Rc;
use std::time::{Duration, Instant};

use super::arguments::RunArguments;
use super::progress::Watcher;
use super::{interrupt, line, summary_box, terminal};
use crate::case::parameter::Parameter;
use crate::case::{self, Case};
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::model::characteristic;
use crate::output::checkpoint;
use crate::output::folder::{HISTORY, ResultFolder};
use crate::output::recorder::{FolderRecorder, Hook, Labels};
use crate::output::report;
use crate::output::summary;
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, Progress};
use crate::run::summary::Status;
use crate::study::target;

/// Runs a case into a result folder.
pub fn run(asked: &RunArguments) -> Result<ExitCode> {
    let loaded = case::load(&asked.case.case, &asked.case.sets)?;
    let case = &loaded.case;
    super::refuse(&loaded, &System::new(case))?;
    let accuracy = asked.accuracy.map(line::accuracy).transpose()?;
    let out = asked
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from("out").join(&case.name));
    let hook = hook(asked);
    let outcome = match (accuracy, asked.resume) {
        (Some(accuracy), _) => reach(case, accuracy, &out, &hook)?,
        (None, true) => resume(case, &out, &hook)?,
        (None, false) => record(case, &parameters(case, &asked.sensitivities)?, &out, &hook)?,
    };
    if asked.json {
        super::print(&summary::to_json(&outcome.summary))?;
    } else {
        let box_text = summary_box::render(&outcome.summary, &out, terminal::colour_out(), terminal::width());
        super::print(&box_text)?;
    }
    report::write(&out, None)?;
    Ok(match outcome.fault {
        None => ExitCode::SUCCESS,
        Some(fault) => {
            eprintln!("{}", terminal::diagnosis(&fault));
            ExitCode::from(4)
        }
    })
}

/// Asked after every step of every run: progress, Ctrl-C, wall time.
type SharedHook = Rc<RefCell<Hook>>;

fn hook(asked: &RunArguments) -> SharedHook {
    let interrupted = interrupt::flag();
    let mut watcher = Watcher::new(asked.quiet);
    let deadline = asked
        .max_wall
        .map(|seconds| Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, 1e9)));
    Rc::new(RefCell::new(Box::new(move |progress: &Progress| {
        watcher.step(progress);
        if interrupt::raised(&interrupted) {
            Control::Stop(format!("interrupted at t = {:.6} s", progress.t))
        } else if deadline.is_some_and(|deadline| Instant::now() >= deadline) {
            Control::Stop(format!("the wall time allowed is used up at t = {:.6} s", progress.t))
        } else {
            Control::Continue
        }
    })))
}

fn labels(case: &Case) -> Labels {
    Labels {
        case_name: case.name.clone(),
        case_json: case.resolved_json(),
        frequency_hz: characteristic::forcing_period(case).map(|p| 1.0 / p),
    }
}

fn own(hook: &SharedHook) -> Hook {
    let hook = Rc::clone(hook);
    Box::new(move |progress| hook.borrow_mut()(progress))
}

/// The numbers by which derivatives are asked for, each once.
fn parameters(case: &Case, pointers: &[String]) -> Result<Vec<Parameter>> {
    let mut all: Vec<Parameter> = Vec::new();
    for pointer in pointers {
        if all.iter().all(|other| other.pointer != *pointer) {
            all.push(Parameter::find(case, pointer)?);
        }
    }
    Ok(all)
}

fn record(case: &Case, parameters: &[Parameter], out: &Path, hook: &SharedHook) -> Result<Outcome> {
    let mut recorder = FolderRecorder::new(ResultFolder::create(out)?, labels(case), own(hook));
    let outcome = dynamics::run_with(case, parameters, &mut recorder)?;
    recorder.finish(&outcome.summary)?;
    Ok(outcome)
}

/// Candidates are recorded beside the result and take its place when they finish, so that one that is stopped leaves the
/// one before. The first may end early, as long as it began: then it is all there is.
fn reach(case: &Case, accuracy: f64, out: &Path, hook: &SharedHook) -> Result<Outcome> {
    let mut result = ResultFolder::create(out)?;
    let mut name = out.as_os_str().to_owned();
    name.push(".next");
    let beside = PathBuf::from(name);
    let ask = |progress: &Progress| hook.borrow_mut()(progress);
    let mut placed = false;
    let mut candidate = |case: &Case| -> Result<Outcome> {
        let outcome = record(case, &[], &beside, hook)?;
        let begun = beside.join(HISTORY).exists() || !result.holds_older();
        if outcome.summary.status == Status::Finished || !placed && begun {
            result.replace(&beside)?;
            placed = true;
        } else {
            ResultFolder::discard(&beside)?;
        }
        Ok(outcome)
    };
    let outcome = target::reach(case, accuracy, &ask, &mut candidate)?;
    if placed {
        summary::write(&result, &outcome.summary)?;
    }
    Ok(outcome)
}

fn resume(case: &Case, out: &Path, hook: &SharedHook) -> Result<Outcome> {
    let folder = ResultFolder::create(out)?;
    let saved = checkpoint::read(out)?
        .ok_or_else(|| Error::Usage(format!("{} holds no checkpoint to resume from", out.display())))?;
    let mut recorder = FolderRecorder::resume(folder, labels(case), own(hook), &saved, &dynamics::header(case))?;
    let outcome = dynamics::resume(case, &saved.run, &mut recorder)?;
    recorder.finish(&outcome.summary)?;
    Ok(outcome)
}
