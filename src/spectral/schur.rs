//! Schur form of a small complex matrix, `H = Q T Qᴴ`, T upper triangular.
//!
//! Single-shift QR iteration of LAPACK's `zlahqr` (Wilkinson's shifts, exceptional ones every ten sweeps), on nalgebra's Hessenberg form.
//! nalgebra's own Schur form has no exceptional shifts and never ends for some repeated eigenvalues, such as those of many closed
//! networks. That of faer has them, but is not public (0.24).

use nalgebra::{Complex, DMatrix, Hessenberg};

type C = Complex<f64>;

/// Maximum number of sweeps per eigenvalue; LAPACK allows 30.
const SWEEPS: usize = 60;

/// `Q` and `T`, largest eigenvalues first; None if the iteration does not converge.
pub(super) fn ordered(h: DMatrix<C>) -> Option<(DMatrix<C>, DMatrix<C>)> {
    let (mut q, mut t) = match h.nrows() {
        0 | 1 => (DMatrix::identity(h.nrows(), h.nrows()), h),
        _ => Hessenberg::new(h).unpack(),
    };
    triangular(&mut q, &mut t)?;
    sort(&mut q, &mut t);
    Some((q, t))
}

/// Reduces a Hessenberg matrix to triangular form by sweeps of rotations, accumulated in q.
fn triangular(q: &mut DMatrix<C>, t: &mut DMatrix<C>) -> Option<()> {
    let size = t.norm();
    let mut end = t.nrows().saturating_sub(1);
    let mut sweep = 0;
    while end > 0 {
        // neglects entries that are small compared with their neighbors; after many sweeps, compared with the matrix
        let small = |t: &DMatrix<C>, k: usize| {
            let beside = t[(k - 1, k - 1)].norm() + t[(k, k)].norm();
            let beside = if sweep > SWEEPS / 2 { size } else { beside };
            t[(k, k - 1)].norm() <= f64::EPSILON * beside
        };
        let begin = (1..=end).rev().find(|&k| small(t, k)).unwrap_or(0);
        if begin > 0 {
            t[(begin, begin - 1)] = C::default();
        }
        if begin == end {
            (end, sweep) = (end - 1, 0);
            continue;
        }
        sweep += 1;
        if sweep > SWEEPS {
            return None;
        }
        let shift = if sweep % 10 == 0 {
            t[(end, end)] + 0.75 * t[(end, end - 1)].norm()
        } else {
            wilkinson(t, end)
        };
        step(q, t, begin, end, shift);
    }
    Some(())
}

/// Eigenvalue of the last two rows and columns that is nearer the last entry.
fn wilkinson(t: &DMatrix<C>, end: usize) -> C {
    let (a, b, c, d) = (
        t[(end - 1, end - 1)],
        t[(end - 1, end)],
        t[(end, end - 1)],
        t[(end, end)],
    );
    let half = 0.5 * (a - d);
    let root = (half * half + b * c).sqrt();
    let far = if (half + root).norm() > (half - root).norm() {
        half + root
    } else {
        half - root
    };
    if far.norm() == 0.0 { d } else { d - b * c / far }
}

/// One implicit sweep of rotations through the rows and columns from `begin` to `end`.
fn step(q: &mut DMatrix<C>, t: &mut DMatrix<C>, begin: usize, end: usize, shift: C) {
    let n = t.nrows();
    let (mut x, mut y) = (t[(begin, begin)] - shift, t[(begin + 1, begin)]);
    for k in begin..end {
        let r = x.norm().hypot(y.norm());
        if r > 0.0 {
            let (c, s) = (x / r, y / r);
            for j in k.saturating_sub(1).max(begin)..n {
                let (u, v) = (t[(k, j)], t[(k + 1, j)]);
                t[(k, j)] = c.conj() * u + s.conj() * v;
                t[(k + 1, j)] = c * v - s * u;
            }
            for (m, rows) in [(&mut *t, (k + 3).min(end + 1)), (&mut *q, n)] {
                for i in 0..rows {
                    let (u, v) = (m[(i, k)], m[(i, k + 1)]);
                    m[(i, k)] = u * c + v * s;
                    m[(i, k + 1)] = v * c.conj() - u * s.conj();
                }
            }
        }
        if k > begin {
            t[(k + 1, k - 1)] = C::default();
        }
        if k + 2 <= end {
            (x, y) = (t[(k + 1, k)], t[(k + 2, k)]);
        }
    }
}
/// Exchanges neighbors on the diagonal by rotations until their magnitudes descend.
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

/// Applies the rotation whose first column is the eigenvector of the second eigenvalue, `(t12, t22 - t11)`.
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
pub(super) fn vector(t: &DMatrix<C>, k: usize) -> Vec<C> {
    let mut y = vec![C::default(); k + 1];
    y[k] = C::new(1.0, 0.0);
    let least = f64::EPSILON * t[(0, 0)].norm().max(f64::MIN_POSITIVE);
    for i in (0..k).rev() {
        let sum: C = (i + 1..=k).map(|j| t[(i, j)] * y[j]).sum();
        let mut gap = t[(k, k)] - t[(i, i)];
        // repeated eigenvalues: the substitution gives the eigenvector of a matrix perturbed by rounding errors
        if gap.norm() < least {
            gap = C::new(least, 0.0);
        }
        y[i] = sum / gap;
    }
    y
}
