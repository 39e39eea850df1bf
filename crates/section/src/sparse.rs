//! Sparse symmetric systems, by faer's Cholesky factorisation with a fill-reducing ordering.

use crate::error::Error;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

/// A factorised positive definite matrix.
pub struct Factor {
    n: usize,
    factor: Llt<usize, f64>,
}

impl Factor {
    /// Factorises from entries (row, column, value) of the lower triangle; those with the same place add up.
    pub fn new(n: usize, entries: &[(usize, usize, f64)]) -> Result<Self, Error> {
        let triplets: Vec<_> = entries
            .iter()
            .map(|&(row, col, val)| Triplet { row, col, val })
            .collect();
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &triplets).map_err(|_| Error::Singular)?;
        let symbolic = SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).map_err(|_| Error::Singular)?;
        let factor = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower).map_err(|_| Error::Singular)?;
        Ok(Self { n, factor })
    }

    /// Solutions for several right-hand sides, each of length n.
    pub fn solve(&self, sides: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut x = Mat::from_fn(self.n, sides.len(), |i, j| sides[j][i]);
        self.factor.solve_in_place(x.as_mut());
        (0..sides.len())
            .map(|j| (0..self.n).map(|i| x[(i, j)]).collect())
            .collect()
    }
}
