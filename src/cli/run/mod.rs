//! `slcbeam run`.

mod resume;

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use super::arguments::RunArguments;
use super::interrupt::WallArguments;
use super::progress::ProgressDisplay;
use super::uncertain;
use super::{interrupt, progress_line, resources, summary_box, terminal};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::Result;
use crate::model::Model;
use crate::output::Labels;
use crate::output::folder::{FIELDS, HISTORY, ResultFolder, SUMMARY};
use crate::output::kind::FolderKind;
use crate::output::recorder::{Finished, FolderRecorder, Hook};
use crate::output::report;
use crate::output::summary;
use crate::output::uncertainty as files;
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, Progress};
use crate::run::summary::{Status, Summary};
use crate::run::wall_time::{Stopwatch, WallTimes};
use crate::study::analysis::AnalysisKind;
use crate::study::analysis::AnalysisRequest;
use crate::study::companion::{self, Accurate};
use crate::study::target::effects::Annotate;
use crate::study::target::{self, ReachedSetting};
use resume::resume;

/// Runs a case into a result folder; `began` is the start of the program.
pub fn run(asked: &RunArguments, began: Instant) -> Result<ExitCode> {
    let mut laps = Stopwatch::since(began);
    let case = &resources::load_with(&asked.case.case, &asked.case.sets, asked.sensitivities.len())?;
    let model = Model::new(case)?;
    let start_up = laps.lap();
    let system = System::chosen(case, model)?;
    let accuracy = asked.accuracy.map(progress_line::accuracy).transpose()?;
    let out = asked.place.folder(&case.name, FolderKind::Run);
    if !asked.resume {
        resources::run_fits(case, &system, asked.sensitivities.len(), &out)?;
    }
    let parameters = Parameter::find_all(case, &asked.sensitivities)?;
    let alone = "--uncertain cannot be combined with --accuracy or --resume. After a run with --accuracy, summary.json \
                 contains its mesh and tolerance";
    asked
        .uncertain
        .refuse(asked.accuracy.is_some() || asked.resume, alone)?;
    let mut uncertain = asked
        .uncertain
        .begin(&asked.case, case, AnalysisKind::Run, asked.quiet)?;
    let way = Way {
        hook: hook(asked),
        lean: asked.lean,
        before: WallTimes {
            start_up,
            set_up: laps.lap(),
            ..WallTimes::default()
        },
    };
    let Recorded {
        outcome: Outcome { mut summary, fault },
        finished,
        aside,
        mut written,
    } = match (accuracy, asked.resume) {
        (Some(accuracy), _) => {
            drop(system);
            reach(case, accuracy, None, asked.place.claim(case, FolderKind::Run)?, &way)?
        }
        (None, true) => resume(case, system, &parameters, &out, &way)?,
        (None, false) => {
            let folder = asked.place.claim(case, FolderKind::Run)?;
            let first = record(case, system, &parameters, folder, &way, &|_| ())?;
            settle(case, first, &parameters, &way)?
        }
    };
    // clears the bar before messages are printed
    drop(way);
    laps.lap();
    let mut uncertainty = None;
    let left = asked.max_wall.map(|seconds| seconds - began.elapsed().as_secs_f64());
    if let (Some(asked), Some(companion)) = (&mut uncertain, &summary.companion) {
        asked.with_effects(companion);
    }
    if let (Some(asked), Some(finished), Status::Finished) = (&uncertain, &finished, summary.status) {
        let max_wall = left.map(|seconds| seconds.max(0.0));
        WallArguments { max_wall }.flag();
        uncertainty = uncertain::compute(Some(asked), Some(finished.folder()))?;
        summary.bands = uncertain::bands(uncertainty.as_ref());
        summary.wall_s.samples = laps.lap();
        // the page is made from the files in the folder
        let summed = || summary::to_json(&summary);
        written = written.and(uncertain::write(
            uncertainty.as_ref(),
            finished.folder(),
            &[(SUMMARY, &summed)],
        ));
    }
    written = written.and_then(|()| match &finished {
        _ if asked.lean => Ok(()),
        Some(finished) => finished.page(),
        None => report::write(&out, None).map(|_| ()),
    });
    let lap = laps.lap();
    summary.wall_s.report = if asked.lean { 0.0 } else { lap };
    // if the page fails, the folder is not closed, so that all of this can be repeated
    written = match finished {
        Some(finished) if written.is_ok() => close(finished, &mut summary, &mut laps),
        _ => written,
    };
    if asked.json {
        super::print(&summary::to_json(&summary))?;
    } else {
        let box_text = summary_box::render(&summary, &out, !asked.lean, terminal::colour_out(), terminal::width());
        super::print_painted(&box_text)?;
        super::print(&uncertainty.as_ref().map_or(String::new(), files::describe))?;
    }
    written?;
    if let Some(aside) = aside {
        terminal::print_line(&format!("slcbeam: the older result is in {}", aside.display()));
    }
    Ok(terminal::exit_code(fault.as_ref()))
}

/// Closes a folder whose page is written; its summary includes all wall time until then.
fn close(finished: Finished, summary: &mut Summary, laps: &mut Stopwatch) -> Result<()> {
    let folder = finished.close()?;
    summary.wall_s.files += laps.lap();
    summary.wall_s.close(laps.total());
    summary::write(&folder, summary).map(|_| ())
}

/// Options of runs, and the wall times before them.
struct Way {
    hook: SharedHook,
    lean: bool,
    before: WallTimes,
}

impl Way {
    /// True if a run with derivatives by some numbers has a companion: if it has error bars and the memory suffices for both.
    fn has_companion(&self, case: &Case, by: &[Parameter]) -> bool {
        !self.lean && resources::holds_companion(case, by.len())
    }
}

/// Hook that is called after every step of every run: progress, Ctrl-C, wall time.
type SharedHook = Rc<RefCell<Hook>>;

fn hook(asked: &RunArguments) -> SharedHook {
    let interrupted = interrupt::flag();
    let mut watcher = ProgressDisplay::new(asked.quiet);
    let deadline = asked
        .max_wall
        .map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
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

fn own(hook: &SharedHook) -> Hook {
    let hook = Rc::clone(hook);
    Box::new(move |progress| hook.borrow_mut()(progress))
}

/// Runs one of many cases into a folder of its own, which may contain the files of an interrupted run.
pub fn into(case: &Case, ask: AnalysisRequest, dir: &Path, lean: bool, stop: &Arc<AtomicBool>) -> Result<Outcome> {
    let mut laps = Stopwatch::since(Instant::now());
    let interrupted = Arc::clone(stop);
    let way = Way {
        hook: Rc::new(RefCell::new(Box::new(move |_: &Progress| {
            match interrupt::raised(&interrupted) {
                true => Control::Stop("interrupted".into()),
                false => Control::Continue,
            }
        }))),
        lean,
        before: WallTimes::default(),
    };
    let folder = ResultFolder::claim(dir, FolderKind::Run, true)?;
    let Recorded {
        mut outcome,
        finished,
        written,
        ..
    } = match ask.accuracy {
        Some(accuracy) => reach(case, accuracy, ask.from.as_ref(), folder, &way)?,
        None => {
            let first = record(case, System::new(case)?, &[], folder, &way, &|_| ())?;
            settle(case, first, &[], &way)?
        }
    };
    written?;
    if let Some(finished) = finished {
        if !lean {
            finished.page()?;
        }
        laps.lap();
        close(finished, &mut outcome.summary, &mut laps)?;
    }
    Ok(outcome)
}

/// A run that has ended.
struct Recorded {
    outcome: Outcome,
    /// Folder of the run, unless nothing was done in it.
    finished: Option<Finished>,
    /// Path to which an older result was moved.
    aside: Option<PathBuf>,
    /// The error if its files could not be written.
    written: Result<()>,
}

/// Runs a case into a folder, and annotates the summary before it is written.
fn record(
    case: &Case,
    system: System,
    by: &[Parameter],
    folder: ResultFolder,
    way: &Way,
    annotate: Annotate,
) -> Result<Recorded> {
    let mut recorder = FolderRecorder::new(folder, Labels::from_case(case), own(&way.hook)).lean(way.lean);
    let mut outcome = match way.has_companion(case, by) {
        true => companion::run(case, system, by, &mut recorder)?,
        false => dynamics::run_with(case, system, by, &mut recorder)?,
    };
    annotate(&mut outcome.summary);
    complete(recorder, outcome, way)
}

/// Repeats a run with effects that its companion shows to matter. Repeated runs are recorded inside the folder and replace the result when
/// they finish.
fn settle(case: &Case, mut run: Recorded, by: &[Parameter], way: &Way) -> Result<Recorded> {
    let (Some(finished), Ok(())) = (&mut run.finished, &run.written) else {
        return Ok(run);
    };
    let mut again = |case: &Case, annotate: Annotate| -> Result<Outcome> {
        let inside = finished.folder().candidate()?;
        let folder = ResultFolder::claim(inside.path(), FolderKind::Run, false)?;
        let repeated = record(case, System::new(case)?, by, folder, way, annotate)?;
        repeated.written?;
        repeated.finished.map(Finished::close).transpose()?;
        if repeated.outcome.summary.status == Status::Finished {
            finished.replace(inside.path())?;
        }
        Ok(repeated.outcome)
    };
    run.outcome = target::effects::settle(case, run.outcome, &mut again)?;
    Ok(run)
}

fn complete(recorder: FolderRecorder, mut outcome: Outcome, way: &Way) -> Result<Recorded> {
    let wall = &mut outcome.summary.wall_s;
    wall.begin_with(&way.before);
    let (finished, written) = match recorder.finish(&outcome.summary) {
        Ok(finished) => (Some(finished), Ok(())),
        Err(error) => (None, Err(error)),
    };
    if let Some(finished) = &finished {
        let wall = &mut outcome.summary.wall_s;
        (wall.pictures, wall.files) = (finished.spent.pictures, finished.spent.files);
        outcome.summary.tables_crc32.clone_from(&finished.tables_crc32);
    }
    Ok(Recorded {
        outcome,
        aside: finished.as_ref().and_then(|finished| finished.aside.clone()),
        finished,
        written,
    })
}

/// Runs candidates until one reaches the accuracy. Candidates are recorded inside the folder and replace the result when they finish, so
/// that a stopped one leaves its predecessor. The first may end early: then it is the only result.
fn reach(
    case: &Case,
    accuracy: f64,
    from: Option<&ReachedSetting>,
    mut result: ResultFolder,
    way: &Way,
) -> Result<Recorded> {
    let began = Instant::now();
    let (mut placed, mut aside, mut unwritten) = (false, None, Ok(()));
    let mut candidate = |case: &Case, accuracy: &Accurate| -> Result<Outcome> {
        let inside = result.candidate()?;
        let folder = ResultFolder::claim(inside.path(), FolderKind::Run, false)?;
        let mut recorder = FolderRecorder::new(folder, Labels::from_case(case), own(&way.hook)).lean(way.lean);
        let outcome = companion::measured(case, System::new(case)?, accuracy, &mut recorder)?;
        let Recorded {
            outcome,
            finished,
            written,
            ..
        } = complete(recorder, outcome, way)?;
        if written.is_err() {
            unwritten = written;
            return Ok(outcome);
        }
        finished.map(Finished::close).transpose()?;
        if outcome.summary.status == Status::Finished || !placed {
            let tabled = inside.path().join(HISTORY).exists();
            if !inside.path().join(FIELDS).exists() {
                aside = result.set_aside()?;
            }
            result.replace(inside.path())?;
            if !tabled {
                result.remove(HISTORY)?;
            }
            placed = true;
        }
        Ok(outcome)
    };
    let mut outcome = target::reach(case, accuracy, from, &mut candidate)?;
    let wall = &mut outcome.summary.wall_s;
    let before = way.before.start_up + way.before.set_up;
    wall.pilots = before + began.elapsed().as_secs_f64() - wall.known() - wall.pictures - wall.files;
    if placed && unwritten.is_ok() {
        unwritten = summary::write(&result, &outcome.summary).map(|_| ());
    }
    let finished = placed.then(|| Finished::new(result));
    Ok(Recorded {
        outcome,
        finished,
        aside,
        written: unwritten,
    })
}
