//! Optimal choice of the bladders to measure.

use nalgebra::{DMatrix, DVector};

use crate::numerics::bayesian_least_squares::{Observability, Posterior, ReducedProblem};

/// Criterion for a set of sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// Sum of the variances of the amplitudes, each over its size (A-optimal).
    #[default]
    Variances,
    /// Volume of the confidence region of the amplitudes (D-optimal).
    Volume,
}

/// A set of sensors.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorSet {
    /// Rows of the matrix, ascending.
    pub sensors: Vec<usize>,
    /// Standard error of each unknown for data of deviation 1; none if the data do not determine it by itself.
    pub errors: Vec<Option<f64>>,
}

/// Relative improvement required to replace a set; among equally good sets the first remains.
const BETTER: f64 = 1e-9;

/// Best sets of k rows of J, for k from the number of unknowns on. Adds the row that improves the criterion most, then exchanges rows as
/// long as that improves it:
///
/// ```text
/// A: tr (J_k^T J_k + R^T R)^-1 least        D: det (J_k^T J_k + R^T R) largest
/// ```
///
/// `before` are the rows R of the prior. The number of determined directions counts first, the criterion second.
pub fn choose(matrix: &DMatrix<f64>, before: &DMatrix<f64>, criterion: Criterion) -> Vec<SensorSet> {
    let rank_before = before.nrows();
    let least = matrix.ncols().saturating_sub(rank_before).max(1);
    let mut sensors: Vec<usize> = vec![];
    let mut all = vec![];
    for count in 1..=matrix.nrows() {
        // a pressure that no load changes, such as that of a bladder that does not exist, is no sensor
        let sees = |row: &usize| matrix.row(*row).amax() > 0.0;
        let open: Vec<usize> = (0..matrix.nrows())
            .filter(|row| !sensors.contains(row) && sees(row))
            .collect();
        let with = |row: usize| sensors.iter().copied().chain([row]).collect::<Vec<_>>();
        let Some(best) = best_of(open.into_iter().map(with), matrix, before, criterion) else {
            break;
        };
        sensors = exchanged(best, matrix, before, criterion);
        if count >= least {
            let mut chosen = sensors.clone();
            chosen.sort_unstable();
            let alone = Observability::from_matrix(&rows_of(&chosen, matrix, before)).alone;
            let spread = posterior(&chosen, matrix, before).spread;
            let error = |k: usize| alone[k].then(|| spread[(k, k)].max(0.0).sqrt());
            all.push(SensorSet {
                errors: (0..matrix.ncols()).map(error).collect(),
                sensors: chosen,
            });
        }
    }
    all
}

/// Rows of a set of sensors, followed by those of the prior.
fn rows_of(set: &[usize], matrix: &DMatrix<f64>, before: &DMatrix<f64>) -> DMatrix<f64> {
    let m = set.len();
    DMatrix::from_fn(m + before.nrows(), matrix.ncols(), |i, j| {
        if i < m { matrix[(set[i], j)] } else { before[(i - m, j)] }
    })
}

fn posterior(set: &[usize], matrix: &DMatrix<f64>, before: &DMatrix<f64>) -> Posterior {
    let rows = rows_of(set, matrix, before);
    let right = DVector::zeros(rows.nrows());
    ReducedProblem::new(rows, right).posterior(&DMatrix::zeros(0, matrix.ncols()))
}

/// Number of undetermined directions, and the criterion; both are minimized.
fn cost(rows: &[usize], matrix: &DMatrix<f64>, before: &DMatrix<f64>, criterion: Criterion) -> (usize, f64) {
    let posterior = posterior(rows, matrix, before);
    let size = match criterion {
        Criterion::Variances => posterior.spread.trace().ln(),
        Criterion::Volume => -posterior.log_determinant,
    };
    (matrix.ncols() - posterior.rank, size)
}

fn better(a: (usize, f64), b: (usize, f64)) -> bool {
    a.0 < b.0 || a.0 == b.0 && a.1 < b.1 - BETTER
}

fn best_of(
    sets: impl Iterator<Item = Vec<usize>>,
    matrix: &DMatrix<f64>,
    before: &DMatrix<f64>,
    criterion: Criterion,
) -> Option<Vec<usize>> {
    let judged = sets.map(|set| (cost(&set, matrix, before, criterion), set));
    judged
        .reduce(|best, next| if better(next.0, best.0) { next } else { best })
        .map(|best| best.1)
}

/// Exchanges single rows of the set as long as that improves it.
fn exchanged(mut set: Vec<usize>, matrix: &DMatrix<f64>, before: &DMatrix<f64>, criterion: Criterion) -> Vec<usize> {
    let rows = matrix.nrows();
    for _ in 0..rows {
        let now = cost(&set, matrix, before, criterion);
        let own = set.clone();
        let swaps = (0..own.len()).flat_map(|k| {
            let own = &own;
            let open = (0..rows).filter(|row| !own.contains(row));
            open.map(move |row| {
                let mut other = own.clone();
                other[k] = row;
                other
            })
        });
        match best_of(swaps, matrix, before, criterion) {
            Some(other) if better(cost(&other, matrix, before, criterion), now) => set = other,
            _ => break,
        }
    }
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: exhaustive search of all sets of three of twelve rows.
    #[test]
    fn sets_are_the_best_of_all() {
        let matrix = DMatrix::from_fn(12, 3, |i, j| {
            let x = i as f64 / 11.0;
            [1.0 - x, (1.0 - x).powi(2), 0.3 + (5.0 * x).sin()][j]
        });
        let none = DMatrix::zeros(0, 3);
        for criterion in [Criterion::Variances, Criterion::Volume] {
            let found = choose(&matrix, &none, criterion);
            assert_eq!(found.len(), 10);
            let mut best = (usize::MAX, f64::INFINITY);
            for a in 0..12 {
                for b in a + 1..12 {
                    for c in b + 1..12 {
                        let own = cost(&[a, b, c], &matrix, &none, criterion);
                        best = if better(own, best) { own } else { best };
                    }
                }
            }
            let own = cost(&found[0].sensors, &matrix, &none, criterion);
            assert!(!better(best, own), "{criterion:?}: {own:?}, not {best:?}");
            let sum = |k: usize| found[k].errors.iter().flatten().sum::<f64>();
            let falls = |k: usize| sum(k + 1) < sum(k);
            assert!((0..9).all(falls), "{found:?}");
        }
    }
}
