//! Search from the starts to the optimum; stores every design on the way.

use std::cmp::Ordering;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};

use nalgebra::{DMatrix, DVector};

use super::evaluate::{EvaluatedDesign, look};
use super::outcome::{ComputedDesign, DerivativeSource, OptimizationStart};
use super::problem::{OptimizationProblem, OptimizationRequest};
use crate::error::{Error, Result, SolverError, StopPoint};
use crate::numerics::sqp::{HELD, SqpMinimum, SqpOptions, SqpPoint, SqpStatus, minimise};
use crate::study::search_bounds;
use crate::study::sweep::pool;

/// Largest number of steps of a search.
const STEPS: usize = 60;
/// Step between the bounds below which a search has converged.
const CLOSE: f64 = 3e-5;
/// Largest number of searches from one start, each from the end of the previous one: a slope that is small relative to
/// the initial figure may be large relative to the final figure.
const AGAIN: usize = 6;
/// Slope between the bounds, relative to the figure, below which the end of a search is stationary.
const LEVEL: f64 = 1e-3;
/// Slope, in the same measure, above which an end does not count as an optimum: derivatives contradict values, or there
/// is a kink.
const STEEP: f64 = 2e-2;
/// Relative error of figures of equilibria and modes.
const EXACT: f64 = 1e-9;

/// A search.
pub struct OptimizationSearch<'a> {
    problem: &'a OptimizationProblem,
    asked: &'a OptimizationRequest,
    stop: &'a (dyn Fn() -> bool + Sync),
    report: &'a (dyn Fn(usize, Option<f64>) + Sync),
    history: Mutex<Vec<ComputedDesign>>,
    differences: AtomicBool,
    alternative: usize,
}

/// Result of all searches.
pub struct OptimizationOutcome {
    /// Minimum of the best search.
    pub minimum: SqpMinimum,
    /// Values of the numbers at the minimum.
    pub values: Vec<f64>,
    /// Figures at the minimum.
    pub figures: Vec<f64>,
    /// Sizes by which figures are divided, in their order.
    pub sizes: Vec<f64>,
    /// Searches from all starts.
    pub starts: Vec<OptimizationStart>,
}

impl<'a> OptimizationSearch<'a> {
    /// Creates the search of a problem, one of several alternatives. `report` is called after every design with their
    /// number and the best figure that meets the limits.
    pub fn new(
        (alternative, problem): (usize, &'a OptimizationProblem),
        asked: &'a OptimizationRequest,
        stop: &'a (dyn Fn() -> bool + Sync),
        report: &'a (dyn Fn(usize, Option<f64>) + Sync),
    ) -> Self {
        Self {
            problem,
            asked,
            stop,
            report,
            history: Mutex::new(vec![]),
            differences: AtomicBool::new(false),
            alternative,
        }
    }

    /// Every design so far.
    pub fn history(&self) -> Vec<ComputedDesign> {
        self.history.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Source of the derivatives.
    pub fn derivatives(&self) -> DerivativeSource {
        match self.differences.load(Relaxed) {
            true => DerivativeSource::Differences,
            false => DerivativeSource::Exact,
        }
    }

    /// Searches from every start, `jobs` of them in parallel. The best end meets the limits and, among these, has the
    /// best figure.
    ///
    /// # Errors
    /// No design can be computed at any start.
    pub fn go(&self, jobs: usize) -> Result<OptimizationOutcome> {
        // without numbers there is only one start
        let starts = if self.problem.spans.is_empty() {
            1
        } else {
            self.asked.starts
        };
        let places = search_bounds::places(&self.problem.spans, &self.problem.start, starts)?;
        let one = |k: usize| (!(self.stop)()).then(|| self.minimise(k, &places[k]));
        let found = pool::all(places.len(), jobs, &one);
        let found: Vec<Option<(SqpMinimum, Vec<f64>)>> = found.into_iter().map(Option::flatten).collect();
        let start = |(from, found): (&Vec<f64>, &Option<(SqpMinimum, Vec<f64>)>)| {
            let at = found
                .as_ref()
                .map(|(minimum, sizes)| (minimum, self.figures(minimum, sizes)));
            OptimizationStart {
                from: search_bounds::values(&self.problem.spans, from),
                to: at
                    .as_ref()
                    .map(|(minimum, _)| search_bounds::values(&self.problem.spans, &minimum.x)),
                value: at.as_ref().map(|(_, figures)| figures[0]),
                held: at.as_ref().is_some_and(|(minimum, _)| minimum.at.violation() <= HELD),
                steps: at.as_ref().map_or(0, |(minimum, _)| minimum.steps),
            }
        };
        let starts = places.iter().zip(&found).map(start).collect();
        let ends = found.into_iter().flatten();
        let best = ends.min_by(|(a, own), (b, other)| better((a, own[0]), (b, other[0])));
        if best.is_none() && (self.stop)() {
            return Err(Error::Interrupted(
                "interrupted before the first design was computed. No results are written".into(),
            ));
        }
        let Some((minimum, sizes)) = best else {
            let why = self.history().into_iter().find_map(|design| design.reason);
            let why = why.map_or(String::new(), |why| format!(": {why}"));
            return Err(Error::Solver(Box::new(SolverError {
                code: self.problem.what.analysis().fault(),
                at: StopPoint::Time(0.0),
                what: format!("the designs at all starts fail{why}"),
                unknown: None,
                cause: None,
                hint: Some(
                    "run the case alone with the command that computes the designs, or use other starts (--set, \
                     --starts)"
                        .into(),
                ),
            })));
        };
        Ok(OptimizationOutcome {
            values: search_bounds::values(&self.problem.spans, &minimum.x),
            figures: self.figures(&minimum, &sizes),
            minimum,
            sizes,
            starts,
        })
    }

    /// Figures at the end of a search.
    fn figures(&self, minimum: &SqpMinimum, sizes: &[f64]) -> Vec<f64> {
        let goal = self.problem.goal.sign() * minimum.at.value * sizes[0];
        let limits = self
            .problem
            .limits
            .iter()
            .zip(&sizes[1..])
            .zip(minimum.at.inequalities.iter());
        let limits = limits.map(|((limit, size), c)| limit.bound + limit.sense() * c * size);
        std::iter::once(goal).chain(limits).collect()
    }

    /// Minimizes from one start; returns the minimum and the sizes of figures.
    fn minimise(&self, start: usize, from: &[f64]) -> Option<(SqpMinimum, Vec<f64>)> {
        let mut sizes: Option<Vec<f64>> = None;
        let options = SqpOptions {
            steps: STEPS,
            close: CLOSE,
            noise: self.noise(),
        };
        let mut found: Option<SqpMinimum> = None;
        for _ in 0..AGAIN {
            let from = found.as_ref().map_or(from, |found| &found.x);
            // do not compute the end of the last search again
            let mut here = found
                .as_ref()
                .zip(sizes.as_ref())
                .map(|(found, sizes)| self.rescaled(found, sizes));
            if let Some((_, own)) = &here {
                sizes = Some(own.clone());
            }
            let next = minimise(from, &options, &mut |places| {
                if let Some((point, _)) = here.take() {
                    return Some(point);
                }
                let seen = self.look(start, places)?;
                let sizes = sizes.get_or_insert_with(|| self.sizes(&seen.figures));
                Some(self.point(&seen, sizes))
            })?;
            let steps = found.as_ref().map_or(0, |found| found.steps);
            let moved = next.steps > 0;
            let first = found.is_none();
            let next = SqpMinimum {
                steps: steps + next.steps,
                ..next
            };
            let level = steepness(&next) <= LEVEL;
            found = Some(next);
            if level || !(first || moved) || (self.stop)() {
                break;
            }
        }
        let mut found = found?;
        if found.ended == SqpStatus::Found && steepness(&found) > STEEP {
            found.ended = SqpStatus::Stuck;
        }
        Some((found, sizes?))
    }

    /// Relative error of figures.
    fn noise(&self) -> f64 {
        match self.problem.what.analysis().is_in_time() {
            true => self.problem.case.solver.rtol.max(EXACT),
            false => EXACT,
        }
    }

    /// Point at the end of a search, scaled with the size of the figure there.
    fn rescaled(&self, found: &SqpMinimum, sizes: &[f64]) -> (SqpPoint, Vec<f64>) {
        let figures = self.figures(found, sizes);
        let mut own = sizes.to_vec();
        if figures[0] != 0.0 {
            own[0] = figures[0].abs();
        }
        let share = sizes[0] / own[0];
        let point = SqpPoint {
            value: found.at.value * share,
            slope: &found.at.slope * share,
            ..found.at.clone()
        };
        (point, own)
    }

    /// Sizes of figures: the initial figure of the goal, the bounds of limits.
    fn sizes(&self, figures: &[f64]) -> Vec<f64> {
        let size = |x: f64, otherwise: f64| match x.abs() > 0.0 {
            true => x.abs(),
            false if otherwise.abs() > 0.0 => otherwise.abs(),
            false => 1.0,
        };
        let limits = self.problem.limits.iter().zip(&figures[1..]);
        let limits = limits.map(|(limit, figure)| size(limit.bound, *figure));
        std::iter::once(size(figures[0], 1.0)).chain(limits).collect()
    }

    /// Converts figures and derivatives of a design to the scaled form of the search.
    pub fn point(&self, seen: &EvaluatedDesign, sizes: &[f64]) -> SqpPoint {
        let (n, limits) = (self.problem.spans.len(), &self.problem.limits);
        let scale = self.problem.goal.sign() / sizes[0];
        let by = |i: usize| limits[i].sense() / sizes[i + 1];
        SqpPoint {
            value: scale * seen.figures[0],
            slope: DVector::from_fn(n, |k, _| scale * seen.slopes[0][k]),
            inequalities: DVector::from_fn(limits.len(), |i, _| {
                limits[i].beyond(seen.figures[i + 1]) / sizes[i + 1]
            }),
            slopes: DMatrix::from_fn(limits.len(), n, |i, k| by(i) * seen.slopes[i + 1][k]),
        }
    }

    /// Evaluates a position, and stores the designs that are computed for it.
    pub fn look(&self, start: usize, places: &[f64]) -> Option<EvaluatedDesign> {
        if (self.stop)() {
            return None;
        }
        let keep = |values: &[f64], figures: &std::result::Result<Vec<f64>, String>, wall_s: f64| {
            if (self.stop)() {
                return;
            }
            self.keep(start, values, figures, wall_s);
        };
        let seen = look(self.problem, places, &|| (self.stop)(), &keep).ok()?;
        if seen.from == DerivativeSource::Differences {
            self.differences.store(true, Relaxed);
        }
        let finite = seen
            .figures
            .iter()
            .chain(seen.slopes.iter().flatten())
            .all(|x| x.is_finite());
        finite.then_some(seen)
    }

    fn keep(&self, start: usize, values: &[f64], figures: &std::result::Result<Vec<f64>, String>, wall_s: f64) {
        let limits = &self.problem.limits;
        let held = |figures: &Vec<f64>| {
            let each = limits.iter().zip(&figures[1..]);
            each.map(|(limit, figure)| (limit.beyond(*figure), limit.bound.abs()))
                .all(|(beyond, size)| beyond <= 1e-5 * size)
        };
        let design = ComputedDesign {
            alternative: self.alternative,
            start,
            values: values.to_vec(),
            held: figures.as_ref().is_ok_and(held),
            figures: figures.as_ref().ok().cloned(),
            reason: figures.as_ref().err().cloned(),
            wall_s,
        };
        let mut history = self.history.lock().unwrap_or_else(PoisonError::into_inner);
        history.push(design);
        let sign = self.problem.goal.sign();
        let good = history.iter().filter(|one| one.held);
        let best = good.filter_map(|one| one.figures.as_ref().map(|figures| figures[0]));
        let best = best.min_by(|a, b| (sign * a).total_cmp(&(sign * b)));
        (self.report)(history.len(), best);
    }
}

/// Compares the ends of two searches, each with the size of the figure: less violation of the limits is better, then
/// the better figure.
pub fn better(a: (&SqpMinimum, f64), b: (&SqpMinimum, f64)) -> Ordering {
    let worth = |(minimum, size): (&SqpMinimum, f64)| {
        let violation = minimum.at.violation();
        let beyond = if violation > HELD { violation } else { 0.0 };
        (beyond, minimum.at.value * size)
    };
    let (a, b) = (worth(a), worth(b));
    a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
}

/// Steepness at the end of a search, relative to the figure there: the largest slope of the goal, including limits with
/// their multipliers, with respect to numbers that no bound holds.
fn steepness(found: &SqpMinimum) -> f64 {
    let lambda = DVector::from_column_slice(&found.multipliers);
    let slope = &found.at.slope + found.at.slopes.tr_mul(&lambda);
    let free = slope
        .iter()
        .zip(&found.x)
        .map(|(slope, x)| match (*x <= 0.0, *x >= 1.0) {
            (true, _) => -slope.min(0.0),
            (_, true) => slope.max(0.0),
            _ => slope.abs(),
        });
    free.fold(0.0, f64::max) / found.at.value.abs().max(f64::MIN_POSITIVE)
}
