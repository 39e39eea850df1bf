//! Refinement of single eigenpairs, with error bounds.

use nalgebra::Complex;

use super::krylov::unit;
use super::pencil::Shifted;
use super::{EigenPair, SpectralError};

type C = Complex<f64>;

/// Rounding errors of one row of a residual, in units of the last place.
const ROUNDINGS: f64 = 4.0;

/// `[E34]` One step of inverse iteration on either side with factors at s, followed by the two-sided quotient (Ostrowski), which
/// converges cubically. The bound is the first-order change of s by the remaining residual, including its rounding error:
///
/// ```text
/// x ← (A + s B)⁻¹ B x        y = (A + s B)⁻ᴴ x        s ← s - yᴴ (A + s B) x / yᴴ B x
/// |δs| ≤ Σᵢ |yᵢ| [|(A + s B) x| + 4 ε (|A| |x| + |s| |B| |x|)]ᵢ / |yᴴ B x|
/// ```
///
/// With x on the right-hand side, y belongs to the eigenvalue's whole left space, so repeated eigenvalues are harmless.
/// For defective eigenvalues, such as those of rigid motions, `yᴴ B x` is small and the bound as large as the error.
pub(super) fn refine(shifted: &mut Shifted, s: C, x: Vec<C>) -> Result<EigenPair, SpectralError> {
    let pencil = shifted.pencil;
    let first = assess(shifted, s, unit(x))?;
    // solutions with a nearly singular matrix are huge: only their direction matters
    let (_, mut x) = pencil.products(&first.x);
    shifted.solve(&mut x);
    if x.iter().any(|x| !x.is_finite()) {
        return Ok(first);
    }
    let second = assess(shifted, first.s, unit(x))?;
    Ok(if second.error < first.error { second } else { first })
}

/// Computes the quotient and the error bound for a vector.
fn assess(shifted: &mut Shifted, s: C, x: Vec<C>) -> Result<EigenPair, SpectralError> {
    let pencil = shifted.pencil;
    shifted.factor(s)?;
    let mut y = x.clone();
    shifted.solve_adjoint(&mut y);
    let (ax, bx) = pencil.products(&x);
    let dot = |a: &[C]| y.iter().zip(a).map(|(y, a)| y.conj() * a).sum::<C>();
    let weight = dot(&bx);
    let quotient = -dot(&ax) / weight;
    let s = if quotient.is_finite() { quotient } else { s };
    let magnitude = pencil.magnitude(s, &x);
    let residual: Vec<f64> = ax.iter().zip(&bx).map(|(a, b)| (a + b * s).norm()).collect();
    let moved: f64 = y
        .iter()
        .zip(residual.iter().zip(&magnitude))
        .map(|(y, (r, m))| y.norm() * (r + ROUNDINGS * f64::EPSILON * m))
        .sum();
    let length = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    let error = moved / weight.norm();
    Ok(EigenPair {
        s,
        x,
        left: y,
        residual: length(&residual) / length(&magnitude).max(f64::MIN_POSITIVE),
        error: if error.is_finite() { error } else { f64::INFINITY },
    })
}
