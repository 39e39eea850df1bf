//! Warnings about an optimum.

use super::REACHED;
use super::outcome::{ComputedDesign, DerivativeSource, LimitAtOptimum, Optimum};
use super::problem::{FigureLimit, OptimizationProblem};
use crate::case::numbers::plain;
use crate::error::Code;
use crate::error::numbers::{counted, rounded};
use crate::numerics::sqp::SqpStatus;
use crate::study::analysis::AnalysisOutcome;
use crate::study::search_bounds::ParameterBounds;

/// Largest relative difference from the plain command without a warning.
const SAME: f64 = 1e-3;

/// Formats a number with six digits.
fn six(number: f64) -> String {
    plain(rounded(number, 6))
}

/// Warns of limits that the plain command violates at the optimum.
pub(super) fn broken(problem: &OptimizationProblem, plain: &AnalysisOutcome) -> Vec<String> {
    let of = |limit: &FigureLimit| {
        let value = plain.figure(&limit.figure)?;
        (limit.beyond(value) > REACHED * limit.bound.abs()).then(|| {
            Code::Optimum.warning(format!(
                "`slcbeam {}` gives {} = {} at the optimum, which violates the limit {} {}. Use a smaller \
                 /solver/rtol or a stricter limit",
                problem.what.word(),
                limit.figure,
                six(value),
                limit.sign(),
                six(limit.bound)
            ))
        })
    };
    problem.limits.iter().filter_map(of).collect()
}

/// Reason why a search ended.
pub(super) fn ended(ended: SqpStatus, stopped: bool) -> &'static str {
    match ended {
        _ if stopped => "it was interrupted",
        SqpStatus::Found => "converged: derivatives predict no improvement",
        SqpStatus::Stuck => "no step improves the figure, although derivatives predict it",
        SqpStatus::Apart => "no step reduces the violation of the limits",
        SqpStatus::Unfinished => "it reached its limit of steps",
    }
}

/// Warnings about the end of the search.
pub(super) fn warnings(problem: &OptimizationProblem, found: &Optimum, ended: SqpStatus, stopped: bool) -> Vec<String> {
    let mut all = vec![];
    let mut say = |what: String| all.push(Code::Optimum.warning(what));
    let beyond: Vec<&LimitAtOptimum> = found.limits.iter().filter(|held| held.beyond()).collect();
    match ended {
        _ if stopped => say("interrupted. The reported design is the best so far".into()),
        _ if !beyond.is_empty() => {
            let names: Vec<String> = beyond
                .iter()
                .map(|held| format!("{} {} {}", held.limit.figure, held.limit.sign(), held.limit.bound))
                .collect();
            say(format!(
                "no design satisfies {}. The reported design violates the limits least",
                names.join(" and ")
            ));
        }
        SqpStatus::Found | SqpStatus::Apart => {}
        SqpStatus::Unfinished => say(
            "the search reached its limit of steps before it converged. The reported design is that of the last step. \
             Continue from it (--set)"
                .into(),
        ),
        SqpStatus::Stuck if !found.failed.is_empty() => say(format!(
            "the search ended early: no step improves the figure, although its derivatives predict an improvement, \
             and {} of {} could not be computed. The optimum lies at the edge of the computable designs, or the \
             figure has a kink or ripples there. Use bounds that exclude failed designs, or other starts (--starts)",
            found.failed.values().sum::<usize>(),
            counted(found.evaluations as u64, "design")
        )),
        SqpStatus::Stuck => say(
            "the search ended early: no step improves the figure, although its derivatives predict an improvement. \
             The numerical error exceeds the remaining improvement, or the figure has a kink or ripples there. Use a \
             smaller /solver/rtol, or other starts (--starts)"
                .into(),
        ),
    }
    if found.derivatives == DerivativeSource::Differences {
        let why = match &problem.differences {
            Some(why) => why.clone(),
            None => "a figure has no exact derivatives, or a number lies at the limit of its admissible range".into(),
        };
        say(format!("derivatives are finite differences between designs: {why}"));
    }
    match found.plain {
        Some(plain) if (plain - found.value).abs() > SAME * found.value.abs() => say(format!(
            "`slcbeam {}` gives {} = {} at the optimum, but the search computed {}. Their time steps or effects \
             differ. Use a smaller /solver/rtol",
            problem.what.word(),
            found.goal.figure,
            six(plain),
            six(found.value)
        )),
        None if !stopped => say(format!(
            "`slcbeam {}` does not finish at the optimum",
            problem.what.word()
        )),
        _ => {}
    }
    all
}

/// Share of a figure below which its changes are rounding errors.
const ROUNDING: f64 = 1e-6;
/// Share of the bounds that designs must cover before a figure is called independent.
const COVERED: f64 = 0.1;

/// Warns that the figure does not depend on the optimized numbers, if designs across the bounds differ by no more than
/// its error.
pub(super) fn flat(problem: &OptimizationProblem, found: &Optimum, history: &[ComputedDesign]) -> Option<String> {
    if !found.alternatives.is_empty() {
        return None;
    }
    let finished = || history.iter().filter(|design| design.figures.is_some());
    let range = |of: &dyn Fn(&ComputedDesign) -> f64| {
        let all = finished().map(of);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    };
    let covers = |(k, span): (usize, &ParameterBounds)| {
        let (low, high) = range(&|design| design.values.get(k).copied().unwrap_or(f64::NAN));
        high - low >= COVERED * (span.high - span.low)
    };
    let (low, high) = range(&|design| design.figures.as_ref().map_or(f64::NAN, |figures| figures[0]));
    let size = low.abs().max(high.abs());
    let error = found.error.unwrap_or(0.0).max(ROUNDING * size);
    let flat = high - low <= error && problem.spans.iter().enumerate().any(covers);
    flat.then(|| {
        Code::Optimum.warning(format!(
            "{} does not depend on the optimized numbers within its error: over {} it varies by {:.1e} (error \
             {error:.1e}). The optimum is one of many. Optimize another figure or other numbers",
            found.goal.figure,
            counted(finished().count() as u64, "design"),
            high - low,
        ))
    })
}
