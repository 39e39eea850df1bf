//! Pareto front of error and cost, and the figures derived from it.

use serde::{Deserialize, Serialize};

use crate::run::json_null;

/// Error and cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostMark {
    /// Relative error.
    pub error: f64,
    /// Wall time [s].
    pub cost: f64,
}

/// Indices of the Pareto-optimal points (no other point has both less error and less cost), by falling error.
pub fn front(marks: &[CostMark]) -> Vec<usize> {
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

/// Cheapest point that reaches an accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheapestPoint {
    /// Required accuracy, relative.
    pub accuracy: f64,
    /// Cheapest point that reaches the accuracy; `None` if no point does.
    pub point: Option<usize>,
}

/// Returns the cheapest point on the front for each required accuracy.
pub fn answers(marks: &[CostMark], front: &[usize], accuracies: &[f64]) -> Vec<CheapestPoint> {
    let cheapest = |accuracy: f64| front.iter().copied().find(|&k| marks[k].error <= accuracy);
    accuracies
        .iter()
        .map(|&accuracy| CheapestPoint {
            accuracy,
            point: cheapest(accuracy),
        })
        .collect()
}

/// Cost minimum of a line: a looser tolerance costs more than a tighter one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CostMinimum {
    /// The point that costs least.
    pub cheapest: usize,
    /// The looser point that costs most.
    pub looser: usize,
    /// Ratio of the two costs.
    #[serde(deserialize_with = "json_null::number")]
    pub factor: f64,
}

/// Ratio of cost, and of work, above which the difference is not scatter.
const MORE: f64 = 1.1;

/// Returns the cost minimum of a line, if it has one. `line` contains indices from loose to tight. Cost and work must
/// both show the minimum, since wall times scatter.
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

/// Point of a line at which temporal and spatial error are equal. The spatial error is constant along the line.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorBalance {
    /// Tolerance.
    pub rtol: f64,
    /// Total error there.
    pub error: f64,
    /// Wall time there [s].
    pub cost: f64,
}

/// Tolerance, temporal error, total error and cost of a run. Lines are ordered from loose to tight.
pub type WorkPrecisionLine = (f64, f64, f64, f64);

/// Interpolates in logarithms between the last point whose temporal error exceeds the spatial error and the next point.
pub fn balance(line: &[WorkPrecisionLine], spatial: f64) -> Option<ErrorBalance> {
    let pair = line.windows(2).rev().find(|w| w[0].1 > spatial && w[1].1 <= spatial)?;
    let (a, b) = (pair[0], pair[1]);
    let share = ((a.1 / spatial).ln() / (a.1 / b.1).ln()).clamp(0.0, 1.0);
    if !share.is_finite() {
        return None;
    }
    let at = |a: f64, b: f64| (a.ln() * (1.0 - share) + b.ln() * share).exp();
    Some(ErrorBalance {
        rtol: at(a.0, b.0),
        error: at(a.2, b.2),
        cost: at(a.3, b.3),
    })
}
