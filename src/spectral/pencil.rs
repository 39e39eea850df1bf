//! The pencil `A + s B`, its products and its factors at a shift.

use nalgebra::Complex;

use super::krylov::unit;
use super::refine::refine;
use super::{EigenPair, SpectralError};
use crate::integrate::halt;
use crate::sparse::KluError;
use crate::sparse::Pattern;
use crate::sparse::complex::ComplexLu;

/// Two real sparse matrices with a common pattern.
#[derive(Clone, Copy, Debug)]
pub struct Pencil<'a> {
    /// Positions of entries.
    pub pattern: &'a Pattern,
    /// Entries of A.
    pub a: &'a [f64],
    /// Entries of B.
    pub b: &'a [f64],
}

impl Pencil<'_> {
    /// True if every entry is finite.
    pub fn finite(&self) -> bool {
        self.a.iter().chain(self.b).all(|x| x.is_finite())
    }

    /// Unknowns whose column of B is not zero.
    pub(super) fn differential(&self) -> Vec<usize> {
        let in_b = |&j: &usize| self.pattern.column(j).any(|e| self.b[e] != 0.0);
        (0..self.pattern.columns()).filter(in_b).collect()
    }

    /// `A x` and `B x`.
    pub fn products(&self, x: &[Complex<f64>]) -> (Vec<Complex<f64>>, Vec<Complex<f64>>) {
        let (mut ax, mut bx) = (vec![Complex::default(); x.len()], vec![Complex::default(); x.len()]);
        for (column, x) in x.iter().enumerate() {
            for entry in self.pattern.column(column) {
                let row = self.pattern.rows[entry] as usize;
                ax[row] += x * self.a[entry];
                bx[row] += x * self.b[entry];
            }
        }
        (ax, bx)
    }

    /// `|A| |x| + |s| |B| |x|` with entrywise absolute values: reference of the residual's rounding error.
    pub fn magnitude(&self, s: Complex<f64>, x: &[Complex<f64>]) -> Vec<f64> {
        let mut sum = vec![0.0; x.len()];
        let s = s.norm();
        for (column, x) in x.iter().enumerate() {
            let x = x.norm();
            for entry in self.pattern.column(column) {
                sum[self.pattern.rows[entry] as usize] += (self.a[entry].abs() + s * self.b[entry].abs()) * x;
            }
        }
        sum
    }
}

/// A pencil with the factors of `A + σ B`.
pub(super) struct Shifted<'a> {
    pub pencil: Pencil<'a>,
    /// σ, shifted slightly if it is an eigenvalue.
    pub shift: Complex<f64>,
    pub lu: ComplexLu,
    /// Unknowns whose column of B is not zero.
    pub differential: Vec<usize>,
    values: Vec<Complex<f64>>,
    full: Vec<Complex<f64>>,
}

/// Relative distances by which a shift is moved if there are no factors.
const MOVES: [f64; 4] = [0.0, 1e-7, 1e-5, 1e-3];

/// Calls `factor` with relative distances from a shift, zero first, until it finds factors; returns the shift that it used.
pub(super) fn factor_near<S>(mut factor: impl FnMut(f64) -> Result<S, SpectralError>) -> Result<S, SpectralError> {
    let mut last = SpectralError::Singular { column: 0 };
    for by in MOVES {
        if halt::asked() {
            return Err(SpectralError::Interrupted);
        }
        match factor(by) {
            Ok(shift) => return Ok(shift),
            Err(fault) => last = fault,
        }
    }
    Err(last)
}

impl<'a> Shifted<'a> {
    pub fn new(pencil: &Pencil<'a>, shift: Complex<f64>) -> Result<Self, SpectralError> {
        let entries = pencil.a.iter().zip(pencil.b);
        let values: Vec<_> = entries.map(|(a, b)| shift * *b + a).collect();
        let lu = ComplexLu::new(pencil.pattern, &values).map_err(failure)?;
        let mut shifted = Self {
            pencil: *pencil,
            shift,
            lu,
            differential: pencil.differential(),
            values,
            full: vec![Complex::default(); pencil.pattern.columns()],
        };
        shifted.shift = shifted.factor(shift)?;
        Ok(shifted)
    }

    /// Computes the factors at `s`, or as near to it as possible; returns the shift used.
    pub fn factor(&mut self, s: Complex<f64>) -> Result<Complex<f64>, SpectralError> {
        // a shift of zero has no size; use that of A over B
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let size = if s.norm() > 0.0 {
            s.norm()
        } else {
            largest(self.pencil.a) / largest(self.pencil.b).max(f64::MIN_POSITIVE)
        };
        factor_near(|by| {
            let moved = s + Complex::new(0.8, 0.6) * (by * size);
            for ((value, a), b) in self.values.iter_mut().zip(self.pencil.a).zip(self.pencil.b) {
                *value = moved * *b + a;
            }
            self.lu.factor(&self.values).map(|()| moved).map_err(failure)
        })
    }

    /// `(A + σ B)⁻¹ B Pᵀ v`, for all unknowns.
    pub fn whole(&mut self, v: &[Complex<f64>]) -> &[Complex<f64>] {
        self.full.fill(Complex::default());
        for (&column, v) in self.differential.iter().zip(v) {
            for entry in self.pencil.pattern.column(column) {
                self.full[self.pencil.pattern.rows[entry] as usize] += v * self.pencil.b[entry];
            }
        }
        self.lu.solve(&mut self.full);
        &self.full
    }

    /// Replaces `b` by the solution of `(A + σ B) x = b`.
    pub fn solve(&mut self, b: &mut [Complex<f64>]) {
        self.lu.solve(b);
    }

    /// Replaces `b` by the solution of `(A + σ B)ᴴ x = b`.
    pub fn solve_adjoint(&mut self, b: &mut [Complex<f64>]) {
        self.lu.solve_adjoint(b);
    }

    /// `K v`.
    pub fn apply(&mut self, v: &[Complex<f64>], out: &mut [Complex<f64>]) {
        self.whole(v);
        for (out, &unknown) in out.iter_mut().zip(&self.differential) {
            *out = self.full[unknown];
        }
    }
}

/// Factors of `A + s B` for a sequence of s.
pub struct Factors<'a>(Shifted<'a>);

impl<'a> Factors<'a> {
    /// Analyzes a pencil by its values at `s`.
    ///
    /// # Errors
    /// The pencil is singular for every s.
    pub fn new(pencil: &Pencil<'a>, s: Complex<f64>) -> Result<Self, SpectralError> {
        Shifted::new(pencil, s).map(Self)
    }

    /// Replaces `b` by the solution of `(A + s B) x = b`. Successive solutions at one s share the factors.
    ///
    /// # Errors
    /// s is an eigenvalue.
    pub fn solve(&mut self, s: Complex<f64>, b: &mut [Complex<f64>]) -> Result<(), SpectralError> {
        self.factor(s)?;
        self.0.solve(b);
        finite(b)
    }

    /// Replaces `b` by the solution of `(A + s B)ᵀ x = b`.
    ///
    /// # Errors
    /// s is an eigenvalue.
    pub fn solve_transposed(&mut self, s: Complex<f64>, b: &mut [Complex<f64>]) -> Result<(), SpectralError> {
        self.factor(s)?;
        b.iter_mut().for_each(|x| *x = x.conj());
        self.0.solve_adjoint(b);
        b.iter_mut().for_each(|x| *x = x.conj());
        finite(b)
    }

    /// The eigenpair that inverse iteration with the shift s approaches in some steps, in general the nearest one.
    ///
    /// # Errors
    /// The pencil is singular near s.
    pub fn eigenpair(&mut self, s: Complex<f64>, steps: usize) -> Result<EigenPair, SpectralError> {
        let shifted = &mut self.0;
        shifted.factor(s)?;
        // the factors are those of other shifts from now on
        shifted.shift = Complex::new(f64::NAN, f64::NAN);
        // no eigenvector of a symmetric beam is orthogonal to this one
        let begin = |k: usize| Complex::new((1.7 * k as f64).sin(), (0.6 * k as f64).cos());
        let mut v: Vec<_> = (0..shifted.differential.len()).map(begin).collect();
        let mut next = v.clone();
        for _ in 1..steps {
            shifted.apply(&v, &mut next);
            v = unit(std::mem::take(&mut next));
            next = v.clone();
        }
        let x = unit(shifted.whole(&v).to_vec());
        refine(shifted, s, x)
    }

    fn factor(&mut self, s: Complex<f64>) -> Result<(), SpectralError> {
        if self.0.shift != s {
            // after an error there are no factors
            self.0.shift = Complex::new(f64::NAN, f64::NAN);
            self.0.shift = self.0.factor(s)?;
        }
        match self.0.shift == s {
            true => Ok(()),
            false => Err(SpectralError::Singular { column: 0 }),
        }
    }
}

fn finite(solution: &[Complex<f64>]) -> Result<(), SpectralError> {
    match solution.iter().all(|x| x.is_finite()) {
        true => Ok(()),
        false => Err(SpectralError::Singular { column: 0 }),
    }
}

pub(super) fn failure(fault: KluError) -> SpectralError {
    match fault {
        KluError::Singular { column } => SpectralError::Singular { column },
        KluError::Package { status } => SpectralError::Package { status },
    }
}
