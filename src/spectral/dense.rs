//! All finite eigenvalues of a small pencil.

use nalgebra::Complex;
use slcbeam_dense::eigen;

use super::SpectralError;
use super::krylov::{FINITE, RotatedVectors};
use super::pencil::Shifted;
use crate::integrate::halt;

/// Eigenvalues and eigenvectors, nearest the shift first.
pub(super) fn pairs(shifted: &mut Shifted) -> Result<RotatedVectors, SpectralError> {
    let n = shifted.differential.len();
    let mut columns = vec![vec![Complex::default(); n]; n];
    let mut axis = vec![Complex::default(); n];
    for (j, column) in columns.iter_mut().enumerate() {
        if halt::asked() {
            return Err(SpectralError::Interrupted);
        }
        axis[j] = Complex::new(1.0, 0.0);
        shifted.apply(&axis, column);
        axis[j] = Complex::default();
    }
    let mut all = eigen(n, &|i, j| columns[j][i]).ok_or(SpectralError::Slow {
        converged: 0,
        restarts: 0,
    })?;
    let largest = all.first().map_or(0.0, |(theta, _)| theta.norm());
    all.retain(|(theta, _)| theta.norm() > FINITE * largest);
    for (theta, x) in &mut all {
        *x = shifted.whole(x).to_vec();
        *theta = shifted.shift - theta.inv();
    }
    Ok(all)
}
