//! What the next run will cost, from those before it.

use super::plan::Setting;
use super::trial::{Ending, Trial};

/// Expected cost of a setting, in the unit of the trials' costs; `None` when nothing like it was run.
///
/// Along a line of tolerances, from the two that are nearest, the steps of order `p` grow as `τ^(-1/(p+1))`. From mesh to mesh the cost follows the
/// unknowns where accuracy rules, and their cube where stability does, beyond order 2. The least of all guesses counts:
/// a run that proves too slow is stopped anyway.
pub fn expected(trials: &[Trial], next: Setting) -> Option<f64> {
    let finished = || trials.iter().filter(|t| t.finished());
    let mut guesses = vec![];
    let same_line = |t: &&Trial| t.line() == (next.cells, next.scheme);
    let mut line: Vec<&Trial> = finished().filter(same_line).collect();
    line.sort_by(|a, b| a.setting.rtol.total_cmp(&b.setting.rtol));
    for known in line.iter().filter(|t| t.setting.rtol > next.rtol).take(2) {
        // A single run may stand on the foot, where tighter tolerances cost less.
        let growth = if line.len() > 1 {
            along(next.scheme.order, known.setting.rtol, next.rtol)
        } else {
            1.0
        };
        guesses.push(known.cost * growth);
    }
    for coarse in finished().filter(|t| t.setting.scheme == next.scheme && t.setting.cells < next.cells) {
        if coarse.setting.rtol != next.rtol {
            continue;
        }
        let mut ratios = finished().filter(same_line).filter_map(|fine| {
            let twin = finished().find(|t| t.line() == coarse.line() && t.setting.rtol == fine.setting.rtol)?;
            Some(fine.cost / twin.cost)
        });
        let power = if next.scheme.trapped() { 3 } else { 1 };
        let ratio = ratios
            .next_back()
            .unwrap_or((next.cells as f64 / coarse.setting.cells as f64).powi(power));
        guesses.push(coarse.cost * ratio);
    }
    guesses.into_iter().reduce(f64::min)
}

/// Factor from one tolerance to another; looser ones are not expected to cost less.
fn along(order: u8, from: f64, to: f64) -> f64 {
    (from / to).powf(1.0 / (f64::from(order) + 1.0)).max(1.0)
}

/// Why a line is not gone on with, if it is not: a tighter run was stopped, or two runs without any that finished.
pub fn hopeless(trials: &[Trial], next: Setting) -> bool {
    let line: Vec<&Trial> = trials
        .iter()
        .filter(|t| t.line() == (next.cells, next.scheme))
        .collect();
    let slow = |t: &&&Trial| t.ending == Ending::Stopped;
    match line.iter().rposition(|t| t.finished()) {
        Some(last) => line[last..].iter().any(|t| slow(&t)),
        None => line.iter().filter(slow).count() >= 2,
    }
}
