//! Bayesian linear least squares for problems that the data may not determine.
//!
//! ```text
//! b = A x + e        e normal, deviation 1        what is known of x before: R x normal, deviation 1/w
//! x = argmin |b - A x|^2 + w^2 |R x|^2        cov x = (A^T A + w^2 R^T R)^-1
//! ```

use nalgebra::{DMatrix, DVector};

/// Share of the largest singular value below which others count as zero; derivatives are exact to about 1e-10.
const NOTHING: f64 = 1e-8;

/// Shares below this are rounding errors.
const ALIKE: f64 = 1e-6;

/// A linear problem, reduced to as many rows as unknowns.
#[derive(Clone, Debug)]
pub struct ReducedProblem {
    a: DMatrix<f64>,
    b: DVector<f64>,
    /// Part of `|b|^2` that no x explains.
    left: f64,
    /// Number of rows before the reduction.
    pub rows: usize,
}

/// Posterior distribution of the unknowns.
#[derive(Clone, Debug)]
pub struct Posterior {
    /// Mean; the solution of least norm in undetermined directions.
    pub x: DVector<f64>,
    /// Covariance for data with unit standard deviation; zero in undetermined directions.
    pub spread: DMatrix<f64>,
    /// `|b - A x|^2`.
    pub misfit: f64,
    /// `w^2 |R x|^2`.
    pub rough: f64,
    /// Logarithm of the determinant of `A^T A + w^2 R^T R`, over the determined directions.
    pub log_determinant: f64,
    /// Number of determined directions of x.
    pub rank: usize,
}

impl ReducedProblem {
    /// Problem of rows with errors of unit standard deviation.
    pub fn new(a: DMatrix<f64>, b: DVector<f64>) -> Self {
        let rows = a.nrows();
        if rows <= a.ncols() {
            return Self { a, b, left: 0.0, rows };
        }
        let whole = b.norm_squared();
        let (q, r) = a.qr().unpack();
        let b = q.transpose() * b;
        let left = (whole - b.norm_squared()).max(0.0);
        Self { a: r, b, left, rows }
    }

    /// Posterior with the prior rows `w R`; no rows without prior.
    pub fn posterior(&self, before: &DMatrix<f64>) -> Posterior {
        let (m, k, n) = (self.a.nrows(), before.nrows(), self.a.ncols());
        let mut whole = DMatrix::zeros(m + k, n);
        whole.rows_mut(0, m).copy_from(&self.a);
        whole.rows_mut(m, k).copy_from(before);
        let mut right = DVector::zeros(m + k);
        right.rows_mut(0, m).copy_from(&self.b);
        let Pieces { values, u, v } = Pieces::decompose(whole);
        let (mut x, mut spread) = (DVector::zeros(n), DMatrix::zeros(n, n));
        for (j, value) in values.iter().enumerate() {
            x += v.column(j) * (u.column(j).dot(&right) / value);
            spread += v.column(j) * v.column(j).transpose() / (value * value);
        }
        let misfit = self.left + (&self.a * &x - &self.b).norm_squared();
        let rough = (before * &x).norm_squared();
        Posterior {
            x,
            spread,
            misfit,
            rough,
            log_determinant: values.iter().map(|s| 2.0 * s.ln()).sum(),
            rank: values.len(),
        }
    }
}

/// Nonzero singular values with their vectors.
struct Pieces {
    values: Vec<f64>,
    u: DMatrix<f64>,
    v: DMatrix<f64>,
}

impl Pieces {
    fn decompose(matrix: DMatrix<f64>) -> Self {
        let (rows, columns) = matrix.shape();
        let svd = matrix.svd(true, true);
        let (u, v) = (svd.u.unwrap_or_default(), svd.v_t.unwrap_or_default().transpose());
        let largest = svd.singular_values.max();
        let kept: Vec<usize> = (0..svd.singular_values.len())
            .filter(|k| svd.singular_values[*k] > NOTHING * largest)
            .collect();
        let of = |from: &DMatrix<f64>, rows| DMatrix::from_fn(rows, kept.len(), |i, j| from[(i, kept[j])]);
        Self {
            values: kept.iter().map(|k| svd.singular_values[*k]).collect(),
            u: of(&u, rows),
            v: of(&v, columns),
        }
    }
}

/// Observability of unknowns by the rows of a matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct Observability {
    /// Nonzero singular values, largest first.
    pub values: Vec<f64>,
    /// Independent observable combinations of unknowns, in reduced form: each has a 1 where the others have 0.
    pub observable: Vec<Vec<f64>>,
    /// Independent unobservable combinations of unknowns, in reduced form.
    pub blind: Vec<Vec<f64>>,
    /// For each unknown, true if it is observable alone.
    pub alone: Vec<bool>,
    /// Projector onto the observable subspace.
    projector: DMatrix<f64>,
}

impl Observability {
    /// Observability by the rows of a matrix, for unknowns of comparable size.
    pub fn from_matrix(matrix: &DMatrix<f64>) -> Self {
        let n = matrix.ncols();
        let Pieces { mut values, v, .. } = Pieces::decompose(matrix.clone());
        values.sort_by(|a, b| b.total_cmp(a));
        let projector = &v * v.transpose();
        let observable = echelon(v.transpose());
        let rest = DMatrix::identity(n, n) - &projector;
        // the eigenvectors of the remainder with nonzero eigenvalue span the unobservable subspace
        let blind = match n - values.len() {
            0 => vec![],
            _ => echelon(Pieces::decompose(rest).v.transpose()),
        };
        let alone = (0..n).map(|k| projector[(k, k)] > 1.0 - ALIKE).collect();
        Self {
            values,
            observable,
            blind,
            alone,
            projector,
        }
    }

    /// True if a combination of unknowns is observable.
    pub fn observes(&self, factors: &[f64]) -> bool {
        let whole = DVector::from_column_slice(factors);
        (&self.projector * &whole - &whole).norm_squared() < ALIKE * whole.norm_squared()
    }
}

/// Reduced rows with the same span, by full pivoting: each has a 1 where the others have 0, and no large entries.
fn echelon(mut rows: DMatrix<f64>) -> Vec<Vec<f64>> {
    let mut pivots: Vec<usize> = vec![];
    for next in 0..rows.nrows() {
        let open = (next..rows.nrows()).flat_map(|row| (0..rows.ncols()).map(move |column| (row, column)));
        let open = open.filter(|place| !pivots.contains(&place.1));
        let Some((row, column)) = open.max_by(|a, b| rows[*a].abs().total_cmp(&rows[*b].abs())) else {
            break;
        };
        rows.swap_rows(row, next);
        let pivot = rows[(next, column)];
        rows.row_mut(next).scale_mut(1.0 / pivot);
        for other in (0..rows.nrows()).filter(|other| *other != next) {
            let factor = rows[(other, column)];
            let own = rows.row(next) * factor;
            rows.row_mut(other).zip_apply(&own, |x, y| *x -= y);
        }
        pivots.push(column);
    }
    let clean = |x: f64| if x.abs() < ALIKE { 0.0 } else { x };
    let mut all: Vec<(usize, Vec<f64>)> = pivots
        .iter()
        .enumerate()
        .map(|(k, pivot)| (*pivot, rows.row(k).iter().map(|x| clean(*x)).collect()))
        .collect();
    all.sort_by_key(|one| one.0);
    all.into_iter().map(|one| one.1).collect()
}

/// Second differences of neighbors, `x_{k-1} - 2 x_k + x_{k+1}`, one per row; no rows for fewer than three unknowns.
pub fn second_differences(count: usize) -> DMatrix<f64> {
    DMatrix::from_fn(count.saturating_sub(2), count, |row, column| {
        match column.checked_sub(row) {
            Some(0 | 2) => 1.0,
            Some(1) => -2.0,
            _ => 0.0,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: normal equations.
    #[test]
    fn the_mean_solves_the_normal_equations() {
        let a = DMatrix::from_fn(9, 4, |i, j| {
            ((i * i + 3 * j) as f64 * 0.37).sin() + f64::from(u8::from(i == j))
        });
        let b = DVector::from_fn(9, |i, _| (i as f64 * 0.9).cos());
        let r = second_differences(4) * 0.7;
        let found = ReducedProblem::new(a.clone(), b.clone()).posterior(&r);
        let normal = a.transpose() * &a + r.transpose() * &r;
        let off = &normal * &found.x - a.transpose() * &b;
        assert!(off.norm() < 1e-12, "{off}");
        let identity = &normal * &found.spread - DMatrix::identity(4, 4);
        assert!(identity.norm() < 1e-11, "{identity}");
        assert!((found.log_determinant - normal.determinant().ln()).abs() < 1e-11);
        assert!((found.misfit - (&a * &found.x - &b).norm_squared()).abs() < 1e-12);
        assert!((found.rough - (&r * &found.x).norm_squared()).abs() < 1e-13);
    }

    /// Goal: two unknowns with proportional effects are observable only in combination; a third one is observable
    /// alone.
    #[test]
    fn what_acts_alike_is_told_together() {
        let a = DMatrix::from_fn(5, 3, |i, j| match j {
            0 => 1.0 + i as f64,
            1 => 2.0 + 2.0 * i as f64,
            _ => (i as f64).powi(2),
        });
        let seen = Observability::from_matrix(&a);
        assert_eq!(seen.alone, [false, false, true]);
        let near = |a: &[Vec<f64>], b: &[&[f64]]| {
            a.len() == b.len()
                && a.iter()
                    .zip(b)
                    .all(|(a, b)| a.iter().zip(*b).all(|(a, b)| (a - b).abs() < 1e-9))
        };
        assert!(
            near(&seen.observable, &[&[0.5, 1.0, 0.0], &[0.0, 0.0, 1.0]]),
            "{:?}",
            seen.observable
        );
        assert!(near(&seen.blind, &[&[1.0, -0.5, 0.0]]), "{:?}", seen.blind);
        let whole = Observability::from_matrix(&DMatrix::identity(3, 3));
        assert_eq!((whole.alone, whole.blind.len()), (vec![true; 3], 0));
    }
}
