//! Expected cost of the next run, from earlier runs.

use super::plan::StudySetting;
use super::trial::{StudyTrial, TrialOutcome};

/// Expected cost of a setting, in the unit of the trials' costs; `None` if no similar setting has finished.
///
/// Along a line of tolerances, the number of steps of order `p` grows as `τ^(-1/(p+1))`; the two nearest looser runs
/// are extrapolated. From mesh to mesh, the cost grows with the unknowns if accuracy limits the step, and with their
/// cube if stability does (orders above 2). The least estimate counts: a run that proves too slow is stopped anyway.
pub fn expected(trials: &[StudyTrial], next: StudySetting) -> Option<f64> {
    let finished = || trials.iter().filter(|t| t.finished());
    let mut guesses = vec![];
    let same_line = |t: &&StudyTrial| t.line() == (next.cells, next.scheme);
    let mut line: Vec<&StudyTrial> = finished().filter(same_line).collect();
    line.sort_by(|a, b| a.setting.rtol.total_cmp(&b.setting.rtol));
    for known in line.iter().filter(|t| t.setting.rtol > next.rtol).take(2) {
        // A single run may lie where tighter tolerances cost less: assume no growth.
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

/// Cost factor from one tolerance to another; a looser tolerance is not expected to cost less.
fn along(order: u8, from: f64, to: f64) -> f64 {
    (from / to).powf(1.0 / (f64::from(order) + 1.0)).max(1.0)
}

/// True if a line is not continued: a run after the last finished one was stopped, or two were stopped and none
/// finished.
pub fn hopeless(trials: &[StudyTrial], next: StudySetting) -> bool {
    let line: Vec<&StudyTrial> = trials
        .iter()
        .filter(|t| t.line() == (next.cells, next.scheme))
        .collect();
    let slow = |t: &&&StudyTrial| t.ending == TrialOutcome::Stopped;
    match line.iter().rposition(|t| t.finished()) {
        Some(last) => line[last..].iter().any(|t| slow(&t)),
        None => line.iter().filter(slow).count() >= 2,
    }
}
