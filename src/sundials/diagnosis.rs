//! What is to be said after the integrator has failed.

use std::ffi::c_int;
use std::panic::resume_unwind;

use sundials_sys as s;

use super::callbacks::Stop;
use super::failure::{IdaFailure, Worst, meaning};
use super::ida::Ida;
use crate::dae::Dae;

impl<D: Dae> Ida<D> {
    /// Lets a panic of the equations or of the linear solver go on.
    pub(super) fn raise_panic(&mut self) {
        if let Some(payload) = self.solver.system_mut().panic.take() {
            resume_unwind(payload);
        }
        match self.bridge.get_mut().stop.take() {
            Some(Stop::Panic(payload)) => resume_unwind(payload),
            other => self.bridge.get_mut().stop = other,
        }
    }

    /// Everything known about a failure.
    pub(super) fn failure(&mut self, code: c_int) -> Box<IdaFailure> {
        let mut step = 0.0;
        // SAFETY: IDA is alive.
        unsafe { s::IDAGetCurrentStep(self.memory.0, &mut step) };
        let worst = self.worst();
        let bridge = self.bridge.get_mut();
        let fatal = match bridge.stop.take() {
            Some(Stop::Fatal(what)) => Some(what),
            _ => None,
        };
        Box::new(IdaFailure {
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
    fn worst(&mut self) -> Option<Worst> {
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
        (ratio > 0.0).then(|| Worst {
            unknown,
            name: self.dae().name(unknown),
            ratio,
        })
    }
}
