//! Solutions of `(z - M) x = b` for a real linear map M given as a function, and for many complex shifts z.

use nalgebra::{Complex, DMatrix, DVector};

use super::kernels::dot;

/// Relative norm after orthogonalization below which a vector counts as zero.
const SPENT: f64 = 1e-12;

/// A real orthonormal basis, its image under the map, and the map in the basis. All shifts use them and add to them.
#[derive(Clone, Debug, Default)]
pub struct ShiftedSolver {
    basis: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    /// `basis · images`: rows, which grow with the basis.
    matrix: Vec<Vec<f64>>,
}

impl ShiftedSolver {
    /// Dimension of the basis.
    pub fn dimension(&self) -> usize {
        self.basis.len()
    }

    /// Solves `(z - M) x = b` by Galerkin's method to a residual of `tolerance |b|`, with a basis of at most `most` vectors. `map`
    /// applies M to vectors of length `b.len()` that follow one another. Returns x and the relative residual.
    pub fn solve(
        &mut self,
        map: &mut dyn FnMut(&mut [f64]),
        z: Complex<f64>,
        b: &[Complex<f64>],
        tolerance: f64,
        most: usize,
    ) -> (Vec<Complex<f64>>, f64) {
        let norm = |v: &[Complex<f64>]| v.iter().map(Complex::norm_sqr).sum::<f64>().sqrt();
        let size = norm(b);
        if size == 0.0 {
            return (b.to_vec(), 0.0);
        }
        let mut best = (vec![Complex::new(0.0, 0.0); b.len()], 1.0);
        let mut residual = b.to_vec();
        loop {
            if let Some(x) = self.project(z, b, &mut residual) {
                let left = norm(&residual) / size;
                if left < best.1 {
                    best = (x, left);
                }
            }
            if best.1 <= tolerance || self.dimension() >= most || !self.extend(map, &residual) {
                return best;
            }
        }
    }

    /// The solution in the basis and its residual; `None` if the matrix in the basis is singular.
    fn project(&self, z: Complex<f64>, b: &[Complex<f64>], residual: &mut [Complex<f64>]) -> Option<Vec<Complex<f64>>> {
        let m = self.dimension();
        residual.copy_from_slice(b);
        if m == 0 {
            return None;
        }
        let matrix = DMatrix::from_fn(m, m, |i, j| {
            let diagonal = if i == j { z } else { Complex::new(0.0, 0.0) };
            diagonal - self.matrix[i][j]
        });
        let lu = matrix.lu();
        let mut x = vec![Complex::new(0.0, 0.0); b.len()];
        // the second pass corrects rounding errors of the first
        for _ in 0..2 {
            let right = self
                .basis
                .iter()
                .map(|q| q.iter().zip(&*residual).map(|(q, r)| r * *q).sum());
            let y = lu.solve(&DVector::from_iterator(m, right))?;
            for ((q, image), y) in self.basis.iter().zip(&self.images).zip(y.iter()) {
                for ((x, r), (q, image)) in x.iter_mut().zip(residual.iter_mut()).zip(q.iter().zip(image)) {
                    *x += y * *q;
                    *r -= y * (z * *q - image);
                }
            }
        }
        Some(x)
    }

    /// Adds real and imaginary part of a vector to the basis; false if it contains them.
    fn extend(&mut self, map: &mut dyn FnMut(&mut [f64]), vector: &[Complex<f64>]) -> bool {
        let parts: [Vec<f64>; 2] = [
            vector.iter().map(|v| v.re).collect(),
            vector.iter().map(|v| v.im).collect(),
        ];
        let (before, n) = (self.dimension(), vector.len());
        let largest = parts.iter().map(|v| dot(v, v)).fold(0.0, f64::max).sqrt();
        for mut v in parts {
            // two passes suffice (Kahan and Parlett)
            for _ in 0..2 {
                for q in &self.basis {
                    let part = dot(q, &v);
                    v.iter_mut().zip(q).for_each(|(v, q)| *v -= part * q);
                }
            }
            let left = dot(&v, &v).sqrt();
            if left > SPENT * largest {
                v.iter_mut().for_each(|v| *v /= left);
                self.basis.push(v);
            }
        }
        let mut block: Vec<f64> = self.basis[before..].concat();
        if block.is_empty() {
            return false;
        }
        map(&mut block);
        self.images.extend(block.chunks(n).map(<[f64]>::to_vec));
        let m = self.dimension();
        for i in 0..m {
            if i >= before {
                self.matrix.push(vec![]);
            }
            let known = self.matrix[i].len();
            for j in known..m {
                let entry = dot(&self.basis[i], &self.images[j]);
                self.matrix[i].push(entry);
            }
        }
        true
    }
}
