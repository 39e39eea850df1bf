//! Error reports after a failure of the integrator.

use std::ffi::c_int;
use std::panic::resume_unwind;

use sundials_sys as s;

use super::callbacks::Stop;
use super::ida::Ida;
use crate::dae::Dae;
use crate::integrate::{IntegrationError, WorstUnknown};

impl<D: Dae> Ida<D> {
    /// Resumes a panic of the equations or of the linear solver.
    pub(super) fn raise_panic(&mut self) {
        if let Some(payload) = self.solver.system_mut().panic.take() {
            resume_unwind(payload);
        }
        match self.bridge.get_mut().stop.take() {
            Some(Stop::Panic(payload)) => resume_unwind(payload),
            other => self.bridge.get_mut().stop = other,
        }
    }

    /// Collects all information about a failure.
    pub(super) fn failure(&mut self, code: c_int) -> Box<IntegrationError> {
        let mut step = 0.0;
        // SAFETY: IDA is alive.
        unsafe { s::IDAGetCurrentStep(self.memory.0, &mut step) };
        let worst = self.worst();
        let bridge = self.bridge.get_mut();
        let fatal = match bridge.stop.take() {
            Some(Stop::Fatal(what)) => Some(what),
            _ => None,
        };
        Box::new(IntegrationError {
            code,
            meaning: meaning(code),
            fatal,
            message: self.messages.get().take(),
            time: self.time,
            step,
            order: self.last_order(),
            worst,
            recoverable: self.bridge.get_mut().recoverable.take(),
            singular: self.solver.system().singular.map(|column| self.dae().name(column)),
        })
    }

    /// The unknown with the largest weighted local error, or last Newton correction.
    fn worst(&mut self) -> Option<WorstUnknown> {
        let memory = self.memory.0;
        // SAFETY: IDA and the vector, to which it copies, are alive.
        let flag = unsafe { s::IDAGetEstLocalErrors(memory, self.scratch.raw()) };
        let errors = self.scratch.entries().to_vec();
        // SAFETY: as above.
        let other = unsafe { s::IDAGetErrWeights(memory, self.scratch.raw()) };
        if flag < 0 || other < 0 {
            return None;
        }
        let ratios = errors
            .iter()
            .zip(self.scratch.entries())
            .map(|(error, weight)| (error * weight).abs());
        let (unknown, ratio) = ratios.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        (ratio > 0.0).then(|| WorstUnknown {
            unknown,
            name: self.dae().name(unknown),
            ratio,
        })
    }
}

/// Meaning of IDA's codes.
pub(super) fn meaning(code: i32) -> &'static str {
    match code {
        s::IDA_TOO_MUCH_WORK => "too many steps were taken",
        s::IDA_TOO_MUCH_ACC => "the tolerances are too small for double precision",
        s::IDA_ERR_FAIL => "the error test failed too often, or the step became too small",
        s::IDA_CONV_FAIL => "Newton's iteration failed too often, or the step became too small",
        s::IDA_LINIT_FAIL => "the linear solver could not be initialised",
        s::IDA_LSETUP_FAIL => "the matrix could not be evaluated or factored",
        s::IDA_LSOLVE_FAIL => "the linear system could not be solved",
        s::IDA_RES_FAIL => "the equations could not be evaluated",
        s::IDA_REP_RES_ERR => "the equations could not be evaluated, however short the step",
        s::IDA_CONSTR_FAIL => "the constraints could not be met",
        s::IDA_FIRST_RES_FAIL => "the equations could not be evaluated at the start",
        s::IDA_NLS_INIT_FAIL | s::IDA_NLS_SETUP_FAIL | s::IDA_NLS_FAIL => "the nonlinear solver failed",
        s::IDA_MEM_NULL | s::IDA_NO_MALLOC => "the integrator is not initialised",
        s::IDA_MEM_FAIL => "there is no memory left",
        s::IDA_ILL_INPUT => "an input of the integrator is not allowed",
        s::IDA_BAD_EWT => "an error weight is not positive and finite",
        s::IDA_BAD_K => "a derivative of this order is not available",
        s::IDA_BAD_T => "the time is outside the last step",
        s::IDA_VECTOROP_ERR => "a vector operation failed",
        s::IDA_SRES_FAIL | s::IDA_QSRHS_FAIL => "the equations of a sensitivity could not be evaluated",
        s::IDA_REP_SRES_ERR | s::IDA_REP_QSRHS_ERR => {
            "the equations of a sensitivity could not be evaluated, however short the step"
        }
        _ => "the integrator failed",
    }
}
