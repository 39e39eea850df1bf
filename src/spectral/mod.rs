//! Eigenvalues of sparse pencils `A + s B` nearest a shift, each with an error bound.
//!
//! | file | content |
//! |---|---|
//! | [`pencil`] | the pencil, its products and its factors at a shift |
//! | `schur` | Schur form of a small matrix, its ordering and its eigenvectors |
//! | `dense` | all finite eigenvalues of a small pencil |
//! | `krylov` | eigenvalues nearest a shift, for a large pencil |
//! | `lowest` | lowest eigenvalues of a static tangent |
//! | `growing` | growing oscillations of a small or medium pencil |
//! | `refine` | refinement of single eigenpairs, with error bounds |
//!
//! `[E32]` The finite eigenvalues nearest a shift σ are the largest of an operator on the unknowns d whose columns of B are not zero. The
//! others would add infinite eigenvalues and are eliminated with the factors:
//!
//! ```text
//! K = P (A + σ B)⁻¹ B Pᵀ        K x_d = θ x_d        s = σ - 1/θ        x = (A + σ B)⁻¹ B x/θ
//! ```
//!
//! faer (`crates/dense`) computes all eigenvalues of a small K. A large K is only applied: one solve with KLU's factors per step of the
//! Krylov-Schur method (Stewart 2002). faer's `partial_eigen` is unsuitable: it stops at an absolute residual, but the θ of one beam
//! range over ten powers of ten. It also needs an operator shared by threads, but each solve writes to KLU's work space. Debian's ARPACK
//! depends on Fortran, BLAS and LAPACK and does not separate repeated eigenvalues.

mod dense;
mod growing;
mod krylov;
mod lowest;
pub mod pencil;
mod refine;
mod schur;

use std::fmt;

use nalgebra::Complex;

use crate::error::numbers::counted;
use crate::integrate::halt::INTERRUPTED;

pub use growing::{Bounds, growing};
pub use lowest::lowest;
pub use pencil::{Factors, Pencil};

/// Number of differential unknowns up to which all eigenvalues are computed at once.
pub const DENSE: usize = 120;
/// Number of differential unknowns up to which all eigenvalues are computed if the Krylov space does not converge, e.g. for strongly
/// damped motions in badly scaled unknowns. The work grows with the third power: a second at about 500.
pub const AT_LAST_DENSE: usize = 1000;

/// Options of an eigenvalue computation.
#[derive(Clone, Debug, PartialEq)]
pub struct EigenvalueOptions {
    /// Size of the operator up to which it is assembled and all its eigenvalues are computed.
    pub dense_up_to: usize,
    /// Size of the operator up to which this is done if the Krylov space does not converge.
    pub at_last_dense_up_to: usize,
    /// Residual of a Schur vector, relative to its θ, below which it counts as converged; eigenpairs are refined
    /// afterwards.
    pub tolerance: f64,
    /// Maximum number of restarts.
    pub max_restarts: usize,
}

impl Default for EigenvalueOptions {
    fn default() -> Self {
        Self {
            dense_up_to: DENSE,
            at_last_dense_up_to: AT_LAST_DENSE,
            // refinement converges cubically: half of the digits suffice
            tolerance: 1e-9,
            max_restarts: 100,
        }
    }
}

/// An eigenvalue with its eigenvectors.
#[derive(Clone, Debug, PartialEq)]
pub struct EigenPair {
    /// Eigenvalue `s`, in the unit of A over B.
    pub s: Complex<f64>,
    /// Right eigenvector `x`, of unit length; one entry per column.
    pub x: Vec<Complex<f64>>,
    /// Left eigenvector y, `yᴴ (A + s B) = 0`; one entry per row.
    pub left: Vec<Complex<f64>>,
    /// Backward error: `|(A + s B) x|` over `|A| |x| + |s| |B| |x|`, with entrywise absolute values.
    pub residual: f64,
    /// First-order error bound of `s`, including rounding errors, [E34].
    pub error: f64,
}

/// Relative distance up to which an unrefined eigenvalue is the conjugate of another one.
const CONJUGATE: f64 = 1e-6;

impl EigenPair {
    fn conjugate(&self) -> Self {
        Self {
            s: self.s.conj(),
            x: self.x.iter().map(|x| x.conj()).collect(),
            left: self.left.iter().map(|y| y.conj()).collect(),
            ..*self
        }
    }
}

/// Eigenvalues nearest a shift, and the work of their computation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Eigenvalues {
    /// Eigenpairs, nearest first.
    pub pairs: Vec<EigenPair>,
    /// Upper limit of the number of finite eigenvalues.
    pub finite: usize,
    /// Sparse factorisations.
    pub factorizations: u64,
    /// Sparse solves.
    pub solves: u64,
    /// Restarts of the Krylov space; 0 when all eigenvalues were computed at once.
    pub restarts: usize,
    /// True if all eigenvalues were computed at once.
    pub dense: bool,
}

/// Error of an eigenvalue computation.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectralError {
    /// The pencil is singular at the shift and beside it: `A + s B` has no inverse for any s.
    Singular {
        /// Column without pivot.
        column: usize,
    },
    /// KLU ran out of memory or indices overflowed.
    Package {
        /// Status of KLU.
        status: i64,
    },
    /// The iteration did not converge.
    Slow {
        /// Number of converged eigenvalues.
        converged: usize,
        /// Restarts done.
        restarts: usize,
    },
    /// An entry is not finite.
    NotFinite,
    /// The computation was interrupted.
    Interrupted,
}

impl fmt::Display for SpectralError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { .. } => write!(f, "the linearised equations do not determine an unknown"),
            Self::Package { status } => write!(f, "KLU failed (status {status})"),
            Self::Slow { converged, restarts } => {
                write!(
                    f,
                    "only {} converged in {}",
                    counted(*converged as u64, "eigenvalue"),
                    counted(*restarts as u64, "restart")
                )
            }
            Self::NotFinite => write!(f, "the linearised equations have entries that are not finite"),
            Self::Interrupted => f.write_str(INTERRUPTED),
        }
    }
}

impl std::error::Error for SpectralError {}

/// Returns the `count` eigenvalues of a pencil nearest `shift`, or all if there are fewer; every copy of a repeated one
/// counts.
///
/// # Errors
/// [`SpectralError`].
pub fn nearest(
    pencil: &Pencil,
    shift: Complex<f64>,
    count: usize,
    options: &EigenvalueOptions,
) -> Result<Eigenvalues, SpectralError> {
    if !pencil.finite() {
        return Err(SpectralError::NotFinite);
    }
    let mut shifted = pencil::Shifted::new(pencil, shift)?;
    let size = shifted.differential.len();
    let dense = size <= options.dense_up_to.max(2 * count + 2);
    let (mut pairs, restarts) = if size == 0 || count == 0 {
        (vec![], 0)
    } else if dense {
        (dense::pairs(&mut shifted)?, 0)
    } else {
        match krylov::pairs(&mut shifted, count, options) {
            Err(SpectralError::Slow { restarts, .. }) if size <= options.at_last_dense_up_to => {
                (dense::pairs(&mut shifted)?, restarts)
            }
            found => found?,
        }
    };
    pairs.truncate(count);
    let mut refined: Vec<EigenPair> = Vec::with_capacity(pairs.len());
    let mut alone: Vec<usize> = vec![];
    for (s, x) in pairs {
        // A and B are real: the conjugate of an eigenpair is an eigenpair of the same accuracy
        let other = |k: &usize| (refined[*k].s.conj() - s).norm() < CONJUGATE * s.norm() && s.im != 0.0;
        if let Some(at) = alone.iter().position(|k| refined[*k].s.im * s.im < 0.0 && other(k)) {
            let conjugate = refined[alone.swap_remove(at)].conjugate();
            refined.push(conjugate);
        } else {
            alone.push(refined.len());
            refined.push(refine::refine(&mut shifted, s, x)?);
        }
    }
    let far = |pair: &EigenPair| (pair.s - shift).norm();
    refined.sort_by(|a, b| far(a).total_cmp(&far(b)));
    Ok(Eigenvalues {
        pairs: refined,
        finite: size,
        factorizations: shifted.lu.factorizations,
        solves: shifted.lu.solves,
        restarts,
        dense,
    })
}

/// `yᴴ (A' + s B') x / yᴴ B x` of an eigenpair, for entries A' and B' of the pencil's pattern: the shift of its eigenvalue by a change A'
/// + s B' of the pencil, with the opposite sign.
pub fn quotient(
    pattern: &crate::sparse::Pattern,
    a: &[f64],
    b: &[f64],
    of_b: &[f64],
    pair: &EigenPair,
) -> Complex<f64> {
    let (mut above, mut below) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
    for (column, x) in pair.x.iter().enumerate() {
        for entry in pattern.column(column) {
            let y = pair.left[pattern.rows[entry] as usize].conj();
            above += y * (pair.s * b[entry] + a[entry]) * x;
            below += y * of_b[entry] * x;
        }
    }
    above / below
}
