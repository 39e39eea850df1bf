//! Error bars: the figures of a run beside the same figures of its companion.
//!
//! The companion is the same case with other meshes, a looser tolerance and every effect that the case leaves to the program. It runs at
//! the same time in a second thread.
//!
//! ```text
//! variant       cases beside a case: its companion, and those that differ in one setting
//! error         differences of figures
//! attribution   which setting makes an error that is large, and the warning
//! changes       runs with one change
//! band          error band of the history
//! ```
//!
//! With `x` a figure of the run and `x'` that of the companion, the error is the whole difference `|x - x'|`:
//!
//! ```text
//! beam mesh    K/2 cells     e(K/2) - e(K) = 3 e(K) at second order;   2K to 4K - 1 where K cells leave out part of a load or of the start
//! fluid mesh   2G cells      boundary layers in bladders, which coarser meshes do not show at all;   up to 4G - 1 where these are thin
//! time         10 rtol       e(10 rtol) - e(rtol), several times e(rtol)
//! effects      all           what the effects that are left out change
//! ```
//!
//! Figures of two runs may agree by accident: the error of a figure is at least [`error::SHARED`] of the largest error among the figures of
//! its quantity. `docs/accuracy.md` has the coverage that random scenes show.

pub mod attribution;
pub mod band;
mod changes;
pub mod error;
pub mod variant;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::case::schema::Companion;
use crate::discrete::{System, resolution};
use crate::error::{Code, Error, Result};
use crate::integrate::halt;
use crate::numerics::threads::{self, StartedTask};
use crate::run::checkpoint::Checkpoint;
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, Progress, Recorder, ThinnedRecorder, ThinnedRows};
use crate::run::summary::{CompanionRun, Figures, Status, Summary};
use attribution::attribute;
use variant::{ErrorCause, Variant};

/// Largest work of a companion with all effects, relative to the work of the run; above it the companion has the effects of the run.
const LARGEST_WORK: u64 = 3;
/// Work (steps times unknowns) that a companion may always do.
const SMALL_WORK: u64 = 1_000_000;
/// Interval at which a thread that waits for another looks again.
const PATIENCE: Duration = Duration::from_millis(2);
/// Reason of a summary whose run did not reach the end.
const UNFINISHED: &str = "the run did not reach its end";

/// Runs the system of a case, as [`dynamics::run_with`], with error bars for its figures.
///
/// # Errors
/// As [`dynamics::run_with`].
pub fn run(case: &Case, system: System, by: &[Parameter], recorder: &mut dyn Recorder) -> Result<Outcome> {
    accompany(case, None, recorder, |recorder| {
        dynamics::run_with(case, system, by, recorder)
    })
}

/// Runs a case as [`run`], with the causes of errors that are larger than an accuracy, and without a warning of them.
///
/// # Errors
/// As [`dynamics::run`].
pub fn measured(case: &Case, system: System, accuracy: &Accurate, recorder: &mut dyn Recorder) -> Result<Outcome> {
    accompany(case, Some(accuracy), recorder, |recorder| {
        dynamics::run_with(case, system, &[], recorder)
    })
}

/// Resumes a run from a checkpoint, as [`dynamics::resume`], with error bars for its figures. The companion begins at the start of the case,
/// so that its figures are those of a run without interruption.
///
/// # Errors
/// As [`dynamics::resume`].
pub fn resume(case: &Case, system: System, from: &Checkpoint, recorder: &mut dyn Recorder) -> Result<Outcome> {
    accompany(case, None, recorder, |recorder| {
        dynamics::resume(case, system, from, recorder)
    })
}

/// An accuracy that is asked for.
#[derive(Clone, Debug)]
pub struct Accurate {
    /// Relative error.
    pub asked: f64,
    /// Errors by their causes, as a coarser run leads to expect them.
    expected: BTreeMap<ErrorCause, Figures>,
}

impl Accurate {
    /// Nothing is expected yet.
    pub fn new(asked: f64) -> Self {
        Self {
            asked,
            expected: BTreeMap::new(),
        }
    }

    /// Expects of a finer case the errors that a coarser run was measured to have, less what its refinements take away.
    pub fn expect(&mut self, coarser: &Summary, from: &Case, to: &Case) {
        let Some(companion) = &coarser.companion else { return };
        let effects = from.effects != to.effects;
        let causes = companion.causes.iter().filter_map(|(pointer, errors)| {
            let cause = ErrorCause::at(pointer)?;
            let left = cause.left(from, to);
            let mut errors = errors.clone();
            let values = errors.values_mut().flat_map(BTreeMap::values_mut);
            values.for_each(|error| *error *= left);
            (!(effects && ErrorCause::is_effect(pointer))).then_some((cause, errors))
        });
        self.expected = causes.collect();
    }
}

/// Limits of a run beside another.
#[derive(Debug)]
struct Limits {
    cancelled: AtomicBool,
    /// Largest work; `u64::MAX` until the other run has ended.
    work: AtomicU64,
}

impl Limits {
    fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    fn work(&self) -> u64 {
        self.work.load(Ordering::Relaxed)
    }
}

/// Cancels what runs beside a scope that ends early.
struct Cancel<'a>(&'a Limits);

impl Drop for Cancel<'_> {
    fn drop(&mut self) {
        if self.0.work() == u64::MAX {
            self.0.cancel();
        }
    }
}

/// Runs a case and its companion side by side.
fn accompany(
    case: &Case,
    accuracy: Option<&Accurate>,
    recorder: &mut dyn Recorder,
    run: impl FnOnce(&mut dyn Recorder) -> Result<Outcome>,
) -> Result<Outcome> {
    if case.companion == Companion::Off {
        return run(recorder);
    }
    let limits = Limits {
        cancelled: AtomicBool::new(false),
        work: AtomicU64::new(u64::MAX),
    };
    let heard = halt::heard();
    let mut ended = Instant::now();
    let (mut outcome, found) = thread::scope(|scope| {
        let companion = threads::begin(scope, || heard.during(|| companion_of(case, &limits)));
        let guard = Cancel(&limits);
        let outcome = run(recorder)?;
        ended = Instant::now();
        let summary = &outcome.summary;
        if summary.status != Status::Finished {
            limits.cancel();
        }
        let work = LARGEST_WORK * work(summary) + SMALL_WORK;
        limits.work.store(work, Ordering::Relaxed);
        drop(guard);
        let stopped = wait(&companion, &limits, &progress(summary), recorder)?;
        Ok::<_, Error>((outcome, companion.join().map_err(|reason| stopped.unwrap_or(reason))))
    })?;
    let summary = &mut outcome.summary;
    match found {
        Ok((companion, of, rows)) => {
            summary.errors = error::errors(summary, &of);
            // a measured error replaces one that the mesh was expected to make
            if summary
                .warnings
                .iter()
                .any(|warning| warning.starts_with(Code::Unresolved.id()))
            {
                let expected = resolution::warnings(case, &System::new(case)?);
                // the forces of contacts have no measured error
                let forces = |warning: &String| warning.contains("/contacts/");
                summary
                    .warnings
                    .retain(|warning| !expected.contains(warning) || forces(warning));
            }
            summary.companion = Some(companion);
            attribute(case, summary, &of, accuracy, recorder)?;
            recorder.companion(&rows)?;
        }
        Err(reason) => {
            let reason = match summary.status {
                Status::Finished => reason,
                _ => UNFINISHED.into(),
            };
            if accuracy.is_none() {
                summary.warnings.extend(attribution::unknown(summary.status, &reason));
            }
            summary.companion = Some(CompanionRun {
                reason: Some(reason),
                ..CompanionRun::default()
            });
        }
    }
    let waited = ended.elapsed().as_secs_f64();
    summary.wall_s.companion += waited;
    summary.wall_s.total += waited;
    Ok(outcome)
}

/// Waits until a task ends; the reason of the recorder where that does not want to wait.
fn wait<T>(
    task: &StartedTask<'_, T>,
    limits: &Limits,
    progress: &Progress,
    recorder: &mut dyn Recorder,
) -> Result<Option<String>> {
    let mut stopped = None;
    if let StartedTask::Thread(thread) = task {
        while !thread.is_finished() {
            thread::sleep(PATIENCE);
            match recorder.progress(progress) {
                Ok(Control::Continue) => {}
                Ok(Control::Stop(reason)) => {
                    limits.cancel();
                    let words = reason.split(" at t = ").next().unwrap_or_default();
                    stopped.get_or_insert(format!("{words} while the companion ran"));
                }
                Err(error) => {
                    limits.cancel();
                    return Err(error);
                }
            }
        }
    }
    Ok(stopped)
}

/// Progress of a run that has ended.
fn progress(summary: &Summary) -> Progress {
    Progress {
        t: summary.time_s,
        end: summary.time_s,
        steps: summary.solver.steps,
        ..Progress::default()
    }
}

/// Steps times unknowns of a run.
pub fn work(summary: &Summary) -> u64 {
    summary.solver.steps * summary.unknowns as u64
}

/// Steps of the companion of a run; 0 without one.
pub fn companion_steps(summary: &Summary) -> f64 {
    summary.companion.as_ref().map_or(0, |companion| companion.steps) as f64
}

/// Makes a companion of a case, where that applies.
type Attempt = fn(&Case) -> Result<Option<Variant>>;

/// The companion of a case with its summary and history, or the reason why there is none.
fn companion_of(case: &Case, limits: &Limits) -> std::result::Result<(CompanionRun, Summary, ThinnedRows), String> {
    let attempts: [Attempt; 3] = [Variant::with_all_effects, Variant::with_its_effects, Variant::tighter];
    let mut reason = String::new();
    for attempt in attempts {
        let variant = match attempt(case) {
            Ok(Some(variant)) => variant,
            Ok(None) => continue,
            Err(error) => {
                reason = error.to_string();
                continue;
            }
        };
        match finish(&variant, limits) {
            Ok((summary, rows)) => return Ok((variant.describe(&summary), summary, rows)),
            Err(why) => reason = why,
        }
        if limits.is_cancelled() {
            break;
        }
    }
    Err(reason)
}

/// Runs a case within limits; the reason where it does not reach its end.
fn finish(variant: &Variant, limits: &Limits) -> std::result::Result<(Summary, ThinnedRows), String> {
    let system = System::new(&variant.case).map_err(|error| error.to_string())?;
    let unknowns = system.layout.len as u64;
    let too_long = |steps: u64| steps * unknowns > limits.work();
    let mut recorder = ThinnedRecorder {
        hook: |progress: &Progress| match limits.is_cancelled() || too_long(progress.steps) {
            true => Control::Stop(String::new()),
            false => Control::Continue,
        },
        rows: ThinnedRows::default(),
    };
    let outcome = dynamics::run_with(&variant.case, system, &[], &mut recorder);
    let summary = outcome.map_err(|error| error.to_string())?.summary;
    // the work of the other run decides, not the time that either takes
    while limits.work() == u64::MAX && !limits.is_cancelled() {
        thread::sleep(PATIENCE);
    }
    if limits.is_cancelled() {
        return Err("the companion was cancelled".into());
    }
    if too_long(summary.solver.steps) {
        return Err(format!(
            "the companion takes more than {LARGEST_WORK} times the work of the run"
        ));
    }
    if summary.status != Status::Finished {
        let reason = summary.reason.unwrap_or_default();
        return Err(format!("the companion ended early: {reason}"));
    }
    Ok((summary, recorder.rows))
}
