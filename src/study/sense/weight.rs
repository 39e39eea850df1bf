//! Weight of the prior relative to the data.

use std::convert::Infallible;

use nalgebra::DMatrix;

use super::estimate::{EstimateOptions, Smoothing};
use crate::numerics::bayesian_least_squares::{Posterior, ReducedProblem};
use crate::numerics::golden_section;

/// Largest ratio of prior rows to measured rows.
const HEAVIEST: f64 = 1e6;
/// Search grid of the weight: lowest and highest logarithm, number of points.
const WEIGHTS: (f64, f64, usize) = (-14.0, 25.0, 79);
/// Error of the logarithm of the weight.
const CLOSE: f64 = 1e-3;

/// Weight of the prior by the criterion of `ask.smoothing`: maximum likelihood or discrepancy.
pub(super) fn choose(
    linear: &[ReducedProblem],
    before: &dyn Fn(f64) -> DMatrix<f64>,
    rank: usize,
    ask: &EstimateOptions,
    most: f64,
) -> f64 {
    let rows: usize = linear.iter().map(|one| one.rows).sum();
    // minimized
    let cost = |log_weight: f64| {
        let before = before(log_weight.exp());
        let all: Vec<Posterior> = linear.iter().map(|one| one.posterior(&before)).collect();
        let sum = |of: &dyn Fn(&Posterior) -> f64| all.iter().map(of).sum::<f64>();
        if ask.smoothing == Smoothing::Discrepancy {
            return (sum(&|p| p.misfit) / rows as f64).ln().abs();
        }
        let left = sum(&|p| p.misfit + p.rough);
        let volume = sum(&|p| p.log_determinant) - 2.0 * log_weight * (rank * linear.len()) as f64;
        let free = sum(&|p| p.rank.saturating_sub(rank) as f64);
        match ask.noise_known {
            true => volume + left,
            false => volume + (rows as f64 - free) * left.max(f64::MIN_POSITIVE).ln(),
        }
    };
    let (low, high, count) = WEIGHTS;
    let high = high.min(most.ln());
    let step = (high - low) / (count - 1) as f64;
    let tried = (0..count).map(|k| low + step * k as f64).map(|w| (w, cost(w)));
    let best = tried.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |best| best.0);
    let around = [best - step, (best + step).min(high)];
    let steps = golden_section::steps(around[1] - around[0], CLOSE);
    let Ok(least) = golden_section::maximum(around, steps, |w| Ok::<_, Infallible>(-cost(w)));
    least.exp()
}

/// Largest useful weight: beyond it the measured rows vanish in rounding errors and the result no longer changes.
pub(super) fn heaviest(weighted: impl Iterator<Item = DMatrix<f64>>, differences: &DMatrix<f64>) -> f64 {
    let measured = weighted.map(|rows| rows.amax()).fold(0.0, f64::max);
    let before = if differences.is_empty() {
        0.0
    } else {
        differences.amax()
    };
    match measured > 0.0 && before > 0.0 {
        true => HEAVIEST * measured / before,
        false => f64::INFINITY,
    }
}
