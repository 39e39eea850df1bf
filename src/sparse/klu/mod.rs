//! Sparse LU factors by KLU (Davis & Natarajan, Algorithm 907), with a check for stale pivots.
//!
//! A refactorization with the old pivot order costs less than half of a new factorization, but the old pivots may be bad for the new
//! values. KLU does not report this: `[1 1; 1 2]` and then `[1e-16 1; 1 2]` gives x = (0, 2) instead of (1, 2), with good flags and
//! condition estimate. The growth of the factors, `min_j max_i |aᵢⱼ| / max_i |uᵢⱼ|`, detects it, because it amplifies the rounding error.
//! If it falls below [`Klu::smallest_growth`], the pivots are chosen anew.

pub mod complex;
mod rows;

use std::ptr;

use crate::sparse::Pattern;

use super::c;
use rows::Rows;

/// Reason why a matrix could not be factored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KluError {
    /// No pivot is left in this column.
    Singular {
        /// Column of the matrix as given.
        column: usize,
    },
    /// KLU failed, e.g. for lack of memory or because indices overflow; its status.
    Package {
        /// -2 memory, -3 invalid input, -4 too large.
        status: i64,
    },
}

// SAFETY: memory allocated by KLU belongs to no thread, and is accessible only through this value.
unsafe impl Send for Analysis {}
// SAFETY: likewise.
unsafe impl Send for Klu {}

/// Pattern analyzed by KLU: checked, in block triangular form, ordered.
struct Analysis {
    starts: Vec<i64>,
    rows: Vec<i64>,
    common: Box<c::klu_l_common>,
    symbolic: *mut c::klu_l_symbolic,
}

impl Analysis {
    fn new(pattern: &Pattern) -> Result<Self, KluError> {
        let n = pattern.columns();
        // the C code relies on all of these conditions
        let sound = pattern.starts[0] == 0
            && pattern.starts.windows(2).all(|pair| pair[0] <= pair[1])
            && pattern.starts[n] as usize == pattern.rows.len()
            && pattern.rows.iter().all(|&row| row >= 0 && (row as usize) < n);
        if !sound {
            return Err(KluError::Package {
                status: c::KLU_INVALID.into(),
            });
        }
        // SAFETY: plain numbers and pointers, for which zero is a value; `klu_l_defaults` then sets them.
        let mut common: Box<c::klu_l_common> = Box::new(unsafe { std::mem::zeroed() });
        // SAFETY: the structure is valid for writing.
        unsafe { c::klu_l_defaults(&mut *common) };
        common.ordering = 0; // AMD: fills less than COLAMD where a few rows are dense
        common.scale = 2; // rows by their largest entry
        let (mut starts, mut rows) = (pattern.starts.clone(), pattern.rows.clone());
        // SAFETY: the pattern has been checked above; the arrays are only read.
        let symbolic = unsafe { c::klu_l_analyze(n as i64, starts.as_mut_ptr(), rows.as_mut_ptr(), &mut *common) };
        let analysis = Self {
            starts,
            rows,
            common,
            symbolic,
        };
        if symbolic.is_null() {
            Err(analysis.fault())
        } else {
            Ok(analysis)
        }
    }

    fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Last error reported by KLU.
    fn fault(&self) -> KluError {
        let column = self.common.singular_col;
        if self.common.status == i64::from(c::KLU_SINGULAR) {
            KluError::Singular {
                column: usize::try_from(column)
                    .unwrap_or(0)
                    .min(self.columns().saturating_sub(1)),
            }
        } else {
            KluError::Package {
                status: self.common.status,
            }
        }
    }
}

impl Drop for Analysis {
    fn drop(&mut self) {
        if !self.symbolic.is_null() {
            // SAFETY: created by `klu_l_analyze`, freed once.
            unsafe { c::klu_l_free_symbolic(&mut self.symbolic, &mut *self.common) };
        }
    }
}

/// LU factors of matrices with a common pattern.
pub struct Klu {
    analysis: Analysis,
    numeric: *mut c::klu_l_numeric,
    /// The factors stored by rows; none without factors, or if there are too many entries.
    rows: Option<Rows>,
    growth_when_fresh: f64,
    /// Growth below which old pivots are discarded; 0 disables the check.
    ///
    /// At the default 1e-6 the factors are exact for a matrix within about ε / 1e-6 = 2e-10 of the given one. Newton's iteration does not
    /// notice such a difference. Over the runs of `tests/solvers/sundials` the growth stays between 0.5 and 1.
    pub smallest_growth: f64,
    /// Numerical factorizations, including refactorizations.
    pub factorizations: u64,
    /// Repeated factorizations because of bad old pivots.
    pub pivot_refreshes: u64,
}

impl Klu {
    /// Analyzes a square pattern: block triangular form, AMD ordering, rows scaled by their largest entry.
    pub fn new(pattern: &Pattern) -> Result<Self, KluError> {
        Ok(Self {
            analysis: Analysis::new(pattern)?,
            numeric: ptr::null_mut(),
            rows: None,
            growth_when_fresh: 1.0,
            smallest_growth: 1e-6,
            factorizations: 0,
            pivot_refreshes: 0,
        })
    }

    /// Number of unknowns.
    pub fn columns(&self) -> usize {
        self.analysis.columns()
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.analysis.rows.len()
    }

    /// Number of bytes of the present factors that one solution reads; 0 without factors.
    pub fn bytes(&self) -> usize {
        self.rows.as_ref().map_or(0, Rows::bytes)
    }

    /// Factors the matrix with the entries `values`, in the order of the pattern. Old pivots are reused as long as they are good.
    ///
    /// After an error there are no factors. Panics if the number of values differs from that of the pattern.
    pub fn factor(&mut self, values: &[f64]) -> Result<(), KluError> {
        assert_eq!(values.len(), self.entries(), "values of another pattern");
        if !self.numeric.is_null() {
            if self.refactor(values) {
                self.take_rows();
                return Ok(());
            }
            self.pivot_refreshes += 1;
        }
        self.factor_anew(values)
    }

    /// Discards the factors: the next factorization chooses its pivots anew.
    pub fn forget(&mut self) {
        self.free_numeric();
        self.growth_when_fresh = 1.0;
    }

    /// Factors with the old pivots; returns false if they are bad.
    fn refactor(&mut self, values: &[f64]) -> bool {
        self.factorizations += 1;
        // SAFETY: pattern, symbolic and numeric belong together, values has the pattern's length; KLU only reads them.
        let done = unsafe {
            c::klu_l_refactor(
                self.analysis.starts.as_mut_ptr(),
                self.analysis.rows.as_mut_ptr(),
                values.as_ptr().cast_mut(),
                self.analysis.symbolic,
                self.numeric,
                &mut *self.analysis.common,
            )
        };
        if done == 0 || self.analysis.common.status != i64::from(c::KLU_OK) {
            return false;
        }
        // a block of one row cannot grow: only a zero pivot indicates its singularity
        // SAFETY: as above.
        let regular = unsafe { c::klu_l_rcond(self.analysis.symbolic, self.numeric, &mut *self.analysis.common) } != 0;
        if !regular || self.analysis.common.rcond == 0.0 {
            return false;
        }
        if self.smallest_growth <= 0.0 {
            return true;
        }
        // if the growth is small even with fresh pivots, choosing them again does not help
        let limit = self.smallest_growth.min(0.1 * self.growth_when_fresh);
        self.growth(values) >= limit
    }

    /// Factors with pivots chosen for these values.
    fn factor_anew(&mut self, values: &[f64]) -> Result<(), KluError> {
        self.free_numeric();
        self.factorizations += 1;
        // SAFETY: pattern and symbolic belong together, values has the pattern's length; KLU only reads them.
        self.numeric = unsafe {
            c::klu_l_factor(
                self.analysis.starts.as_mut_ptr(),
                self.analysis.rows.as_mut_ptr(),
                values.as_ptr().cast_mut(),
                self.analysis.symbolic,
                &mut *self.analysis.common,
            )
        };
        if self.numeric.is_null() || self.analysis.common.status != i64::from(c::KLU_OK) {
            let fault = self.analysis.fault();
            self.free_numeric();
            return Err(fault);
        }
        if self.smallest_growth > 0.0 {
            self.growth_when_fresh = self.growth(values);
        }
        // SAFETY: KLU has created both for this matrix, and has factored it.
        self.rows = unsafe { Rows::new(&*self.analysis.symbolic, &*self.numeric) };
        self.take_rows();
        Ok(())
    }

    fn take_rows(&mut self) {
        if let Some(rows) = &mut self.rows {
            // SAFETY: rows belong to the last fresh factors; the present factors have the same pivots.
            unsafe { rows.take(&*self.numeric) };
        }
    }

    /// `min_j max_i |aᵢⱼ| / max_i |uᵢⱼ|` of the present factors: 1 is good, ε is useless.
    fn growth(&mut self, values: &[f64]) -> f64 {
        // SAFETY: as in `refactor`.
        unsafe {
            c::klu_l_rgrowth(
                self.analysis.starts.as_mut_ptr(),
                self.analysis.rows.as_mut_ptr(),
                values.as_ptr().cast_mut(),
                self.analysis.symbolic,
                self.numeric,
                &mut *self.analysis.common,
            );
        }
        self.analysis.common.rgrowth
    }

    /// Sign of the determinant of the last factored matrix: 1, -1, or 0 without factors. The sign remains correct where a product of the
    /// pivots would underflow.
    pub fn determinant_sign(&self) -> i8 {
        if self.numeric.is_null() {
            return 0;
        }
        let n = self.columns();
        // SAFETY: symbolic and numeric belong together; KLU stores n pivots and two permutations of length n. Scale factors of rows are
        // positive.
        let (pivots, rows, columns) = unsafe {
            (
                std::slice::from_raw_parts((*self.numeric).Udiag.cast::<f64>(), n),
                std::slice::from_raw_parts((*self.numeric).Pnum, n),
                std::slice::from_raw_parts((*self.analysis.symbolic).Q, n),
            )
        };
        let negative = pivots.iter().filter(|pivot| **pivot < 0.0).count();
        let odd = (negative + transpositions(rows) + transpositions(columns)) % 2 == 1;
        if odd { -1 } else { 1 }
    }

    /// Replaces `b` by the solution of `A x = b`; returns false without factors. Panics if `b` has a wrong length.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        assert_eq!(b.len(), self.columns(), "right-hand side of another size");
        match &mut self.rows {
            Some(rows) => {
                rows.solve(b);
                true
            }
            None => self.solve_block(b),
        }
    }

    /// Like [`Klu::solve`], but for several right-hand sides, stored one after the other in `b`.
    pub fn solve_block(&mut self, b: &mut [f64]) -> bool {
        let n = self.columns();
        assert!(n > 0 && b.len().is_multiple_of(n), "right-hand sides of another size");
        if self.numeric.is_null() {
            return false;
        }
        let (n, count) = (n as i64, (b.len() / n) as i64);
        let Analysis { symbolic, common, .. } = &mut self.analysis;
        // SAFETY: symbolic and numeric belong together and b has n entries for each of count right-hand sides.
        unsafe { c::klu_l_solve(*symbolic, self.numeric, n, count, b.as_mut_ptr(), &mut **common) != 0 }
    }

    fn free_numeric(&mut self) {
        self.rows = None;
        if !self.numeric.is_null() {
            // SAFETY: created by `klu_l_factor`; KLU sets the pointer to null.
            unsafe { c::klu_l_free_numeric(&mut self.numeric, &mut *self.analysis.common) };
        }
    }
}

/// Number of transpositions of a permutation.
fn transpositions(permutation: &[i64]) -> usize {
    let mut seen = vec![false; permutation.len()];
    let mut exchanges = 0;
    for start in 0..permutation.len() {
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            at = permutation[at] as usize;
            exchanges += usize::from(at != start);
        }
    }
    exchanges
}

impl Drop for Klu {
    fn drop(&mut self) {
        self.free_numeric();
    }
}
