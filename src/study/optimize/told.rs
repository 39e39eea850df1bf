//! Warnings about an optimum.

use super::REACHED;
use super::found::{Derivatives, Design, Held, Optimum};
use super::problem::{Limit, Problem};
use crate::case::numbers::plain;
use crate::error::Code;
use crate::error::numbers::{counted, rounded};
use crate::numerics::sqp::Ended;
use crate::study::analysis::Found;
use crate::study::span::Span;

/// Largest relative difference from the plain command without a warning.
const SAME: f64 = 1e-3;

/// Formats a number with six digits.
fn six(number: f64) -> String {
    plain(rounded(number, 6))
}

/// Warns of limits that the plain command violates at the optimum.
pub(super) fn broken(problem: &Problem, plain: &Found) -> Vec<String> {
    let of = |limit: &Limit| {
        let value = plain.figure(&limit.figure)?;
        (limit.beyond(value) > REACHED * limit.bound.abs()).then(|| {
            Code::Optimum.warning(format!(
                "`slcbeam {}` gives {} {} at the best, which does not hold {} {}: a smaller /solver/rtol, or a stricter limit, helps",
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
pub(super) fn ended(ended: Ended, stopped: bool) -> &'static str {
    match ended {
        _ if stopped => "it was interrupted",
        Ended::Found => "slopes lead nowhere better",
        Ended::Stuck => "no step is better, though slopes say so",
        Ended::Apart => "no step comes nearer to the limits",
        Ended::Unfinished => "its steps ran out",
    }
}

/// Warnings about the end of the search.
pub(super) fn warnings(problem: &Problem, found: &Optimum, ended: Ended, stopped: bool) -> Vec<String> {
    let mut all = vec![];
    let mut say = |what: String| all.push(Code::Optimum.warning(what));
    let beyond: Vec<&Held> = found.limits.iter().filter(|held| held.beyond()).collect();
    match ended {
        _ if stopped => say("interrupted; the best is that so far".into()),
        _ if !beyond.is_empty() => {
            let names: Vec<String> = beyond
                .iter()
                .map(|held| format!("{} {} {}", held.limit.figure, held.limit.sign(), held.limit.bound))
                .collect();
            say(format!(
                "no design was found that holds {}: what is told comes nearest",
                names.join(" and ")
            ));
        }
        Ended::Found | Ended::Apart => {}
        Ended::Unfinished => say("the search ran out of steps; the best is where it stood".into()),
        Ended::Stuck if !found.failed.is_empty() => say(format!(
            "the search ended where no step makes the figure better, though its derivatives say so, and {} of {} could not be computed: the best \
             lies at the edge of what can, or the figure has a kink or ripples there; bounds that leave out what fails, or other starts (--starts), tell which",
            found.failed.values().sum::<usize>(),
            counted(found.evaluations as u64, "design")
        )),
        Ended::Stuck => say(
            "the search ended where no step makes the figure better, though its derivatives say so: the simulator's own error is larger \
             than what is left, or the figure has a kink or ripples there; a smaller /solver/rtol may help, or other starts (--starts)"
                .into(),
        ),
    }
    if found.derivatives == Derivatives::Differences {
        let why = match &problem.differences {
            Some(why) => why.clone(),
            None => {
                "a figure has no exact ones, or none where a number stands at the end of what its key can be".into()
            }
        };
        say(format!("derivatives are differences of designs: {why}"));
    }
    match found.plain {
        Some(plain) if (plain - found.value).abs() > SAME * found.value.abs() => say(format!(
            "`slcbeam {}` gives {} {} at the best, where the search saw {}: steps of the one or effects of the other are too \
             coarse to tell them apart; a smaller /solver/rtol may help",
            problem.what.word(),
            found.goal.figure,
            six(plain),
            six(found.value)
        )),
        None if !stopped => say(format!(
            "`slcbeam {}` does not come to an end at the best",
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
pub(super) fn flat(problem: &Problem, found: &Optimum, history: &[Design]) -> Option<String> {
    if !found.alternatives.is_empty() {
        return None;
    }
    let finished = || history.iter().filter(|design| design.figures.is_some());
    let range = |of: &dyn Fn(&Design) -> f64| {
        let all = finished().map(of);
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        })
    };
    let covers = |(k, span): (usize, &Span)| {
        let (low, high) = range(&|design| design.values.get(k).copied().unwrap_or(f64::NAN));
        high - low >= COVERED * (span.high - span.low)
    };
    let (low, high) = range(&|design| design.figures.as_ref().map_or(f64::NAN, |figures| figures[0]));
    let size = low.abs().max(high.abs());
    let error = found.error.unwrap_or(0.0).max(ROUNDING * size);
    let flat = high - low <= error && problem.spans.iter().enumerate().any(covers);
    flat.then(|| {
        Code::Optimum.warning(format!(
            "{} does not depend on the numbers that were sought, within its error: over {} it differs by {:.1e}, and its error is {error:.1e}. The best is one of \
             many; seek another figure or other numbers",
            found.goal.figure,
            counted(finished().count() as u64, "design"),
            high - low,
        ))
    })
}
