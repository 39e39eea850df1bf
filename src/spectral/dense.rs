//! All finite eigenvalues of a small pencil.

use nalgebra::{Complex, DMatrix};

use super::krylov::{FINITE, Vectors, combined};
use super::pencil::Shifted;
use super::{Failure, schur};

/// Eigenvalues and vectors, nearest the shift first.
pub(super) fn pairs(shifted: &mut Shifted) -> Result<Vectors, Failure> {
    let n = shifted.differential.len();
    let mut k = DMatrix::zeros(n, n);
    let mut unit = vec![Complex::default(); n];
    let mut column = unit.clone();
    for j in 0..n {
        unit[j] = Complex::new(1.0, 0.0);
        shifted.apply(&unit, &mut column);
        k.column_mut(j).copy_from_slice(&column);
        unit[j] = Complex::default();
    }
    let slow = Failure::Slow {
        converged: 0,
        restarts: 0,
    };
    let (q, t) = schur::ordered(k).ok_or(slow)?;
    let basis: Vec<Vec<_>> = q.column_iter().map(|c| c.iter().copied().collect()).collect();
    let largest = t[(0, 0)].norm();
    let finite = (0..n).take_while(|&k| t[(k, k)].norm() > FINITE * largest).count();
    Ok((0..finite)
        .map(|k| {
            let x = combined(&basis, &schur::vector(&t, k));
            (shifted.shift - t[(k, k)].inv(), shifted.whole(&x).to_vec())
        })
        .collect())
}
