//! Runs with work, time and figures. Every set of effects is run once, then repeated in turns with the others to
//! measure its time.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use super::choices::effects;
use crate::case::Case;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::integrate::halt;
use crate::model::effects::EffectSet;
use crate::run::dynamics;
use crate::run::json_null;
use crate::run::record::{Control, Progress, Unrecorded};
use crate::run::summary::{Counters, Status, Summary};
use crate::study::accuracy::trial::TrialOutcome;
use crate::study::evaluations::Evaluations;

/// Steps between two checks of the clock.
const LOOK: u64 = 64;

/// Requested repeats and budget.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrialPlan {
    /// Timed runs of each model, after a warm-up run; without any, verdicts ignore time.
    pub repeats: usize,
    /// Budget of wall time [s].
    pub budget_s: f64,
}

/// Event before each run.
#[derive(Clone, Debug)]
pub struct TrialEvent<'a> {
    /// Name of the model.
    pub what: &'a str,
    /// Runs so far.
    pub done: usize,
    /// Wall time so far [s].
    pub spent_s: f64,
    /// Budget [s].
    pub budget_s: f64,
}

/// Callback before each run.
pub type TrialWatch<'a> = &'a dyn Fn(&TrialEvent);

/// Model, and the outcome of its runs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ModelTrial {
    /// Name of the model.
    pub what: String,
    /// Outcome.
    pub ending: TrialOutcome,
    /// Reason why it did not finish.
    pub reason: Option<String>,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Work of one run.
    pub counters: Counters,
    /// Residual evaluations times unknowns.
    #[serde(deserialize_with = "json_null::number")]
    pub work: f64,
    /// Wall times of the timed runs in ascending order [s]; that of the first run if there are no others.
    pub walls_s: Vec<f64>,
    /// Number of timed runs.
    pub repeats: usize,
    /// Results; finished runs only.
    #[serde(skip)]
    pub summary: Option<Summary>,
}

impl ModelTrial {
    /// Returns a trial that was not started.
    pub fn skipped(what: &str) -> Self {
        Self {
            what: what.to_string(),
            ending: TrialOutcome::Skipped,
            reason: None,
            unknowns: 0,
            counters: Counters::default(),
            work: f64::NAN,
            walls_s: vec![],
            repeats: 0,
            summary: None,
        }
    }

    /// Least wall time [s].
    pub fn wall_s(&self) -> f64 {
        self.walls_s.first().copied().unwrap_or(f64::NAN)
    }

    /// Excess of the median wall time over the least, relative to the latter; 0 for fewer than two.
    pub fn scatter(&self) -> f64 {
        let median = self.walls_s.get(self.walls_s.len() / 2);
        median.map_or(0.0, |median| median / self.wall_s() - 1.0)
    }
}

/// All runs, each set of effects and tolerance once.
pub struct Runs<'a> {
    plan: TrialPlan,
    begin: Instant,
    watch: TrialWatch<'a>,
    evaluations: Evaluations,
    all: Vec<(Case, EffectSet, ModelTrial)>,
    done: usize,
    /// Wall time of the runs that an interrupted command had finished [s].
    earlier_s: f64,
}

impl<'a> Runs<'a> {
    /// Creates an empty collection; runs stored in `evaluations` are not repeated.
    pub fn new(plan: TrialPlan, evaluations: &Evaluations, watch: TrialWatch<'a>) -> Self {
        Self {
            plan,
            begin: Instant::now(),
            watch,
            evaluations: evaluations.clone(),
            all: vec![],
            done: 0,
            earlier_s: 0.0,
        }
    }

    /// Returns a run by its number.
    pub fn trial(&self, k: usize) -> &ModelTrial {
        &self.all[k].2
    }

    /// Wall time so far [s].
    pub fn spent_s(&self) -> f64 {
        self.earlier_s + self.begin.elapsed().as_secs_f64()
    }

    fn left_s(&self) -> f64 {
        self.plan.budget_s - self.spent_s()
    }

    /// Runs a case, unless a case with the same effects and tolerance was run; returns the number of the run.
    pub fn run(&mut self, what: &str, case: Case) -> Result<usize> {
        let set = effects(&case)?;
        let alike = |c: &Case, s: &EffectSet| c.solver.rtol == case.solver.rtol && on(s) == on(&set);
        if set.refusals.is_empty()
            && let Some(known) = self.all.iter().position(|(c, s, _)| alike(c, s))
        {
            return Ok(known);
        }
        let trial = self.first(what, &case, &set);
        self.all.push((case, set, trial));
        Ok(self.all.len() - 1)
    }

    fn first(&mut self, what: &str, case: &Case, set: &EffectSet) -> ModelTrial {
        let mut trial = ModelTrial::skipped(what);
        if let Err(Error::Case(fault)) = System::new(case) {
            trial.reason = fault.violations.first().map(|refusal| refusal.what.clone());
            return trial;
        }
        if halt::asked() {
            trial.reason = Some("interrupted".into());
            return trial;
        }
        let left = self.left_s();
        if left <= 0.0 {
            trial.reason = Some("the budget is used up".into());
            return trial;
        }
        self.report(what);
        let (summary, wall) = match self.once(case, set, 0, left) {
            Ok(ran) => ran,
            Err(e) => {
                trial.ending = TrialOutcome::Failed;
                trial.reason = Some(e.to_string());
                return trial;
            }
        };
        trial.ending = match summary.status {
            Status::Finished => TrialOutcome::Finished,
            Status::Stopped => TrialOutcome::Stopped,
            Status::OutOfRange | Status::Failed => TrialOutcome::Failed,
        };
        trial.reason.clone_from(&summary.reason);
        trial.unknowns = summary.unknowns;
        trial.work = summary.unknowns as f64 * summary.solver.residual_evaluations as f64;
        trial.counters = summary.solver.clone();
        trial.walls_s = vec![wall];
        let broken = summary
            .quantities
            .values()
            .any(|q| q.figures().any(|f| !f.1.is_finite()));
        if broken {
            trial.ending = TrialOutcome::Failed;
            trial.reason = Some("the result contains numbers that are not finite".into());
        }
        trial.summary = (trial.ending == TrialOutcome::Finished).then_some(summary);
        trial
    }

    /// Repeats the finished runs in turns, as far as the budget allows.
    pub fn repeat(&mut self) {
        for round in 1..=self.plan.repeats {
            for k in 0..self.all.len() {
                let (case, set, trial) = &self.all[k];
                // Runs at a tighter tolerance are not compared by time.
                if case.solver.rtol < self.all[0].0.solver.rtol {
                    continue;
                }
                if halt::asked()
                    || trial.summary.is_none()
                    || trial.repeats >= round
                    || 1.2 * trial.wall_s() > self.left_s()
                {
                    continue;
                }
                let (case, set, what) = (case.clone(), set.clone(), trial.what.clone());
                self.report(&format!("{what}, again"));
                let again = self.once(&case, &set, round, self.left_s());
                let trial = &mut self.all[k].2;
                if let Ok((summary, wall)) = again
                    && summary.status == Status::Finished
                {
                    if trial.repeats == 0 {
                        trial.walls_s.clear();
                    }
                    trial.walls_s.push(wall);
                    trial.walls_s.sort_by(f64::total_cmp);
                    trial.repeats += 1;
                }
            }
        }
    }

    /// Runs a case for repeat `round`, unless that run is stored; returns its summary and wall time [s].
    fn once(&mut self, case: &Case, set: &EffectSet, round: usize, most_s: f64) -> Result<(Summary, f64)> {
        let begin = Instant::now();
        let key = (on(set), case.solver.rtol, round);
        let compute = || once(case, most_s);
        let found = self.evaluations.try_get(&key, &halt::asked, compute)?;
        // stored runs took their time earlier
        self.earlier_s += (found.1 - begin.elapsed().as_secs_f64()).max(0.0);
        Ok(found)
    }

    fn report(&mut self, what: &str) {
        (self.watch)(&TrialEvent {
            what,
            done: self.done,
            spent_s: self.spent_s(),
            budget_s: self.plan.budget_s,
        });
        self.done += 1;
    }
}

/// True for each effect that is on.
fn on(set: &EffectSet) -> Vec<bool> {
    set.decisions.iter().map(|d| d.on).collect()
}

/// Runs a case; returns its summary and wall time [s].
fn once(case: &Case, most_s: f64) -> Result<(Summary, f64)> {
    let begin = Instant::now();
    let mut clock = Unrecorded(|progress: &Progress| {
        let late = progress.steps.is_multiple_of(LOOK) && begin.elapsed().as_secs_f64() > most_s;
        if late {
            let share = 100.0 * progress.t / progress.end;
            Control::Stop(format!("the budget is used up at {share:.3} % of the simulated time"))
        } else {
            Control::Continue
        }
    });
    let summary = dynamics::run(case, &mut clock)?.summary;
    Ok((summary, begin.elapsed().as_secs_f64()))
}
