//! Functions called by SUNDIALS: residual, Jacobian and error weights of a [`Dae`].
//!
//! Return codes: 0 success, +1 try a shorter step, -1 stop. The first fatal error or panic is stored in the [`CallbackData`].

use std::any::Any;
use std::ffi::{c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use sundials_sys as s;
use sundials_sys::{N_Vector, SUNMatrix};

use super::linear_solver::system_of;
use super::sensitivities::Slopes;
use super::vector::{entries, entries_mut};
use crate::dae::{Dae, EvaluationError, Seeds};
use crate::integrate::not_finite;
use crate::numerics::kernels;

/// Reason why a callback ended an integration.
pub(super) enum Stop {
    /// [`EvaluationError::Fatal`].
    Fatal(String),
    /// A panic, with its payload.
    Panic(Box<dyn Any + Send>),
}

/// System of equations that C accesses via `user_data`.
pub(super) struct CallbackData<D> {
    /// The equations.
    pub dae: D,
    /// Relative tolerance.
    pub relative: f64,
    /// Absolute tolerances, one for each unknown.
    pub absolute: Vec<f64>,
    /// Reason to stop.
    pub stop: Option<Stop>,
    /// Last recoverable error.
    pub recoverable: Option<String>,
    /// Number of residual evaluations.
    pub residuals: u64,
    /// Number of Jacobian evaluations.
    pub jacobians: u64,
    /// Wall time of residuals.
    pub residual_wall: Duration,
    /// Wall time of Jacobians.
    pub jacobian_wall: Duration,
    /// Wall time of integrands.
    pub integrand_wall: Duration,
    /// IDA's memory, which provides `c_j` of the attempted step; null without IDA.
    pub ida: *mut c_void,
    /// Derivatives of the residual by parameters, at the state of the last step.
    pub slopes: Slopes,
}

impl<D: Dae> CallbackData<D> {
    /// Creates a bridge for equations with tolerances.
    pub(super) fn new(dae: D, relative: f64, absolute: Vec<f64>) -> Self {
        Self {
            dae,
            relative,
            absolute,
            stop: None,
            recoverable: None,
            residuals: 0,
            jacobians: 0,
            residual_wall: Duration::ZERO,
            jacobian_wall: Duration::ZERO,
            integrand_wall: Duration::ZERO,
            ida: std::ptr::null_mut(),
            slopes: Slopes::default(),
        }
    }

    /// Evaluates the equations: errors and panics are stored and converted to return codes.
    pub(super) fn call(&mut self, act: impl FnOnce(&mut D) -> Result<(), EvaluationError>) -> c_int {
        let dae = &mut self.dae;
        match catch_unwind(AssertUnwindSafe(|| act(dae))) {
            Ok(Ok(())) => 0,
            Ok(Err(EvaluationError::Recoverable(what))) => {
                self.recoverable = Some(what);
                1
            }
            Ok(Err(EvaluationError::Fatal(what))) => {
                self.stop.get_or_insert(Stop::Fatal(what));
                -1
            }
            Err(payload) => {
                self.stop.get_or_insert(Stop::Panic(payload));
                -1
            }
        }
    }
}

/// The bridge from the user data, and two read-only vectors.
///
/// # Safety
/// Nobody else borrows the bridge while C runs; the vectors are valid serial ones, which nobody writes to meanwhile.
pub(super) unsafe fn seen<'v, D>(
    data: *mut c_void,
    y: N_Vector,
    yp: N_Vector,
) -> (&'v mut CallbackData<D>, &'v [f64], &'v [f64]) {
    // SAFETY: by contract.
    unsafe { (&mut *data.cast::<CallbackData<D>>(), entries(y), entries(yp)) }
}

/// `IDAResFn` with a [`CallbackData`] as user data.
pub(super) unsafe extern "C" fn residual<D: Dae>(
    t: f64,
    y: N_Vector,
    yp: N_Vector,
    out: N_Vector,
    data: *mut c_void,
) -> c_int {
    // SAFETY: user data is the bridge, which nobody else borrows while C runs; the vectors are different serial ones.
    let ((bridge, y, yp), out) = unsafe { (seen::<D>(data, y, yp), entries_mut(out)) };
    let begin = Instant::now();
    let mut cj = 0.0;
    // SAFETY: IDA's memory is alive while it calls, and is only read; `cj` is valid for writing.
    if !bridge.ida.is_null() && unsafe { s::IDAGetCurrentCj(bridge.ida, &raw mut cj) } == s::IDA_SUCCESS {
        bridge.dae.approach(cj);
    }
    let code = bridge.call(|dae| {
        dae.residual(t, y, yp, out)?;
        match kernels::first_not_finite(out) {
            None => Ok(()),
            Some(i) => Err(EvaluationError::Recoverable(format!(
                "the equation of {} gives {} at t = {t:.6e} s",
                dae.name(i),
                out[i]
            ))),
        }
    });
    bridge.residuals += 1;
    bridge.residual_wall += begin.elapsed();
    code
}

/// `IDALsJacFn` with a [`CallbackData`] as user data; writes into the system behind the matrix.
#[allow(clippy::too_many_arguments)] // SUNDIALS' signature
pub(super) unsafe extern "C" fn jacobian<D: Dae>(
    t: f64,
    cj: f64,
    y: N_Vector,
    yp: N_Vector,
    _: N_Vector,
    matrix: SUNMatrix,
    data: *mut c_void,
    _: N_Vector,
    _: N_Vector,
    _: N_Vector,
) -> c_int {
    // SAFETY: user data is the bridge and the matrix contains the linear system; nobody else borrows them while C
    // runs; the vectors are only read.
    let ((bridge, y, yp), system) = unsafe { (seen::<D>(data, y, yp), system_of(matrix)) };
    let begin = Instant::now();
    let code = bridge.call(|dae| {
        dae.jacobian(t, y, yp, Seeds::Step { cj }, &mut system.values)?;
        match kernels::first_not_finite(&system.values) {
            None => Ok(()),
            Some(entry) => Err(EvaluationError::Recoverable(not_finite(dae, entry, t))),
        }
    });
    bridge.jacobians += 1;
    bridge.jacobian_wall += begin.elapsed();
    code
}

/// `IDAEwtFn` with a [`CallbackData`] as user data: `wᵢ = 1 / (relative |yᵢ| + absoluteᵢ)`.
pub(super) unsafe extern "C" fn weights<D: Dae>(y: N_Vector, w: N_Vector, data: *mut c_void) -> c_int {
    // SAFETY: user data is the bridge, which nobody else borrows while C runs; w is another vector than y.
    let (bridge, y, w) = unsafe { (&*data.cast::<CallbackData<D>>(), entries(y), entries_mut(w)) };
    if kernels::error_weights(y, bridge.relative, &bridge.absolute, w) {
        0
    } else {
        -1
    }
}
