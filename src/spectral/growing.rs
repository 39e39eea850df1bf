//! Oscillations that grow: eigenvalues right of the imaginary axis.

use nalgebra::Complex;
use slcbeam_dense::real_eigenvalues;

use super::krylov::{FINITE, unit};
use super::pencil::Shifted;
use super::{AT_LAST_DENSE, EigenPair, Pencil, SpectralError, refine::refine};

/// Bounds on the eigenvalues of interest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest growth rate [1/s].
    pub rate: f64,
    /// Smallest angular frequency [1/s].
    pub frequency: f64,
    /// Largest number of eigenvalues.
    pub count: usize,
}

/// Ratio of a real part to its error bound above which its sign is certain.
const CERTAIN: f64 = 10.0;

/// Growing oscillations of a pencil, fastest growth first, one of each conjugate pair. All eigenvalues are computed in real arithmetic
/// with a real `shift` [1/s]; those within the bounds are refined. None if there are more than [`AT_LAST_DENSE`] differential unknowns.
///
/// # Errors
/// [`SpectralError`].
pub fn growing(pencil: &Pencil, shift: f64, bounds: &Bounds) -> Result<Option<Vec<EigenPair>>, SpectralError> {
    if !pencil.finite() {
        return Err(SpectralError::NotFinite);
    }
    let mut shifted = Shifted::new(pencil, Complex::new(shift, 0.0))?;
    let n = shifted.differential.len();
    if n > AT_LAST_DENSE {
        return Ok(None);
    }
    let mut axis = vec![Complex::default(); n];
    let mut column = axis.clone();
    let mut columns = Vec::with_capacity(n * n);
    for j in 0..n {
        axis[j] = Complex::new(1.0, 0.0);
        shifted.apply(&axis, &mut column);
        axis[j] = Complex::default();
        columns.extend(column.iter().map(|x| x.re));
    }
    let shift = shifted.shift.re;
    let all = real_eigenvalues(n, &|i, j| columns[j * n + i]).ok_or(SpectralError::NotFinite)?;
    let largest = all.iter().map(|theta| theta.norm()).fold(0.0, f64::max);
    let within = |s: &Complex<f64>| s.re >= bounds.rate && s.im >= bounds.frequency;
    let finite = all.iter().filter(|theta| theta.norm() > FINITE * largest);
    let mut found: Vec<_> = finite.map(|theta| shift - theta.inv()).filter(within).collect();
    found.sort_by(|a, b| b.re.total_cmp(&a.re));
    found.truncate(bounds.count);
    let mut pairs = Vec::with_capacity(found.len());
    for s in found {
        shifted.factor(s)?;
        axis.fill(Complex::new(1.0, 0.0));
        let x = unit(shifted.whole(&axis).to_vec());
        let pair = refine(&mut shifted, s, x)?;
        if within(&pair.s) && pair.s.re > CERTAIN * pair.error {
            pairs.push(pair);
        }
    }
    pairs.sort_by(|a, b| b.s.re.total_cmp(&a.s.re));
    Ok(Some(pairs))
}
