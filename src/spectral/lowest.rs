//! The lowest eigenvalues of a static tangent, cheaply.

use nalgebra::Complex;

use super::{SpectralError, pencil::failure};
use crate::numerics::krylov;
use crate::sparse::{Klu, Pattern};

/// Vectors of the space; eigenvalues of a beam lie so far apart (β⁴) that its first ones are found to round-off.
const SPACE: usize = 24;
/// Eigenvalues count as found whose residual is below this part of them.
const FOUND: f64 = 1e-4;

/// Eigenvalues μ of `K x = μ D x`, D a diagonal without negative entries, of least magnitude first: the first of those that
/// Arnoldi's method finds on `√D K⁻¹ √D`. Entries of `k` in the order of the pattern.
///
/// # Errors
/// [`SpectralError::Singular`] at an eigenvalue of zero, [`SpectralError::NotFinite`].
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
    // of a complex pair one is told
    let both = settled.flat_map(|of| [Some(of.value), (of.value.im != 0.0).then(|| of.value.conj())]);
    Ok(both.flatten().map(|theta| theta.inv()).collect())
}
