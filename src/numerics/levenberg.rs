//! Bounded nonlinear least squares: the Levenberg-Marquardt method with projected steps.
//!
//! ```text
//! min |r(x)|²,  0 <= x <= 1
//! (J^T J + λ D²) d = -J^T r        of what is not held at a bound; D the largest lengths of the columns of J so far (Moré, 1978)
//! x+ = P(x + d)                    taken where |r|² falls by a part of what J foretells; λ after Nielsen (1999)
//! ```
//!
//! The crate `levenberg-marquardt` supports neither bounds nor points without residuals, such as a failed simulation;
//! here such a step is shortened. The search ends where a Gauss-Newton step would change predicted values by less than
//! 1e-4 of the standard deviation of the residuals (Bates & Watts, 1981).

use nalgebra::{DMatrix, DVector};

/// Residuals and their derivatives at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualEvaluation {
    /// Residuals, n of them.
    pub residuals: DVector<f64>,
    /// Jacobian: n rows, one column per parameter.
    pub jacobian: DMatrix<f64>,
}

impl ResidualEvaluation {
    /// Sum of squared residuals.
    pub fn cost(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevenbergStatus {
    /// Converged to a minimum, to the accuracy of the data.
    Found,
    /// No step lowers the sum, although the derivatives predict it: they are inaccurate.
    Stuck,
    /// Reached the limit of steps.
    Unfinished,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct LevenbergMinimum {
    /// Parameters.
    pub x: Vec<f64>,
    /// Residuals and Jacobian there.
    pub at: ResidualEvaluation,
    /// Outcome of the search.
    pub ended: LevenbergStatus,
    /// Number of accepted steps.
    pub steps: usize,
    /// Number of evaluations.
    pub evaluations: usize,
}

/// Relative offset at which a search ends.
const OFFSET: f64 = 1e-4;
/// Relative offset accepted as converged when simulation errors prevent further steps.
const CLOSE: f64 = 0.05;
/// Step size below which a search ends.
const STEP: f64 = 1e-11;
/// Smallest accepted ratio of actual to predicted reduction.
const WORTH: f64 = 1e-4;
/// Initial damping relative to the column lengths.
const DAMPING: f64 = 1e-3;
/// Largest damping; beyond it no step remains.
const MOST_DAMPING: f64 = 1e12;
/// Share of the largest singular value below which others count as zero.
const NOTHING: f64 = 1e-10;

/// Function that evaluates residuals and Jacobian at a point; none if the point has no residuals.
pub type EvaluateResiduals<'a, E> = dyn FnMut(&[f64]) -> Result<Option<ResidualEvaluation>, E> + 'a;

/// Searches from a start. Where `evaluate` returns none, the step is shortened. Returns none if the start has no
/// residuals.
///
/// # Errors
/// Returns the first error of `evaluate`.
pub fn minimise<E>(
    start: &[f64],
    most_steps: usize,
    evaluate: &mut EvaluateResiduals<E>,
) -> Result<Option<LevenbergMinimum>, E> {
    let mut x: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
    let Some(mut at) = evaluate(&x)? else {
        return Ok(None);
    };
    let (mut steps, mut evaluations) = (0, 1);
    let (mut damping, mut growth) = (DAMPING, 2.0);
    let mut lengths = vec![0.0_f64; x.len()];
    let ended = loop {
        if settled(&x, &at, OFFSET) {
            break LevenbergStatus::Found;
        }
        if steps >= most_steps {
            break LevenbergStatus::Unfinished;
        }
        if damping > MOST_DAMPING {
            break stopped(&x, &at);
        }
        for (length, column) in lengths.iter_mut().zip(at.jacobian.column_iter()) {
            *length = length.max(column.norm());
        }
        let step = damped(&x, &at, &lengths, damping);
        let to: Vec<f64> = x.iter().zip(&step).map(|(x, d)| (x + d).clamp(0.0, 1.0)).collect();
        let moved = DVector::from_iterator(x.len(), to.iter().zip(&x).map(|(to, x)| to - x));
        let foretold = at.cost() - (&at.residuals + &at.jacobian * &moved).norm_squared();
        if moved.amax() < STEP {
            break if damping <= DAMPING {
                LevenbergStatus::Found
            } else {
                stopped(&x, &at)
            };
        }
        let there = evaluate(&to)?;
        evaluations += 1;
        let gain = there
            .as_ref()
            .map_or(-1.0, |there| (at.cost() - there.cost()) / foretold);
        match there {
            Some(there) if foretold > 0.0 && gain > WORTH => {
                (x, at) = (to, there);
                steps += 1;
                damping = (damping * (1.0 - (2.0 * gain - 1.0).powi(3)).max(1.0 / 3.0)).max(1e-15);
                growth = 2.0;
            }
            _ => {
                damping *= growth;
                growth *= 2.0;
            }
        }
    };
    Ok(Some(LevenbergMinimum {
        x,
        at,
        ended,
        steps,
        evaluations,
    }))
}

/// Indices of parameters that are not held at a bound by the gradient.
pub fn free(x: &[f64], at: &ResidualEvaluation) -> Vec<usize> {
    let slope = at.jacobian.tr_mul(&at.residuals);
    let held = |k: &usize| (x[*k] <= 0.0 && slope[*k] >= 0.0) || (x[*k] >= 1.0 && slope[*k] <= 0.0);
    (0..x.len()).filter(|k| !held(k)).collect()
}

/// Gauss-Newton step of least norm.
pub fn newton(jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> DVector<f64> {
    if jacobian.is_empty() {
        return DVector::zeros(jacobian.ncols());
    }
    let svd = jacobian.clone().svd(true, true);
    let least = NOTHING * svd.singular_values.iter().copied().fold(0.0, f64::max);
    let step = svd.solve(residuals, least.max(f64::MIN_POSITIVE));
    step.map_or_else(|_| DVector::zeros(jacobian.ncols()), |step| -step)
}

/// Outcome of a search that no step can continue.
fn stopped(x: &[f64], at: &ResidualEvaluation) -> LevenbergStatus {
    match settled(x, at, CLOSE) {
        true => LevenbergStatus::Found,
        false => LevenbergStatus::Stuck,
    }
}

fn settled(x: &[f64], at: &ResidualEvaluation, least: f64) -> bool {
    let free = free(x, at);
    if free.is_empty() || at.cost() == 0.0 {
        return true;
    }
    let own = at.jacobian.select_columns(&free);
    let step = newton(&own, &at.residuals);
    // limited by the bounds
    let step = DVector::from_iterator(
        free.len(),
        free.iter()
            .zip(step.iter())
            .map(|(k, d)| (x[*k] + d).clamp(0.0, 1.0) - x[*k]),
    );
    let foretold = (&own * &step).norm_squared();
    let freedom = at.residuals.len().saturating_sub(free.len());
    let spread = at.cost() / freedom.max(1) as f64;
    let offset = (foretold / free.len() as f64 / spread).sqrt();
    step.amax() < STEP || (freedom > 0 && offset < least)
}

/// Damped step by QR factorization of `J` stacked on `√λ D`.
fn damped(x: &[f64], at: &ResidualEvaluation, lengths: &[f64], damping: f64) -> Vec<f64> {
    let free = free(x, at);
    let (n, m) = (at.residuals.len(), free.len());
    let mut step = vec![0.0; x.len()];
    if m == 0 {
        return step;
    }
    let longest = lengths.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mut matrix = DMatrix::zeros(n + m, m);
    let mut right = DVector::zeros(n + m);
    for (column, k) in free.iter().enumerate() {
        matrix.view_mut((0, column), (n, 1)).copy_from(&at.jacobian.column(*k));
        // a parameter without effect is not moved
        matrix[(n + column, column)] = damping.sqrt() * lengths[*k].max(NOTHING * longest);
    }
    right.rows_mut(0, n).copy_from(&(-&at.residuals));
    let (q, r) = matrix.qr().unpack();
    if let Some(solved) = r.solve_upper_triangular(&q.tr_mul(&right)) {
        for (k, d) in free.iter().zip(solved.iter()) {
            step[*k] = if d.is_finite() { *d } else { 0.0 };
        }
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn search(start: &[f64], of: impl Fn(&[f64]) -> Option<ResidualEvaluation>) -> LevenbergMinimum {
        let found = minimise::<Infallible>(start, 200, &mut |x| Ok(of(x)));
        let Ok(found) = found;
        found.expect("a start")
    }

    /// Source: Rosenbrock (1960), whose valley ends at (1, 1), here 0.5 in both. A second case has points without
    /// residuals.
    #[test]
    fn valleys_are_followed_to_their_end() {
        let rosenbrock = |x: &[f64]| {
            let [a, b] = [4.0 * x[0] - 1.0, 4.0 * x[1] - 1.0];
            ResidualEvaluation {
                residuals: DVector::from_vec(vec![10.0 * (b - a * a), 1.0 - a]),
                jacobian: DMatrix::from_row_slice(2, 2, &[-80.0 * a, 40.0, -4.0, 0.0]),
            }
        };
        let found = search(&[0.0, 0.9], |x| Some(rosenbrock(x)));
        assert!(
            found.ended == LevenbergStatus::Found && found.at.cost() < 1e-18,
            "{found:?}"
        );
        let found = search(&[0.0, 0.9], |x| (x[0] < 0.55).then(|| rosenbrock(x)));
        assert!(found.at.cost() < 1e-18 && found.evaluations < 100, "{found:?}");
    }

    /// Goal: a parameter that would leave its bounds stays at a bound, and the other one is optimal there.
    #[test]
    fn bounds_hold() {
        let line = |x: &[f64]| ResidualEvaluation {
            residuals: DVector::from_vec(vec![x[0] + 0.5, x[0] + x[1] - 0.25, 0.1]),
            jacobian: DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 1.0, 1.0, 0.0, 0.0]),
        };
        let found = search(&[0.7, 0.9], |x| Some(line(x)));
        assert_eq!(found.x[0], 0.0);
        assert!((found.x[1] - 0.25).abs() < 1e-4, "{found:?}");
        assert_eq!(free(&found.x, &found.at), [1]);
    }

    #[test]
    fn what_nothing_depends_on_stays() {
        let line = |x: &[f64]| ResidualEvaluation {
            residuals: DVector::from_vec(vec![x[0] - 0.3, 2.0 * x[0] - 0.6, 0.01]),
            jacobian: DMatrix::from_row_slice(3, 2, &[1.0, 0.0, 2.0, 0.0, 0.0, 0.0]),
        };
        let found = search(&[0.7, 0.9], |x| Some(line(x)));
        assert!(
            (found.x[0] - 0.3).abs() < 1e-5 && (found.x[1] - 0.9).abs() < 1e-6,
            "{found:?}"
        );
    }
}
