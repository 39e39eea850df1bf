//! Runs of one setting, with work and times.

use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::plan::{Budget, StudySetting};
use super::scheme::Scheme;
use super::signals::{ComparedSignal, SignalRecorder, StopLimit};
use crate::case::Case;
use crate::error::Result;
use crate::integrate::halt;
use crate::run::dynamics;
use crate::run::json_null;
use crate::run::summary::{Counters, Status};
use crate::study::evaluations::Evaluations;

/// Purpose of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RunPurpose {
    /// A point of the study.
    Point,
    /// Run tighter than requested, a reference of points.
    Reference,
}

/// Outcome of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrialOutcome {
    /// Reached the end of the simulated time.
    Finished,
    /// Stopped at its limit, or by the model.
    Stopped,
    /// The solver failed.
    Failed,
    /// Not started.
    Skipped,
}

/// Setting and the outcome of its runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyTrial {
    /// Setting.
    pub setting: StudySetting,
    /// Purpose.
    pub role: RunPurpose,
    /// Outcome.
    pub ending: TrialOutcome,
    /// Reason why it did not finish.
    pub reason: Option<String>,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Work of one run.
    pub counters: Counters,
    /// Least wall time of the timed runs [s].
    #[serde(deserialize_with = "json_null::number")]
    pub wall_min_s: f64,
    /// Median wall time of the timed runs [s].
    #[serde(deserialize_with = "json_null::number")]
    pub wall_median_s: f64,
    /// Number of timed runs.
    pub repeats: usize,
    /// Cost of one run, in seconds or steps as in the budget.
    #[serde(deserialize_with = "json_null::number")]
    pub cost: f64,
    /// Compared signals; finished runs only.
    #[serde(skip)]
    pub signals: Option<Vec<ComparedSignal>>,
}

impl StudyTrial {
    /// Returns a setting that is not run, with the reason.
    pub fn skipped(setting: StudySetting, role: RunPurpose, reason: String) -> Self {
        Self {
            setting,
            role,
            ending: TrialOutcome::Skipped,
            reason: Some(reason),
            unknowns: 0,
            counters: Counters::default(),
            wall_min_s: f64::NAN,
            wall_median_s: f64::NAN,
            repeats: 0,
            cost: 0.0,
            signals: None,
        }
    }

    /// True if the run finished, so that it can be compared.
    pub fn finished(&self) -> bool {
        self.ending == TrialOutcome::Finished
    }

    /// Mesh and scheme: one line of the picture.
    pub fn line(&self) -> (usize, Scheme) {
        (self.setting.cells, self.setting.scheme)
    }
}

/// Cost limits of one setting.
#[derive(Clone, Copy, Debug)]
pub struct CostLimits {
    /// Limit of one run, which is stopped there.
    pub run: f64,
    /// Limit of all further runs together.
    pub repeats: f64,
    /// Requested number of timed runs.
    pub wanted: usize,
}

/// Runs a setting, unless it is stored in `evaluations`; returns it with the seconds or steps of all its runs.
///
/// The first run is a warm-up. It counts if no further runs are allowed: a long run needs no warm-up.
pub fn run(
    case: &Case,
    (setting, role): (StudySetting, RunPurpose),
    budget: Budget,
    allowed: CostLimits,
    evaluations: &Evaluations,
) -> Result<(StudyTrial, f64)> {
    if halt::asked() {
        return Ok((StudyTrial::skipped(setting, role, "interrupted".into()), 0.0));
    }
    let compute = || {
        let (mut trial, spent) = computed(case, setting, role, budget, allowed)?;
        let signals = trial.signals.take();
        Ok((trial, signals, spent))
    };
    let (trial, signals, spent) = evaluations.try_get(&(setting, role), &halt::asked, compute)?;
    Ok((StudyTrial { signals, ..trial }, spent))
}

fn computed(
    case: &Case,
    setting: StudySetting,
    role: RunPurpose,
    budget: Budget,
    allowed: CostLimits,
) -> Result<(StudyTrial, f64)> {
    let variant = setting.case(case);
    let once = |most: f64| -> Result<(StudyTrial, f64)> {
        let begin = Instant::now();
        let limit = match budget {
            Budget::Wall(_) => StopLimit::Wall(begin + Duration::from_secs_f64(most.clamp(0.0, 1e9))),
            Budget::Steps(_) => StopLimit::Steps(most.max(1.0) as u64),
        };
        let mut keep = SignalRecorder::new(setting.cells, limit);
        let outcome = dynamics::run(&variant, &mut keep)?;
        let wall = begin.elapsed().as_secs_f64();
        let summary = outcome.summary;
        let ending = match summary.status {
            Status::Finished => TrialOutcome::Finished,
            Status::Stopped => TrialOutcome::Stopped,
            Status::OutOfRange | Status::Failed => TrialOutcome::Failed,
        };
        let signals = (ending == TrialOutcome::Finished).then(|| keep.signals(&summary));
        // Non-finite values make every comparison meaningless: the run has failed.
        let broken = signals
            .iter()
            .flatten()
            .any(|s| s.values.iter().any(|x| !x.is_finite()));
        let (ending, reason) = if broken {
            (
                TrialOutcome::Failed,
                Some("the result contains numbers that are not finite".to_string()),
            )
        } else {
            (ending, summary.reason)
        };
        let cost = match budget {
            Budget::Wall(_) => wall,
            Budget::Steps(_) => summary.solver.steps as f64,
        };
        let trial = StudyTrial {
            setting,
            role,
            ending,
            reason,
            unknowns: summary.unknowns,
            counters: summary.solver,
            wall_min_s: wall,
            wall_median_s: wall,
            repeats: 1,
            cost,
            signals: signals.filter(|_| !broken),
        };
        Ok((trial, wall))
    };
    let (mut trial, _) = once(allowed.run)?;
    let mut spent = trial.cost;
    if !trial.finished() {
        return Ok((trial, spent));
    }
    let mut walls = vec![];
    let mut left = allowed.repeats;
    while walls.len() < allowed.wanted && left >= 1.2 * trial.cost {
        let (again, wall) = once(left)?;
        spent += again.cost;
        left -= again.cost;
        if again.finished() {
            walls.push(wall);
        }
    }
    if !walls.is_empty() {
        walls.sort_by(f64::total_cmp);
        trial.wall_min_s = walls[0];
        trial.wall_median_s = 0.5 * (walls[walls.len() / 2] + walls[(walls.len() - 1) / 2]);
        trial.repeats = walls.len();
    }
    Ok((trial, spent))
}
