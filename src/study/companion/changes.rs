//! Runs with one change, two at a time, and the errors that they show.

use std::collections::BTreeMap;

use super::variant::{ErrorCause, Variant};
use super::{Limits, SMALL_WORK, error, finish, progress, wait, work};
use crate::case::Case;
use crate::error::Result;
use crate::integrate::halt;
use crate::numerics::threads;
use crate::run::record::Recorder;
use crate::run::summary::{Figures, Summary};

/// Largest work of a run with one change, relative to that of the run.
const LONGEST: u64 = 8;
/// Factors by which the tolerance is tightened, one after the other, until the run takes so many times the steps.
const TIGHTER: [f64; 3] = [1e1, 1e2, 1e4];
const MORE_STEPS: f64 = 1.55;

/// Outcome of the runs with one change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChangesStatus {
    All,
    Some,
    Interrupted,
}

/// Errors of all figures by some causes, two runs at a time.
pub fn changes(
    case: &Case,
    summary: &Summary,
    cells: [usize; 2],
    causes: Vec<ErrorCause>,
    found: &mut BTreeMap<ErrorCause, Figures>,
    recorder: &mut dyn Recorder,
) -> Result<ChangesStatus> {
    let limits = &Limits {
        cancelled: false.into(),
        work: (LONGEST * work(summary) + SMALL_WORK).into(),
    };
    let own = error::figures(summary);
    let steps = summary.solver.steps;
    let heard = &halt::heard();
    let mut all = ChangesStatus::All;
    for pair in causes.chunks(2) {
        let (ended, stopped) = std::thread::scope(|scope| {
            let change = |cause: ErrorCause| move || heard.during(|| changed(case, cells, cause, steps, limits));
            let tasks: Vec<_> = pair.iter().map(|cause| threads::begin(scope, change(*cause))).collect();
            let mut stopped = Ok(None);
            for task in &tasks {
                let now = wait(task, limits, &progress(summary), recorder);
                stopped = stopped.and_then(|before: Option<String>| Ok(before.or(now?)));
            }
            let ended: Vec<_> = tasks.into_iter().map(threads::StartedTask::join).collect();
            (ended, stopped)
        });
        if stopped?.is_some() || halt::asked() {
            return Ok(ChangesStatus::Interrupted);
        }
        for (cause, run) in pair.iter().zip(ended) {
            let (run, factor) = match run? {
                Changed::Finished(run, factor) => (run, factor),
                Changed::Absent => continue,
                Changed::Unfinished => {
                    all = ChangesStatus::Some;
                    continue;
                }
            };
            let mut errors = error::differences(&own, &error::figures(&run));
            let values = errors.values_mut().flat_map(BTreeMap::values_mut);
            values.for_each(|error| *error *= factor);
            found.insert(*cause, errors);
        }
    }
    Ok(all)
}

/// A run with one change.
enum Changed {
    /// Its summary, and the error of the case over the difference to it.
    Finished(Box<Summary>, f64),
    Unfinished,
    /// The setting does not apply.
    Absent,
}

/// Runs a case with one change. The tolerance is tightened until the run takes more steps than before: as long as loads and outputs decide on
/// the steps, two tolerances agree whatever the error.
fn changed(case: &Case, cells: [usize; 2], cause: ErrorCause, steps: u64, limits: &Limits) -> Result<Changed> {
    let mut last = Changed::Absent;
    for tighter in TIGHTER {
        let Some((variant, factor)) = Variant::with_change(case, cells, cause, tighter)? else {
            break;
        };
        let Ok((run, _)) = finish(&variant, limits) else {
            if let Changed::Absent = last {
                last = Changed::Unfinished;
            }
            break;
        };
        let binds = run.solver.steps as f64 >= MORE_STEPS * steps as f64;
        last = Changed::Finished(Box::new(run), factor);
        if cause != ErrorCause::TimeSteps || binds {
            break;
        }
    }
    Ok(last)
}
