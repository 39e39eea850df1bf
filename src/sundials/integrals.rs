//! Integrals carried along by IDA's own formula (IDAS' quadratures): no feedback, no error control.

use std::ffi::{c_int, c_void};

use sundials_sys as s;

use super::callbacks::seen;
use super::ida::Ida;
use super::vector::{Vector, entries_mut};
use crate::dae::Dae;
use crate::integrate::IntegrationError;

/// `IDAQuadRhsFn` with a [`Bridge`] as user data.
pub(super) unsafe extern "C" fn integrands<D: Dae>(
    t: f64,
    y: s::N_Vector,
    yp: s::N_Vector,
    out: s::N_Vector,
    data: *mut c_void,
) -> c_int {
    // SAFETY: user data is the bridge, borrowed by nobody else while C runs; the vectors are different serial ones.
    let ((bridge, y, yp), out) = unsafe { (seen::<D>(data, y, yp), entries_mut(out)) };
    let begin = std::time::Instant::now();
    let code = bridge.call(|dae| dae.integrands(t, y, yp, out));
    bridge.integrand_wall += begin.elapsed();
    code
}

/// Starts the integrals of a new integrator at zero; `none` when the system has none.
pub(super) fn begin<D: Dae>(memory: *mut c_void, zeros: Option<&Vector>) -> c_int {
    match zeros {
        None => s::IDA_SUCCESS,
        // SAFETY: IDA and the vector, which it copies, are alive.
        Some(zeros) => match unsafe { s::IDAQuadInit(memory, Some(integrands::<D>), zeros.raw()) } {
            // SAFETY: IDA is alive.
            s::IDA_SUCCESS => unsafe { s::IDASetQuadErrCon(memory, 0) },
            refused => refused,
        },
    }
}

impl<D: Dae> Ida<D> {
    /// The integrals `∫ g dt` since the last restart: at the present time, or at a time [s] within the last
    /// step. `out` has length `dae.integrals()`.
    pub fn integrals(&mut self, time: Option<f64>, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        let Some(quadratures) = &mut self.quadratures else {
            return Ok(());
        };
        if self.stepped {
            let mut reached = self.time;
            // SAFETY: IDA and the vector are alive.
            let flag = unsafe {
                match time {
                    Some(t) => s::IDAGetQuadDky(self.memory.0, t, 0, quadratures.raw()),
                    None => s::IDAGetQuad(self.memory.0, &mut reached, quadratures.raw()),
                }
            };
            if flag < 0 {
                return Err(self.failure(flag));
            }
        }
        if let Some(quadratures) = &self.quadratures {
            out.copy_from_slice(quadratures.entries());
        }
        Ok(())
    }

    /// Sets the integrals back to zero at a restart.
    pub(super) fn reset_integrals(&mut self) -> c_int {
        let Some(quadratures) = &mut self.quadratures else {
            return s::IDA_SUCCESS;
        };
        quadratures.entries_mut().fill(0.0);
        // SAFETY: IDA and the vector, which it copies, are alive.
        unsafe { s::IDAQuadReInit(self.memory.0, quadratures.raw()) }
    }
}
