//! Optimization: numbers of a case that maximize or minimize a figure, between bounds and under limits of other
//! figures.
//!
//! ```text
//! names        figures by name
//! problem      case, numbers to be optimized, goal and limits; rejects inconsistent input
//! evaluate     figures of one design, with derivatives
//! search       search from the starts to the optimum
//! exchanged    modes that differ at the optimum
//! curvature    second derivatives at the optimum
//! wiring       alternatives to choose from, in all combinations
//! outcome      the result
//! diagnostics  warnings about the result
//! ```

mod curvature;
mod diagnostics;
mod evaluate;
mod exchanged;
pub mod names;
pub mod outcome;
pub mod problem;
mod search;
pub mod wiring;

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::case::Case;
use crate::error::{Code, Result};
use crate::numerics::sqp::{HELD, SqpStatus};
use crate::study::analysis::AnalysisOutcome;
use crate::study::analysis::{self, AnalysisRequest};
use crate::study::search_bounds::Bound;
use crate::study::sweep::pool;
use diagnostics::{broken, warnings};
use outcome::{ComparedAlternative, ComputedDesign, DerivativeSource, LimitAtOptimum, Optimum, Variable};
use problem::{FigureLimit, OptimizationProblem, OptimizationRequest};
use search::{OptimizationOutcome, OptimizationSearch, better};
use wiring::Alternative;

/// Distance of a figure from a limit, over its size, below which the limit is active.
pub(super) const REACHED: f64 = 1e-4;

/// Alternative with its problem.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Alternative.
    pub alternative: Alternative,
    /// The case with the alternative, and the goal.
    pub problem: OptimizationProblem,
}

/// Optimum, with the additional data of its files.
#[derive(Clone, Debug)]
pub struct OptimizedCase {
    /// The result.
    pub optimum: Optimum,
    /// Problem with the best alternative.
    pub problem: OptimizationProblem,
    /// The case with the optimized numbers.
    pub case: Case,
    /// Every design that was computed.
    pub history: Vec<ComputedDesign>,
}

/// Optimizes every candidate. `report` is called after every design with their number and the best figure so far; `stop`
/// ends the search early.
///
/// # Errors
/// No design can be computed at any start.
pub fn optimise(
    candidates: &[Candidate],
    asked: &OptimizationRequest,
    stop: &(dyn Fn() -> bool + Sync),
    report: &(dyn Fn(usize, Option<f64>) + Sync),
) -> Result<OptimizedCase> {
    let begin = Instant::now();
    let report_all = together(asked, report);
    let searches = candidates.iter().map(|one| &one.problem).enumerate();
    let searches: Vec<OptimizationSearch<'_>> = searches
        .map(|one| OptimizationSearch::new(one, asked, stop, &report_all))
        .collect();
    // one search runs its starts in parallel; several searches run in parallel themselves
    let mut all = match &searches[..] {
        [search] => vec![search.go(asked.jobs)],
        _ => {
            let all = pool::all(searches.len(), asked.jobs, &|k| Some(searches[k].go(1)));
            all.into_iter().flatten().collect()
        }
    };
    let compared = match candidates {
        [_] => vec![],
        _ => {
            let each = candidates.iter().zip(&all);
            each.map(|(one, reached)| ComparedAlternative::new(&one.alternative, reached))
                .collect()
        }
    };
    let ends = all
        .iter()
        .enumerate()
        .filter_map(|(k, end)| Some((k, end.as_ref().ok()?)));
    let of = |end: &OptimizationOutcome| end.sizes[0];
    let best = ends.min_by(|(_, a), (_, b)| better((&a.minimum, of(a)), (&b.minimum, of(b))));
    let chosen = best.map_or(0, |(k, _)| k);
    let reached = all.swap_remove(chosen)?;
    finish(candidates, &searches, (chosen, reached), compared, stop, begin)
}

/// Counts the designs of all searches, and keeps the best figure of all.
fn together<'a>(
    asked: &OptimizationRequest,
    report: &'a (dyn Fn(usize, Option<f64>) + Sync),
) -> impl Fn(usize, Option<f64>) + Sync + use<'a> {
    let sign = asked.goal.sign();
    let so_far = Mutex::new((0, None::<f64>));
    move |_, best| {
        let mut so_far = so_far.lock().unwrap_or_else(PoisonError::into_inner);
        so_far.0 += 1;
        let both = so_far.1.into_iter().chain(best);
        so_far.1 = both.min_by(|a, b| (sign * a).total_cmp(&(sign * b)));
        report(so_far.0, so_far.1);
    }
}

/// Result at the end of the best search: curvature, active limits, and figures of the plain command.
fn finish(
    candidates: &[Candidate],
    searches: &[OptimizationSearch<'_>],
    (chosen, reached): (usize, OptimizationOutcome),
    alternatives: Vec<ComparedAlternative>,
    stop: &(dyn Fn() -> bool + Sync),
    begin: Instant,
) -> Result<OptimizedCase> {
    let (problem, search) = (&candidates[chosen].problem, &searches[chosen]);
    let minimum = &reached.minimum;
    let case = problem.with(&reached.values)?;
    let found = minimum.ended == SqpStatus::Found && minimum.at.violation() <= HELD;
    // at an active limit the figure changes with numbers to first order
    let inner = minimum.multipliers.iter().all(|gain| *gain == 0.0) && !minimum.x.is_empty();
    let bend = (found && inner && !stop())
        .then(|| curvature::bend(problem, search, &reached, reached.starts.len()))
        .flatten();
    let checked = check(problem, &case, stop);
    let exact = searches
        .iter()
        .all(|search| search.derivatives() == DerivativeSource::Exact);
    let history: Vec<ComputedDesign> = searches.iter().flat_map(OptimizationSearch::history).collect();
    let mut failed = BTreeMap::new();
    for reason in history.iter().filter_map(|design| design.reason.clone()) {
        *failed.entry(reason).or_insert(0) += 1;
    }
    let own = |found: &AnalysisOutcome| found.figure(&problem.goal.figure);
    let mut optimum = Optimum {
        case: problem.case.name.clone(),
        command: problem.what.clone(),
        goal: problem.goal.clone(),
        found,
        value: reached.figures[0],
        plain: checked.as_ref().and_then(own),
        error: checked.as_ref().and_then(|found| error(found, &problem.goal.figure)),
        begin: history
            .iter()
            .find(|design| design.start == 0)
            .and_then(|design| design.figures.as_ref().map(|figures| figures[0])),
        chosen: (!alternatives.is_empty()).then_some(chosen),
        alternatives,
        variables: (0..problem.spans.len())
            .map(|k| variable(problem, &reached, bend.as_ref(), k))
            .collect(),
        limits: (0..problem.limits.len()).map(|i| held(problem, &reached, i)).collect(),
        curvature: bend.as_ref().map(|bend| bend.curvature(problem, &reached)),
        ended: (!minimum.x.is_empty()).then(|| diagnostics::ended(minimum.ended, stop()).into()),
        derivatives: match exact {
            true => DerivativeSource::Exact,
            false => DerivativeSource::Differences,
        },
        starts: reached.starts.clone(),
        evaluations: history.len(),
        failed,
        warnings: vec![],
        wall_s: 0.0,
    };
    optimum.warnings = warnings(problem, &optimum, minimum.ended, stop());
    if !stop() {
        optimum.warnings.extend(exchanged::warnings(problem, &case));
    }
    // where limits are violated anyway, smaller steps do not help
    if !optimum.beyond_limits() {
        let broken = checked.iter().flat_map(|plain| broken(problem, plain));
        optimum.warnings.extend(broken);
    }
    let own = checked.into_iter().flat_map(|plain| plain.messages);
    optimum.warnings.extend(own);
    let flat = diagnostics::flat(problem, &optimum, &history);
    if flat.is_none() && minimum.at.slope.iter().all(|slope| *slope == 0.0) && !minimum.x.is_empty() {
        let what = format!(
            "the derivatives of {} with respect to all optimized numbers are zero at the optimum",
            problem.goal.figure
        );
        optimum.warnings.push(Code::Optimum.warning(what));
    }
    optimum.warnings.extend(flat);
    optimum.wall_s = begin.elapsed().as_secs_f64();
    Ok(OptimizedCase {
        optimum,
        problem: problem.clone(),
        case,
        history,
    })
}

/// Result of the plain command at the optimum, with errors.
fn check(problem: &OptimizationProblem, case: &Case, stop: &dyn Fn() -> bool) -> Option<AnalysisOutcome> {
    let ask = AnalysisRequest {
        what: &problem.what,
        accuracy: None,
        from: None,
        meshes: true,
        waves: true,
    };
    let found = || analysis::found(case, ask, stop, &|case| analysis::run(case, ask, stop));
    analysis::stored(&problem.evaluations, &("check", &case.name), stop, found)
}

/// Estimated absolute error of a figure.
fn error(found: &AnalysisOutcome, figure: &str) -> Option<f64> {
    let quantity = figure.split('.').next().unwrap_or_default();
    let relative = [figure, quantity]
        .iter()
        .find_map(|name| found.figure(&format!("{name}.error")))?;
    Some(relative * found.figure(figure)?.abs())
}

fn variable(
    problem: &OptimizationProblem,
    reached: &OptimizationOutcome,
    bend: Option<&curvature::Bend>,
    k: usize,
) -> Variable {
    let (span, place) = (&problem.spans[k], reached.minimum.x[k]);
    let slope = reached.minimum.at_bounds[k];
    let at_bound = match place {
        x if x <= 0.0 => Some(Bound::Low),
        x if x >= 1.0 => Some(Bound::High),
        _ => None,
    };
    // the decrease of the value per position between the bounds is the gain of the figure
    let gain = at_bound.map(|_| slope.abs() * reached.sizes[0] / span.slope(reached.values[k]).abs());
    Variable {
        pointer: span.pointer.clone(),
        low: span.low,
        high: span.high,
        logarithmic: span.logarithmic(),
        start: problem.start[k],
        value: reached.values[k],
        at_bound,
        gain,
        within_1_percent: bend.and_then(|bend| bend.within(problem, reached, k)),
    }
}

fn held(problem: &OptimizationProblem, reached: &OptimizationOutcome, i: usize) -> LimitAtOptimum {
    let limit: &FigureLimit = &problem.limits[i];
    LimitAtOptimum {
        limit: limit.clone(),
        value: reached.figures[i + 1],
        reached: reached.minimum.at.inequalities[i] > -REACHED,
        gain: (reached.minimum.at.inequalities[i] < REACHED)
            .then(|| reached.minimum.multipliers[i] * reached.sizes[0] / reached.sizes[i + 1]),
    }
}
