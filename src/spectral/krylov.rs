//! Krylov-Schur method: an Arnoldi basis, restarted with the Schur vectors of the wanted eigenvalues.
//!
//! G. W. Stewart, *A Krylov-Schur algorithm for large eigenproblems*, SIAM J. Matrix Anal. Appl. 23 (2002) 601-614:
//!
//! ```text
//! K U = U T + u bᵀ        kept where |bᵢ| ≤ tolerance |Tᵢᵢ|
//! ```
//!
//! A Krylov space contains only one vector of a repeated eigenvalue. Once all wanted eigenvalues have converged, the basis therefore
//! continues from a random vector orthogonal to them. They are complete if this finds none nearer the shift.

use nalgebra::{Complex, DMatrix};

use super::pencil::Shifted;
use super::{EigenvalueOptions, SpectralError, schur};
use crate::integrate::halt;

type C = Complex<f64>;
/// Eigenvalues with their eigenvectors.
pub(super) type RotatedVectors = Vec<(C, Vec<C>)>;

/// Ratio to the largest θ below which θ belongs to an infinite eigenvalue.
pub(super) const FINITE: f64 = 1e-14;
/// Relative change of a θ above which it is a new eigenvalue, not a rounding error.
const NEW: f64 = 1e-7;

/// Eigenvalues and eigenvectors, nearest the shift first, and the number of restarts.
pub(super) fn pairs(
    shifted: &mut Shifted,
    count: usize,
    options: &EigenvalueOptions,
) -> Result<(RotatedVectors, usize), SpectralError> {
    let n = shifted.differential.len();
    let wanted = count.min(n);
    let size = (2 * wanted + 20).min(n);
    let mut space = Space::new(n, size);
    let mut known: Option<Vec<f64>> = None;
    for restarts in 0..=options.max_restarts {
        space.expand(shifted)?;
        let slow = |converged| SpectralError::Slow { converged, restarts };
        let (q, t) = schur::ordered(space.h.view((0, 0), (size, size)).into_owned()).ok_or(slow(0))?;
        let last = space.h[(size, size - 1)];
        let b: Vec<C> = (0..size).map(|i| last * q[(size - 1, i)]).collect();
        let largest = t[(0, 0)].norm();
        let good = |i: usize| {
            let theta = t[(i, i)].norm();
            theta <= FINITE * largest || b[i].norm() <= options.tolerance * theta
        };
        let converged = (0..wanted).take_while(|&i| good(i)).count();
        if converged == wanted {
            let sizes: Vec<f64> = (0..wanted).map(|i| t[(i, i)].norm()).collect();
            let same = |old: &Vec<f64>| old.iter().zip(&sizes).all(|(old, new)| (new / old - 1.0).abs() < NEW);
            if known.as_ref().is_some_and(same) || size == n {
                return Ok((space.vectors(shifted, &q, &t, wanted), restarts));
            }
            known = Some(sizes);
            space.restart(&q, &t, &b, wanted, true);
        } else if restarts == options.max_restarts {
            return Err(slow(converged));
        } else {
            // converged vectors leave space for the others
            let kept = (wanted + (size - wanted) / 4 + converged / 4).min(size - 2);
            space.restart(&q, &t, &b, kept, false);
        }
    }
    Err(SpectralError::Slow {
        converged: 0,
        restarts: options.max_restarts,
    })
}

/// `K U = U H`; U has one vector more than H has columns.
struct Space {
    u: Vec<Vec<C>>,
    h: DMatrix<C>,
    size: usize,
    seed: u64,
}

impl Space {
    fn new(n: usize, size: usize) -> Self {
        let mut space = Self {
            u: vec![],
            h: DMatrix::zeros(size + 1, size),
            size,
            seed: 0x9e37_79b9_7f4a_7c15,
        };
        let first = space.random(n);
        space.u.push(first);
        space
    }

    /// Continues Arnoldi's recursion from the end of the basis.
    fn expand(&mut self, shifted: &mut Shifted) -> Result<(), SpectralError> {
        let n = self.u[0].len();
        while self.u.len() <= self.size {
            if halt::asked() {
                return Err(SpectralError::Interrupted);
            }
            let j = self.u.len() - 1;
            let mut w = vec![C::default(); n];
            shifted.apply(&self.u[j], &mut w);
            let before = norm(&w);
            let coefficients = self.orthogonalise(&mut w);
            for (i, c) in coefficients.into_iter().enumerate() {
                self.h[(i, j)] = c;
            }
            let after = norm(&w);
            if after > f64::EPSILON * before && j + 1 < n {
                self.h[(j + 1, j)] = C::new(after, 0.0);
                w.iter_mut().for_each(|w| *w /= after);
                self.u.push(w);
            } else {
                self.h[(j + 1, j)] = C::default();
                let next = if j + 1 < n {
                    self.random(n)
                } else {
                    vec![C::default(); n]
                };
                self.u.push(next);
            }
        }
        Ok(())
    }

    /// Orthogonalizes `w` against the basis, twice; returns its coefficients.
    fn orthogonalise(&self, w: &mut [C]) -> Vec<C> {
        let mut all = vec![C::default(); self.u.len()];
        for _ in 0..2 {
            for (u, sum) in self.u.iter().zip(&mut all) {
                let c: C = u.iter().zip(&*w).map(|(u, w)| u.conj() * w).sum();
                w.iter_mut().zip(u).for_each(|(w, u)| *w -= u * c);
                *sum += c;
            }
        }
        all
    }

    /// A random vector of unit length, orthogonal to the basis.
    fn random(&mut self, n: usize) -> Vec<C> {
        let mut next = || {
            // xorshift: deterministic, so that runs are reproducible
            self.seed ^= self.seed << 13;
            self.seed ^= self.seed >> 7;
            self.seed ^= self.seed << 17;
            (self.seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut w: Vec<C> = (0..n).map(|_| C::new(next(), next())).collect();
        self.orthogonalise(&mut w);
        unit(w)
    }

    /// Keeps the first `kept` Schur vectors; continues from the last vector of the basis, or from a random one
    /// (`anew`).
    fn restart(&mut self, q: &DMatrix<C>, t: &DMatrix<C>, b: &[C], kept: usize, anew: bool) {
        let last = self.u.pop();
        let n = self.u[0].len();
        let vectors = (0..kept).map(|k| combined(&self.u, &q.column(k).iter().copied().collect::<Vec<_>>()));
        self.u = vectors.collect();
        self.h.fill(C::default());
        self.h
            .view_mut((0, 0), (kept, kept))
            .copy_from(&t.view((0, 0), (kept, kept)));
        match last {
            Some(last) if !anew => {
                for (i, b) in b.iter().take(kept).enumerate() {
                    self.h[(kept, i)] = *b;
                }
                self.u.push(last);
            }
            _ => {
                let next = self.random(n);
                self.u.push(next);
            }
        }
    }

    /// Eigenvalues and eigenvectors from the first `wanted` Schur vectors.
    fn vectors(&self, shifted: &mut Shifted, q: &DMatrix<C>, t: &DMatrix<C>, wanted: usize) -> RotatedVectors {
        let largest = t[(0, 0)].norm();
        let finite = (0..wanted).take_while(|&k| t[(k, k)].norm() > FINITE * largest);
        finite
            .map(|k| {
                let y = schur::vector(t, k);
                let in_basis: Vec<C> = (0..self.size)
                    .map(|i| y.iter().enumerate().map(|(j, y)| q[(i, j)] * y).sum())
                    .collect();
                let x = combined(&self.u, &in_basis);
                (shifted.shift - t[(k, k)].inv(), shifted.whole(&x).to_vec())
            })
            .collect()
    }
}

/// `Σ cᵢ uᵢ` scaled to unit length; the sum has as many terms as there are coefficients.
fn combined(u: &[Vec<C>], c: &[C]) -> Vec<C> {
    let mut sum = vec![C::default(); u[0].len()];
    for (u, c) in u.iter().zip(c) {
        sum.iter_mut().zip(u).for_each(|(sum, u)| *sum += u * c);
    }
    unit(sum)
}

/// Scales a vector to unit length.
pub(super) fn unit(mut x: Vec<C>) -> Vec<C> {
    let size = norm(&x);
    x.iter_mut().for_each(|x| *x /= size);
    x
}

/// Euclidean norm.
fn norm(x: &[C]) -> f64 {
    x.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt()
}
