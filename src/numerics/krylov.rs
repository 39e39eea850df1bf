//! Krylov methods for a linear map given as a function: the solution of `(1 - M) x = b`, and the largest eigenvalues of
//! M.

use nalgebra::Complex;
use slcbeam_dense::eigen;

use crate::numerics::kernels::dot;

/// Relative norm after orthogonalization below which a vector counts as zero.
const SPENT: f64 = 1e-13;
/// Angle [rad] from the real axis attributed to rounding errors.
const REAL: f64 = 1e-11;

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn subtract(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= factor * b);
}

/// An orthonormal Krylov basis with the matrix of the map in it.
struct Space {
    basis: Vec<Vec<f64>>,
    /// Columns of the matrix of the map; each has one entry more than the basis had vectors.
    columns: Vec<Vec<f64>>,
}

impl Space {
    fn new(start: &[f64]) -> Self {
        let size = norm(start);
        Self {
            basis: vec![start.iter().map(|x| x / size).collect()],
            columns: vec![],
        }
    }

    /// Adds one vector; false if the space is invariant under the map.
    fn grow(&mut self, map: &mut dyn FnMut(&mut [f64])) -> bool {
        let k = self.columns.len();
        let mut v = self.basis[k].clone();
        map(&mut v);
        let before = norm(&v);
        let mut column = vec![0.0; k + 2];
        // two passes suffice (Kahan and Parlett)
        for _ in 0..2 {
            for (q, h) in self.basis.iter().zip(&mut column) {
                let part = dot(q, &v);
                *h += part;
                subtract(&mut v, part, q);
            }
        }
        let left = norm(&v);
        let open = left > SPENT * before.max(f64::MIN_POSITIVE);
        if open {
            column[k + 1] = left;
            v.iter_mut().for_each(|v| *v /= left);
            self.basis.push(v);
        }
        self.columns.push(column);
        open
    }

    /// Eigenvalues of largest modulus of the map in the basis, with unit vectors and residuals set to zero. Complex
    /// pairs count once.
    fn pairs(&self, count: usize) -> Vec<(Complex<f64>, Vec<Complex<f64>>, f64)> {
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied().unwrap_or(0.0).into();
        let found = eigen(self.columns.len(), &entry).unwrap_or_default();
        // a pair that rounding errors separate from the real axis counts as two real eigenvalues
        let upper = found.into_iter().filter(|(value, _)| value.im >= -REAL * value.norm());
        let pairs = upper.take(count).map(|(value, vector)| {
            let real = value.im.abs() <= REAL * value.norm();
            (if real { value.re.into() } else { value }, vector, 0.0)
        });
        pairs.collect()
    }
}

/// Solves `(1 - M) x = b` by GMRES to a residual of `tolerance |b|`, with at most `most` applications of M. Returns x
/// and the relative residual.
pub fn solve(mut map: impl FnMut(&mut [f64]), b: &[f64], tolerance: f64, most: usize) -> (Vec<f64>, f64) {
    let (size, b_len) = (norm(b), b.len());
    if size == 0.0 {
        return (vec![0.0; b_len], 0.0);
    }
    let mut less = |v: &mut [f64]| {
        let before = v.to_vec();
        map(v);
        v.iter_mut().zip(before).for_each(|(v, before)| *v = before - *v);
    };
    let mut space = Space::new(b);
    // QR factorization of the matrix by rotations, and the rotated right-hand side
    let (mut rotations, mut upper) = (Vec::<(f64, f64)>::new(), Vec::<Vec<f64>>::new());
    let mut right = vec![size];
    loop {
        let open = space.grow(&mut less);
        let k = space.columns.len();
        let mut column = space.columns[k - 1].clone();
        for (i, (c, s)) in rotations.iter().enumerate() {
            let (a, b) = (column[i], column[i + 1]);
            (column[i], column[i + 1]) = (c * a + s * b, c * b - s * a);
        }
        let (a, b) = (column[k - 1], column[k]);
        let radius = a.hypot(b);
        let (c, s) = if radius > 0.0 {
            (a / radius, b / radius)
        } else {
            (1.0, 0.0)
        };
        column[k - 1] = radius;
        rotations.push((c, s));
        upper.push(column);
        right.push(-s * right[k - 1]);
        right[k - 1] *= c;
        let residual = right[k].abs() / size;
        if residual <= tolerance || !open || k >= most {
            let mut y = right[..k].to_vec();
            for i in (0..k).rev() {
                let known: f64 = (i + 1..k).map(|j| upper[j][i] * y[j]).sum();
                y[i] = if upper[i][i] == 0.0 {
                    0.0
                } else {
                    (y[i] - known) / upper[i][i]
                };
            }
            let mut x = vec![0.0; b_len];
            for (q, y) in space.basis.iter().zip(y) {
                subtract(&mut x, -y, q);
            }
            return (x, residual);
        }
    }
}

/// An eigenvalue with its vector as real and imaginary part.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigen {
    /// Eigenvalue.
    pub value: Complex<f64>,
    /// Vector of norm one.
    pub vector: [Vec<f64>; 2],
    /// `|M v - μ v|`.
    pub residual: f64,
}

/// The `count` eigenvalues of largest modulus of a map on vectors of length `start.len()`, by Arnoldi's method from
/// `start`, each to a residual of `tolerance`. Complex pairs count once, with positive imaginary part. The basis has at
/// most `most` vectors; if `most` is the dimension, all eigenvalues are found.
pub fn largest(
    mut map: impl FnMut(&mut [f64]),
    start: &[f64],
    count: usize,
    tolerance: f64,
    most: usize,
) -> Vec<Eigen> {
    if norm(start) == 0.0 {
        return vec![];
    }
    let mut space = Space::new(start);
    let mut next = (2 * count).max(16);
    loop {
        let open = space.grow(&mut map);
        let k = space.columns.len();
        let last = !open || k >= most;
        if k < next && !last {
            continue;
        }
        next = k + (k / 4).max(8);
        let left = space.columns[k - 1][k];
        let mut found = space.pairs(count);
        for (_, vector, residual) in &mut found {
            *residual = left * vector[k - 1].norm();
        }
        if last || found.iter().all(|(_, _, residual)| *residual <= tolerance) {
            return found
                .into_iter()
                .map(|(value, vector, residual)| {
                    let mut parts = [vec![0.0; start.len()], vec![0.0; start.len()]];
                    for (q, y) in space.basis.iter().zip(vector.iter()) {
                        subtract(&mut parts[0], -y.re, q);
                        subtract(&mut parts[1], -y.im, q);
                    }
                    Eigen {
                        value,
                        vector: parts,
                        residual,
                    }
                })
                .collect();
        }
    }
}

/// A fixed start vector with components along all eigenvectors.
pub fn everything(len: usize) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (1..=len).map(|k| (k as f64 * GOLDEN).fract() - 0.5 + 1e-3).collect()
}
