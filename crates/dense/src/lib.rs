//! Eigenvalues of dense matrices by faer.
//!
//! faer is generic: its callers compile it. Here this happens once. In the main program, at its optimization level, it
//! took more than a minute of one core after every change.

use faer::{Mat, c64};

/// Eigenvalues of an n × n matrix, largest modulus first, each with a unit vector; repeated ones are listed with their
/// multiplicity. None if an entry is not finite or the iteration does not converge.
pub fn eigen(n: usize, entry: &dyn Fn(usize, usize) -> c64) -> Option<Vec<(c64, Vec<c64>)>> {
    let found = Mat::from_fn(n, n, entry).eigen().ok()?;
    let values = found.S().column_vector().iter().copied();
    let vectors = found.U().col_iter().map(|x| {
        let length = x.norm_l2();
        x.iter().map(|x| x / length).collect()
    });
    let mut all: Vec<(c64, Vec<c64>)> = values.zip(vectors).collect();
    all.sort_by(|a, b| b.0.norm().total_cmp(&a.0.norm()));
    Some(all)
}

/// Eigenvalues of a real n × n matrix, without vectors and unordered; repeated ones are listed with their multiplicity.
/// None as for [`eigen`].
pub fn real_eigenvalues(n: usize, entry: &dyn Fn(usize, usize) -> f64) -> Option<Vec<c64>> {
    Mat::from_fn(n, n, entry).eigenvalues().ok()
}
