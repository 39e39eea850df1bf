//! Oscillations that grow: eigenvalues right of the imaginary axis.

use nalgebra::Complex;
use slcbeam_dense::real_eigenvalues;

use super::krylov::{FINITE, unit};
use super::pencil::{Shifted, factor_near, failure};
use super::{AT_LAST_DENSE, EigenPair, Pencil, SpectralError, refine::refine};
use crate::sparse::Lu;

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
    let differential = pencil.differential();
    if differential.len() > AT_LAST_DENSE {
        return Ok(None);
    }
    let within = |s: &Complex<f64>| s.re >= bounds.rate && s.im >= bounds.frequency;
    let mut found = eigenvalues(pencil, &differential, shift)?;
    found.retain(within);
    found.sort_by(|a, b| b.re.total_cmp(&a.re));
    found.truncate(bounds.count);
    let mut pairs = Vec::with_capacity(found.len());
    let Some(first) = found.first() else {
        return Ok(Some(pairs));
    };
    let mut shifted = Shifted::new(pencil, *first)?;
    let ones = vec![Complex::new(1.0, 0.0); differential.len()];
    for s in found {
        shifted.factor(s)?;
        let x = unit(shifted.whole(&ones).to_vec());
        let pair = refine(&mut shifted, s, x)?;
        if within(&pair.s) && pair.s.re > CERTAIN * pair.error {
            pairs.push(pair);
        }
    }
    pairs.sort_by(|a, b| b.s.re.total_cmp(&a.s.re));
    Ok(Some(pairs))
}

/// All finite eigenvalues, unrefined, from the operator K of [E32] with a real shift.
fn eigenvalues(pencil: &Pencil, differential: &[usize], shift: f64) -> Result<Vec<Complex<f64>>, SpectralError> {
    let mut lu = Lu::new(pencil.pattern).map_err(failure)?;
    let shift = factor_near(|by| {
        let moved = shift * (1.0 + by);
        let values: Vec<f64> = pencil.a.iter().zip(pencil.b).map(|(a, b)| a + moved * b).collect();
        lu.factor(&values).map(|()| moved).map_err(failure)
    })?;
    let n = differential.len();
    let mut full = vec![0.0; pencil.pattern.columns()];
    let mut columns = Vec::with_capacity(n * n);
    for &unknown in differential {
        full.fill(0.0);
        for entry in pencil.pattern.column(unknown) {
            full[pencil.pattern.rows[entry] as usize] = pencil.b[entry];
        }
        lu.solve(&mut full);
        columns.extend(differential.iter().map(|&unknown| full[unknown]));
    }
    let all = real_eigenvalues(n, &|i, j| columns[j * n + i]).ok_or(SpectralError::NotFinite)?;
    let largest = all.iter().map(|theta| theta.norm()).fold(0.0, f64::max);
    let finite = all.iter().filter(|theta| theta.norm() > FINITE * largest);
    Ok(finite.map(|theta| shift - theta.inv()).collect())
}
