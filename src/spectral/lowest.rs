//! Lowest eigenvalues of a static tangent, by a short Arnoldi iteration.

use nalgebra::Complex;

use super::{SpectralError, pencil::failure};
use crate::numerics::krylov;
use crate::sparse::{Klu, Pattern};

/// Dimension of the Krylov space; eigenvalues of a beam are so far apart (β⁴) that its first ones are exact to rounding
/// error.
const SPACE: usize = 24;
/// Relative residual below which an eigenvalue counts as converged.
const FOUND: f64 = 1e-4;

/// Eigenvalues μ of `K x = μ D x`, smallest magnitude first; D is a diagonal without negative entries. Returns the first ones, found by
/// Arnoldi's method for `√D K⁻¹ √D`. Entries of `k` are in the order of the pattern.
///
/// # Errors
/// [`SpectralError::Singular`] for an eigenvalue of zero, [`SpectralError::NotFinite`].
pub fn lowest(pattern: &Pattern, k: &[f64], d: &[f64]) -> Result<Vec<Complex<f64>>, SpectralError> {
    if k.iter().any(|k| !k.is_finite()) {
        return Err(SpectralError::NotFinite);
    }
    let mut klu = Klu::new(pattern).map_err(failure)?;
    klu.factor(k).map_err(failure)?;
    let root: Vec<f64> = d.iter().map(|d| d.sqrt()).collect();
    let weigh = |v: &mut [f64]| v.iter_mut().zip(&root).for_each(|(v, root)| *v *= root);
    let apply = |v: &mut [f64]| {
        weigh(v);
        klu.solve(v);
        weigh(v);
    };
    let mut start = krylov::everything(d.len());
    weigh(&mut start);
    let found = krylov::largest(apply, &start, SPACE, 0.0, SPACE);
    if found.iter().any(|of| !of.residual.is_finite()) {
        return Err(SpectralError::NotFinite);
    }
    let settled = found.iter().filter(|of| of.residual < FOUND * of.value.norm());
    // the Krylov method returns one eigenvalue of each complex pair
    let both = settled.flat_map(|of| [Some(of.value), (of.value.im != 0.0).then(|| of.value.conj())]);
    Ok(both.flatten().map(|theta| theta.inv()).collect())
}
