//! The lowest eigenvalues of a static tangent, cheaply.

use nalgebra::{Complex, DMatrix};
use slcbeam_dense::eigen;

use super::{Failure, pencil::failure};
use crate::dae::Pattern;
use crate::sundials::Klu;

/// Steps of the iteration; eigenvalues of a beam lie so far apart (β⁴) that its first ones are found to round-off.
const STEPS: usize = 24;
/// Eigenvalues count as found that the last four steps have moved by less than this part of them.
const SETTLED: f64 = 1e-4;

/// Eigenvalues μ of `K x = μ D x`, D a diagonal without negative entries, of least magnitude first: the first of those that
/// Arnoldi's iteration on `K⁻¹ D` has settled, orthogonal in D. Entries of `k` in the order of the pattern.
///
/// # Errors
/// [`Failure::Singular`] at an eigenvalue of zero, [`Failure::NotFinite`].
pub fn lowest(pattern: &Pattern, k: &[f64], d: &[f64]) -> Result<Vec<Complex<f64>>, Failure> {
    if k.iter().any(|k| !k.is_finite()) {
        return Err(Failure::NotFinite);
    }
    let mut klu = Klu::new(pattern).map_err(failure)?;
    klu.factor(k).map_err(failure)?;
    let (mut basis, mut h) = (vec![start(d)], DMatrix::<f64>::zeros(STEPS + 1, STEPS));
    let mut steps = 0;
    while steps < STEPS && steps < d.iter().filter(|d| **d > 0.0).count() {
        let mut w: Vec<f64> = basis[steps].iter().zip(d).map(|(v, d)| v * d).collect();
        klu.solve(&mut w);
        w.iter_mut()
            .zip(d)
            .filter(|(_, d)| **d == 0.0)
            .for_each(|(w, _)| *w = 0.0);
        // Twice is enough (Kahan).
        for _ in 0..2 {
            for (i, v) in basis.iter().enumerate() {
                let part = inner(v, &w, d);
                h[(i, steps)] += part;
                w.iter_mut().zip(v).for_each(|(w, v)| *w -= part * v);
            }
        }
        let left = inner(&w, &w, d).sqrt();
        steps += 1;
        if !left.is_finite() {
            return Err(Failure::NotFinite);
        }
        h[(steps, steps - 1)] = left;
        if left <= f64::EPSILON * h.amax() {
            break;
        }
        w.iter_mut().for_each(|w| *w /= left);
        basis.push(w);
    }
    let inverse = |size: usize| -> Vec<Complex<f64>> {
        let found = eigen(size, &|i, j| h[(i, j)].into()).unwrap_or_default();
        found.iter().map(|(theta, _)| theta.inv()).collect()
    };
    let mut found = inverse(steps);
    if steps == STEPS {
        let before = inverse(steps - 4);
        found.retain(|mu| before.iter().any(|b| (b - mu).norm() < SETTLED * mu.norm()));
    }
    found.retain(|mu| mu.norm().is_finite());
    found.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    Ok(found)
}

/// A vector with something of everything, of unit length in D.
fn start(d: &[f64]) -> Vec<f64> {
    let some = |(k, d): (usize, &f64)| if *d > 0.0 { 1.0 + (1.0 + k as f64).sin() } else { 0.0 };
    let mut v: Vec<f64> = d.iter().enumerate().map(some).collect();
    let length = inner(&v, &v, d).sqrt().max(f64::MIN_POSITIVE);
    v.iter_mut().for_each(|v| *v /= length);
    v
}

fn inner(a: &[f64], b: &[f64], d: &[f64]) -> f64 {
    a.iter().zip(b).zip(d).map(|((a, b), d)| a * b * d).sum()
}
