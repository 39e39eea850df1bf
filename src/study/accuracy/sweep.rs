//! Runs of a study, within its budget.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::cost_prediction;
use super::plan::{Budget, StudyPlan, StudySetting};
use super::scheme::Scheme;
use super::tolerances::ToleranceSequence;
use super::trial::{self, CostLimits, RunPurpose, StudyTrial};
use crate::case::Case;
use crate::error::Result;
use crate::study::evaluations::Evaluations;
use crate::study::sweep::pool;

/// Share of the budget for points; references need the rest.
const POINTS: f64 = 0.5;
/// Share of the budget for one run of a point.
const POINT: f64 = 0.06;
/// Share of the budget for the repeats of a point.
const REPEATS: f64 = 0.015;

/// Event before each run.
#[derive(Clone, Copy, Debug)]
pub struct StudyEvent {
    /// Setting of the run.
    pub setting: StudySetting,
    /// Purpose of the run.
    pub role: RunPurpose,
    /// Expected cost of one run, if known.
    pub expected: Option<f64>,
    /// Cost so far.
    pub spent: f64,
    /// Budget of the study.
    pub budget: Budget,
    /// Settings done, skipped ones included.
    pub done: usize,
    /// Total number of settings.
    pub of: usize,
}

/// Callback before each run.
pub type StudyWatch<'a> = &'a (dyn Fn(&StudyEvent) + Sync);

#[derive(Default)]
struct State {
    trials: Vec<StudyTrial>,
    spent: f64,
    reserved: f64,
    done: usize,
    lines_begun: usize,
    /// Wall time of the runs that an interrupted study had finished [s].
    earlier: f64,
}

struct Sweep<'a> {
    case: &'a Case,
    plan: &'a StudyPlan,
    begin: Instant,
    state: Mutex<State>,
    evaluations: &'a Evaluations,
    watch: StudyWatch<'a>,
}

/// Runs points, then references; returns the trials and the total cost.
pub fn sweep(
    case: &Case,
    plan: &StudyPlan,
    evaluations: &Evaluations,
    watch: StudyWatch,
) -> Result<(Vec<StudyTrial>, f64)> {
    let sweep = Sweep {
        case,
        plan,
        begin: Instant::now(),
        state: Mutex::default(),
        evaluations,
        watch,
    };
    let lines: Vec<(usize, Scheme)> = plan
        .cells
        .iter()
        .flat_map(|&k| plan.schemes.iter().map(move |&o| (k, o)))
        .collect();
    sweep.each(&lines, |&(cells, scheme)| {
        let mut room = sweep.room(lines.len());
        plan.rtols
            .iter()
            .try_for_each(|&rtol| sweep.point(StudySetting { cells, scheme, rtol }, &mut room))
    })?;
    let meshes = plan.reference_cells();
    let numbers: Vec<usize> = (0..meshes.len()).collect();
    sweep.each(&numbers, |&k| sweep.references(&meshes[k..]))?;
    let spent = sweep.spent(&sweep.lock());
    let trials = sweep.state.into_inner().unwrap_or_else(PoisonError::into_inner).trials;
    Ok((trials, spent))
}

impl Sweep<'_> {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn spent(&self, state: &State) -> f64 {
        match self.plan.budget {
            Budget::Wall(_) => state.earlier + self.begin.elapsed().as_secs_f64(),
            Budget::Steps(_) => state.spent + state.reserved,
        }
    }

    /// Processes every item, in parallel if the plan requests it.
    fn each<T: Sync>(&self, items: &[T], work: impl Fn(&T) -> Result<()> + Sync) -> Result<()> {
        if !self.plan.parallel {
            return items.iter().try_for_each(work);
        }
        let numbers: Vec<usize> = (0..items.len()).collect();
        pool::each(&numbers, pool::cores(), &|k| Some(work(&items[k])), &mut |ended| ended)
    }

    /// Budget of a line: twice its share of the remaining budget for points, since many lines need less.
    fn room(&self, lines: usize) -> f64 {
        let mut state = self.lock();
        let to_come = (lines - state.lines_begun).max(1) as f64;
        state.lines_begun += 1;
        2.0 * (POINTS * self.plan.budget.size() - self.spent(&state)).max(0.0) / to_come
    }

    fn point(&self, setting: StudySetting, room: &mut f64) -> Result<()> {
        let budget = self.plan.budget;
        let role = RunPurpose::Point;
        let (left, expected, hopeless) = {
            let state = self.lock();
            let left = (POINTS * budget.size() - self.spent(&state)).min(*room);
            (
                left,
                cost_prediction::expected(&state.trials, setting),
                cost_prediction::hopeless(&state.trials, setting),
            )
        };
        let cap = left.min(POINT * budget.size());
        let reason = match expected {
            _ if left <= 0.0 => Some("the share of the budget for points is used up".to_string()),
            _ if hopeless => Some("looser tolerances were too slow already".to_string()),
            Some(cost) if cost > cap => Some(format!(
                "expected cost {}, but only {} remain",
                budget.describe(cost),
                budget.describe(cap)
            )),
            _ => None,
        };
        if let Some(reason) = reason {
            let mut state = self.lock();
            state.trials.push(StudyTrial::skipped(setting, role, reason));
            state.done += 1;
            return Ok(());
        }
        let repeats = (REPEATS * budget.size()).min(left - cap).max(0.0);
        let allowed = CostLimits {
            run: cap,
            repeats,
            wanted: if self.plan.repeats > 1 { self.plan.repeats } else { 0 },
        };
        *room -= self.run(setting, role, expected, allowed)?;
        self.lock().done += 1;
        Ok(())
    }

    /// Runs a setting and returns its cost.
    fn run(&self, setting: StudySetting, role: RunPurpose, expected: Option<f64>, allowed: CostLimits) -> Result<f64> {
        let most = allowed.run + allowed.repeats;
        let event = {
            let mut state = self.lock();
            let spent = self.spent(&state);
            state.reserved += most;
            let of = self.plan.cells.len() * (self.plan.schemes.len() * self.plan.rtols.len() + 1) + 1;
            StudyEvent {
                setting,
                role,
                expected,
                spent,
                budget: self.plan.budget,
                done: state.done,
                of,
            }
        };
        (self.watch)(&event);
        let begin = Instant::now();
        let outcome = trial::run(self.case, (setting, role), self.plan.budget, allowed, self.evaluations);
        let mut state = self.lock();
        state.reserved -= most;
        let (trial, cost) = outcome?;
        state.spent += cost;
        // stored runs took their time earlier; assume the present number of parallel runs
        let before = (cost - begin.elapsed().as_secs_f64()).max(0.0);
        state.earlier += before / if self.plan.parallel { pool::cores() as f64 } else { 1.0 };
        state.trials.push(trial);
        Ok(cost)
    }

    /// Computes the references of the first of these meshes: each scheme, which checks the other, as tight as its share
    /// of the budget allows.
    fn references(&self, meshes: &[usize]) -> Result<()> {
        // Divides the remaining budget among the meshes by their unknowns and their stiffness. The mesh beyond the
        // finest has the weight of the finest, since no point depends on it.
        let finest = self.plan.cells.last().copied().unwrap_or(1);
        let weight = |cells: usize| (cells.min(finest) as f64).powi(2);
        let of_all: f64 = meshes.iter().map(|&k| weight(k)).sum();
        let Some(&cells) = meshes.first() else { return Ok(()) };
        let left = self.plan.budget.size() - self.spent(&self.lock());
        let mut share = left.max(0.0) * weight(cells) / of_all;
        for (k, scheme) in self.plan.reference_schemes().into_iter().enumerate() {
            let room = if k == 0 { 0.6 * share } else { share };
            share -= self.reference(cells, scheme, room)?;
        }
        self.lock().done += 1;
        Ok(())
    }

    /// Computes the reference of one scheme on one mesh; returns its cost.
    fn reference(&self, cells: usize, scheme: Scheme, room: f64) -> Result<f64> {
        let mut left = room;
        let mut too_tight = 0.0;
        loop {
            let (next, expected, first) = {
                let state = self.lock();
                let sequence = ToleranceSequence::select(&state.trials, cells, scheme);
                let last = sequence.last().map(|t| t.setting.rtol);
                let tighter = |rtol: &f64| *rtol > too_tight && last.is_none_or(|last| *rtol < last);
                let mut candidates = self.plan.reference_rtols();
                candidates.extend(self.plan.rtols.iter().rev());
                if last.is_none() {
                    // Without a finished run of this line, begin with its tightest point.
                    candidates.retain(|rtol| self.plan.rtols.contains(rtol));
                }
                let setting = |rtol| StudySetting { cells, scheme, rtol };
                let priced = candidates.into_iter().filter(tighter).map(|rtol| {
                    let setting = setting(rtol);
                    (setting, cost_prediction::expected(&state.trials, setting))
                });
                let affordable = |expected: &Option<f64>| expected.is_none_or(|cost| cost <= 0.8 * left);
                let Some((next, expected)) = priced.into_iter().find(|(_, expected)| affordable(expected)) else {
                    break;
                };
                (next, expected, last.is_none())
            };
            let allowed = CostLimits {
                run: left,
                repeats: 0.0,
                wanted: 0,
            };
            left -= self.run(next, RunPurpose::Reference, expected, allowed)?;
            let finished = self
                .lock()
                .trials
                .last()
                .is_some_and(|t| t.setting == next && t.finished());
            if finished && !first {
                break;
            }
            if !finished {
                too_tight = next.rtol;
            }
            if left <= 0.0 {
                break;
            }
        }
        Ok(room - left)
    }
}
