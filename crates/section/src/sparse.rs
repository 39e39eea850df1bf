//! Sparse symmetric systems by faer's Cholesky factorization with a fill-reducing ordering.

use crate::error::Error;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{Argsort, Pair, SparseColMat, SymbolicSparseColMat};
use faer::{Mat, Side};

/// Sparsity pattern of matrices, with elimination order and fill.
pub struct Pattern {
    n: usize,
    matrix: SymbolicSparseColMat<usize>,
    order: Argsort<usize>,
    factor: SymbolicLlt<usize>,
}

impl Pattern {
    /// Pattern from entries (row, column, value) of the lower triangle.
    pub fn new(n: usize, entries: &[(usize, usize, f64)]) -> Result<Self, Error> {
        let places: Vec<_> = entries.iter().map(|&(row, col, _)| Pair { row, col }).collect();
        let (matrix, order) = SymbolicSparseColMat::try_new_from_indices(n, n, &places).map_err(|_| Error::Singular)?;
        let factor = SymbolicLlt::try_new(matrix.as_ref(), Side::Lower).map_err(|_| Error::Singular)?;
        Ok(Self {
            n,
            matrix,
            order,
            factor,
        })
    }

    /// Factorizes a matrix from entries with equal positions in equal order; entries at one position add up.
    pub fn factor(&self, entries: &[(usize, usize, f64)]) -> Result<Factor, Error> {
        let values: Vec<f64> = entries.iter().map(|entry| entry.2).collect();
        let matrix = SparseColMat::new_from_argsort(self.matrix.clone(), &self.order, &values);
        let matrix = matrix.map_err(|_| Error::Singular)?;
        let factor = Llt::try_new_with_symbolic(self.factor.clone(), matrix.as_ref(), Side::Lower);
        Ok(Factor {
            n: self.n,
            factor: factor.map_err(|_| Error::Singular)?,
        })
    }
}

/// A factorized positive definite matrix.
pub struct Factor {
    n: usize,
    factor: Llt<usize, f64>,
}

impl Factor {
    /// Factorizes a matrix from entries (row, column, value) of the lower triangle; entries at one position add up.
    pub fn new(n: usize, entries: &[(usize, usize, f64)]) -> Result<Self, Error> {
        Pattern::new(n, entries)?.factor(entries)
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
