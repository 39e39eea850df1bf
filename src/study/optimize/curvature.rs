//! Curvature at the optimum: second derivatives from differences of slopes.

use nalgebra::DMatrix;

use super::outcome::Curvature;
use super::problem::OptimizationProblem;
use super::search::{OptimizationOutcome, OptimizationSearch};

/// Change of a position in a difference, to either side.
const BESIDE: f64 = 0.01;
/// Largest relative difference between second derivatives from values and from slopes.
const ALIKE: f64 = 0.3;
/// Relative change of the figure, 1 %, for which [`Bend::within`] returns the numbers.
const SHARE: f64 = 0.01;

/// Second derivatives at an optimum.
pub struct Bend {
    /// Indices of the numbers that are not at a bound.
    pub free: Vec<usize>,
    /// Second derivatives of the figure over its size, times the sign of the goal, with respect to positions between
    /// the bounds.
    matrix: DMatrix<f64>,
}

/// Computes second derivatives of the goal with respect to the numbers that are not at a bound. `None` if a design next
/// to the optimum cannot be computed, or if there is a kink or noise.
pub fn bend(
    problem: &OptimizationProblem,
    search: &OptimizationSearch<'_>,
    reached: &OptimizationOutcome,
    start: usize,
) -> Option<Bend> {
    let minimum = &reached.minimum;
    let inside = |k: &usize| minimum.at_bounds[*k] == 0.0 && minimum.x[*k] > BESIDE && minimum.x[*k] < 1.0 - BESIDE;
    let free: Vec<usize> = (0..problem.spans.len()).filter(inside).collect();
    let mut matrix = DMatrix::zeros(free.len(), free.len());
    for (i, k) in free.iter().enumerate() {
        let at = |change: f64| {
            let mut places = minimum.x.clone();
            places[*k] += change;
            let seen = search.look(start, &places)?;
            Some(search.point(&seen, &reached.sizes))
        };
        let (above, below) = (at(BESIDE)?, at(-BESIDE)?);
        let change = (&above.slope - &below.slope) / (2.0 * BESIDE);
        // different second derivatives from values and from slopes indicate a kink, or noise
        let by_values = (above.value + below.value - 2.0 * minimum.at.value) / (BESIDE * BESIDE);
        if (by_values - change[*k]).abs() > ALIKE * change[*k].abs() {
            return None;
        }
        free.iter().enumerate().for_each(|(j, l)| matrix[(j, i)] = change[*l]);
    }
    let matrix = (&matrix + matrix.transpose()) * 0.5;
    Some(Bend { free, matrix })
}

impl Bend {
    /// Values of a number on both sides of the optimum at which the figure would be worse by 1 %, with the others
    /// fixed; `None` if one of the values lies beyond its bounds.
    pub fn within(&self, problem: &OptimizationProblem, reached: &OptimizationOutcome, k: usize) -> Option<[f64; 2]> {
        let i = self.free.iter().position(|own| *own == k)?;
        let bend = self.matrix[(i, i)];
        let worse = SHARE * reached.minimum.at.value.abs();
        let far = (2.0 * worse / bend).sqrt();
        let span = &problem.spans[k];
        let places = [reached.minimum.x[k] - far, reached.minimum.x[k] + far];
        let within = bend > 0.0 && worse > 0.0 && places.iter().all(|place| (0.0..=1.0).contains(place));
        within.then(|| places.map(|place| span.value(place)))
    }

    /// Returns the second derivatives of the figure itself, with respect to numbers or their logarithms.
    pub fn curvature(&self, problem: &OptimizationProblem, reached: &OptimizationOutcome) -> Curvature {
        let per = |k: usize| {
            let span = &problem.spans[k];
            match span.logarithmic() {
                true => (span.high / span.low).ln(),
                false => span.high - span.low,
            }
        };
        let scale = problem.goal.sign() * reached.sizes[0];
        let row = |i: usize| {
            let of = |j: usize| scale * self.matrix[(i, j)] / per(self.free[i]) / per(self.free[j]);
            (0..self.free.len()).map(of).collect()
        };
        Curvature {
            pointers: self.free.iter().map(|k| problem.spans[*k].pointer.clone()).collect(),
            matrix: (0..self.free.len()).map(row).collect(),
        }
    }
}
