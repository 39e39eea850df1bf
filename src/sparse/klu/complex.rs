//! Sparse LU factors of complex matrices, for shifts off the real axis.

use std::ptr;

use nalgebra::Complex;

use super::{Analysis, KluError};
use crate::sparse::Pattern;
use crate::sparse::c;

/// LU factors of complex matrices with a common pattern. Pivots are chosen anew for every matrix: old ones cost digits.
pub struct ComplexKlu {
    analysis: Analysis,
    numeric: *mut c::klu_l_numeric,
}

// SAFETY: memory allocated by KLU belongs to no thread, and is accessible only through this value.
unsafe impl Send for ComplexKlu {}

impl ComplexKlu {
    /// Analyzes a square pattern: block triangular form, AMD ordering, rows scaled by their largest entry.
    pub fn new(pattern: &Pattern) -> Result<Self, KluError> {
        Ok(Self {
            analysis: Analysis::new(pattern)?,
            numeric: ptr::null_mut(),
        })
    }

    /// Factors the matrix with the entries `values`, in the order of the pattern.
    ///
    /// After an error there are no factors. Panics if the number of values differs from that of the pattern.
    pub fn factor(&mut self, values: &[Complex<f64>]) -> Result<(), KluError> {
        assert_eq!(values.len(), self.analysis.rows.len(), "values of another pattern");
        self.free_numeric();
        let a = &mut self.analysis;
        // SAFETY: pattern and symbolic belong together; values has the pattern's length; each value is a pair of
        // doubles
        // (`repr(C)`); KLU only reads them.
        self.numeric = unsafe {
            c::klu_zl_factor(
                a.starts.as_mut_ptr(),
                a.rows.as_mut_ptr(),
                values.as_ptr().cast::<f64>().cast_mut(),
                a.symbolic,
                &mut *a.common,
            )
        };
        if self.numeric.is_null() || self.analysis.common.status != i64::from(c::KLU_OK) {
            let fault = self.analysis.fault();
            self.free_numeric();
            return Err(fault);
        }
        Ok(())
    }

    /// Replaces `b` by the solution of `A x = b`; returns false without factors. Panics if `b` has a wrong length.
    pub fn solve(&mut self, b: &mut [Complex<f64>]) -> bool {
        self.solve_either(b, false)
    }

    /// Replaces `b` by the solution of `Aᴴ x = b`; returns false without factors. Panics if `b` has a wrong length.
    pub fn solve_adjoint(&mut self, b: &mut [Complex<f64>]) -> bool {
        self.solve_either(b, true)
    }

    fn solve_either(&mut self, b: &mut [Complex<f64>], adjoint: bool) -> bool {
        let a = &mut self.analysis;
        assert_eq!(b.len(), a.columns(), "right-hand side of another size");
        if self.numeric.is_null() {
            return false;
        }
        let (n, values) = (b.len() as i64, b.as_mut_ptr().cast::<f64>());
        // SAFETY: symbolic and numeric belong together and b has n entries, each a pair of doubles.
        let done = unsafe {
            if adjoint {
                c::klu_zl_tsolve(a.symbolic, self.numeric, n, 1, values, 1, &mut *a.common)
            } else {
                c::klu_zl_solve(a.symbolic, self.numeric, n, 1, values, &mut *a.common)
            }
        };
        done != 0
    }

    fn free_numeric(&mut self) {
        if !self.numeric.is_null() {
            // SAFETY: created by `klu_zl_factor`; KLU sets the pointer to null.
            unsafe { c::klu_zl_free_numeric(&mut self.numeric, &mut *self.analysis.common) };
        }
    }
}

impl Drop for ComplexKlu {
    fn drop(&mut self) {
        self.free_numeric();
    }
}
