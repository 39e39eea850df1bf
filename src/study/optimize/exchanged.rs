//! Modes at the optimum that differ from the initial modes of the same number.

use super::problem::OptimizationProblem;
use crate::case::Case;
use crate::error::Code;
use crate::run::modes::{Mode, likeness};
use crate::study::analysis::AnalysisKind;
use crate::study::analysis::modes::{lowest, swinging};

/// Likeness of shapes above which two modes are the same. It must exceed that of the modes of one number by [`BETTER`].
const ALIKE: f64 = 0.5;
const BETTER: f64 = 0.2;
/// Likeness below which two modes differ in any case.
const APART: f64 = 0.1;

/// Warns if a mode in goal or limits is, by its shape [E33], another mode at the optimum than at the start of the
/// search.
pub fn warnings(problem: &OptimizationProblem, best: &Case) -> Vec<String> {
    let mut numbers: Vec<usize> = problem.figures().into_iter().filter_map(number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    if problem.what != AnalysisKind::Modes || numbers.is_empty() || problem.spans.is_empty() {
        return vec![];
    }
    let of = |case: &Case| {
        let found = swinging(case).ok()?.0.modes;
        Some(
            lowest(&found)
                .into_iter()
                .map(|place| found[place].clone())
                .collect::<Vec<Mode>>(),
        )
    };
    let begin = problem.with(&problem.start).ok().and_then(|case| of(&case));
    let (Some(begin), Some(end)) = (begin, of(best)) else {
        return vec![];
    };
    let texts = numbers
        .into_iter()
        .filter_map(|number| description(number, &begin, &end));
    texts.map(|what| Code::ModesExchanged.warning(what)).collect()
}

/// Number of the mode of a figure.
fn number(figure: &str) -> Option<usize> {
    figure.strip_prefix("mode_")?.split('.').next()?.parse().ok()
}

/// Warning that mode `number` at the optimum is another one than at the start; `None` if it is the same.
fn description(number: usize, begin: &[Mode], end: &[Mode]) -> Option<String> {
    let (from, to) = (begin.get(number - 1)?, end.get(number - 1)?);
    let hz = |mode: &Mode| format!("{:.4} Hz", mode.frequency_hz().unwrap_or_default());
    let like = |mode: &Mode| likeness(&from.shape, &mode.shape);
    let (own, all) = (like(to), end.iter().enumerate());
    let (place, most) = all.max_by(|a, b| like(a.1).total_cmp(&like(b.1)))?;
    let (other, further) = (place + 1, like(most));
    if other != number && further > ALIKE && further > own + BETTER {
        return Some(format!(
            "mode_{number} at the optimum is another mode than at the start: by its shape, the start's mode of {} is \
             mode_{other} there, at {}. To follow one mode, keep the others away from it (--subject-to), or narrow \
             the bounds",
            hz(from),
            hz(most)
        ));
    }
    (own < APART).then(|| {
        format!(
            "mode_{number} at the optimum is another mode than at the start: its shape at {} differs from the start's \
             shape at {}. No other mode at the optimum has that shape",
            hz(to),
            hz(from)
        )
    })
}
