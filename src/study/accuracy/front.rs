//! What a cloud of points in the plane of error and time says.

use serde::{Deserialize, Serialize};

use crate::run::null;

/// A point: error, cost, and the tolerance that made it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Relative error.
    pub error: f64,
    /// Wall time [s].
    pub cost: f64,
}

/// Indices of the points that no other beats in error and cost at once, by falling error.
pub fn front(marks: &[Mark]) -> Vec<usize> {
    let mut by_cost: Vec<usize> = (0..marks.len())
        .filter(|&k| marks[k].error.is_finite() && marks[k].cost.is_finite())
        .collect();
    by_cost.sort_by(|&a, &b| {
        let (a, b) = (marks[a], marks[b]);
        a.cost.total_cmp(&b.cost).then(a.error.total_cmp(&b.error))
    });
    let mut least = f64::INFINITY;
    by_cost.retain(|&k| {
        let better = marks[k].error < least;
        least = least.min(marks[k].error);
        better
    });
    by_cost
}

/// The cheapest way to an accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Accuracy asked for, relative.
    pub accuracy: f64,
    /// Point that has it at least cost; `None` when no point has.
    pub point: Option<usize>,
}

/// For each accuracy the cheapest point on the front that has it.
pub fn answers(marks: &[Mark], front: &[usize], accuracies: &[f64]) -> Vec<Answer> {
    let cheapest = |accuracy: f64| front.iter().copied().find(|&k| marks[k].error <= accuracy);
    accuracies
        .iter()
        .map(|&accuracy| Answer {
            accuracy,
            point: cheapest(accuracy),
        })
        .collect()
}

/// A line on which looser tolerances cost more than a tighter one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostMinimum {
    /// The point that costs least.
    pub cheapest: usize,
    /// The looser point that costs most.
    pub looser: usize,
    /// How many times as much.
    #[serde(deserialize_with = "null::number")]
    pub factor: f64,
}

/// More than this many times the work of the cheapest run is no accident.
const MORE: f64 = 1.1;

/// The foot of a line, if it has one. `line` are indices from loose to tight; `work` must show it as well as the cost,
/// since clocks have accidents.
pub fn cost_minimum(line: &[usize], cost: &[f64], work: &[f64]) -> Option<CostMinimum> {
    let at = (0..line.len()).min_by(|&a, &b| cost[line[a]].total_cmp(&cost[line[b]]))?;
    let cheapest = line[at];
    let looser = line[..at]
        .iter()
        .copied()
        .max_by(|&a, &b| cost[a].total_cmp(&cost[b]))?;
    let factor = cost[looser] / cost[cheapest];
    (factor > MORE && work[looser] > MORE * work[cheapest]).then_some(CostMinimum {
        cheapest,
        looser,
        factor,
    })
}

/// Where on a line the temporal error falls to the spatial one, which is the same all along it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Tolerance.
    pub rtol: f64,
    /// Total error there.
    pub error: f64,
    /// Wall time there [s].
    pub cost: f64,
}

/// What the balance is taken from: tolerance, temporal error, total error, cost; loose to tight.
pub type Along = (f64, f64, f64, f64);

/// Between the last point whose temporal error is above the spatial one and the first below, in logarithms.
pub fn balance(line: &[Along], spatial: f64) -> Option<Balance> {
    let pair = line.windows(2).rev().find(|w| w[0].1 > spatial && w[1].1 <= spatial)?;
    let (a, b) = (pair[0], pair[1]);
    let share = ((a.1 / spatial).ln() / (a.1 / b.1).ln()).clamp(0.0, 1.0);
    if !share.is_finite() {
        return None;
    }
    let at = |a: f64, b: f64| (a.ln() * (1.0 - share) + b.ln() * share).exp();
    Some(Balance {
        rtol: at(a.0, b.0),
        error: at(a.2, b.2),
        cost: at(a.3, b.3),
    })
}
