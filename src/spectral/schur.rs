//! Schur form of a small complex matrix, `H = Q T Qᴴ`, T upper triangular.

use nalgebra::{Complex, DMatrix, Schur};

type C = Complex<f64>;

/// Sweeps an eigenvalue may take; 30 is what LAPACK allows.
const SWEEPS: usize = 60;

/// `Q` and `T`, the largest eigenvalues first; None when the iteration does not converge.
pub fn ordered(h: DMatrix<C>) -> Option<(DMatrix<C>, DMatrix<C>)> {
    let sweeps = SWEEPS * h.nrows().max(1);
    let (mut q, mut t) = Schur::try_new(h, f64::EPSILON, sweeps)?.unpack();
    sort(&mut q, &mut t);
    Some((q, t))
}

/// Exchanges neighbours on the diagonal by rotations until their magnitudes descend.
fn sort(q: &mut DMatrix<C>, t: &mut DMatrix<C>) {
    let n = t.nrows();
    for end in (1..n).rev() {
        let mut swapped = false;
        for k in 0..end {
            if t[(k, k)].norm() < t[(k + 1, k + 1)].norm() {
                swap(q, t, k);
                swapped = true;
            }
        }
        if !swapped {
            break;
        }
    }
}

/// The rotation whose first column is the eigenvector of the second eigenvalue, `(t12, t22 - t11)`.
fn swap(q: &mut DMatrix<C>, t: &mut DMatrix<C>, k: usize) {
    let (a, b) = (t[(k, k + 1)], t[(k + 1, k + 1)] - t[(k, k)]);
    let size = a.norm().hypot(b.norm());
    if size == 0.0 {
        return;
    }
    let (c, s) = (a / size, b / size);
    let (first, second) = (t[(k, k)], t[(k + 1, k + 1)]);
    let n = t.nrows();
    for m in [&mut *q, &mut *t] {
        for i in 0..n {
            let (x, y) = (m[(i, k)], m[(i, k + 1)]);
            m[(i, k)] = x * c + y * s;
            m[(i, k + 1)] = y * c.conj() - x * s.conj();
        }
    }
    for j in 0..n {
        let (x, y) = (t[(k, j)], t[(k + 1, j)]);
        t[(k, j)] = x * c.conj() + y * s.conj();
        t[(k + 1, j)] = y * c - x * s;
    }
    t[(k, k)] = second;
    t[(k + 1, k + 1)] = first;
    t[(k + 1, k)] = C::default();
}

/// Eigenvector of the `k`-th eigenvalue of T, by substitution; `k + 1` entries, the last of them 1.
pub fn vector(t: &DMatrix<C>, k: usize) -> Vec<C> {
    let mut y = vec![C::default(); k + 1];
    y[k] = C::new(1.0, 0.0);
    let least = f64::EPSILON * t[(0, 0)].norm().max(f64::MIN_POSITIVE);
    for i in (0..k).rev() {
        let sum: C = (i + 1..=k).map(|j| t[(i, j)] * y[j]).sum();
        let mut gap = t[(k, k)] - t[(i, i)];
        // repeated eigenvalues: the substitution then gives the vector that a change by round-off has
        if gap.norm() < least {
            gap = C::new(least, 0.0);
        }
        y[i] = sum / gap;
    }
    y
}
