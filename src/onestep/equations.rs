//! System of equations with counters and timers; converts errors to `StageError`.

use std::time::{Duration, Instant};

use crate::dae::{Dae, EvaluationError, Seeds};
use crate::integrate::not_finite;
use crate::numerics::kernels;

/// Reason why a step attempt was abandoned.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StageError {
    /// Newton's iteration does not converge.
    Newton,
    /// No pivot is left in a column.
    Singular(usize),
    /// The equations require a shorter step.
    Recoverable(String),
    /// No step can succeed.
    Fatal(String),
}

impl From<EvaluationError> for StageError {
    fn from(fault: EvaluationError) -> Self {
        match fault {
            EvaluationError::Recoverable(what) => Self::Recoverable(what),
            EvaluationError::Fatal(what) => Self::Fatal(what),
        }
    }
}

/// A [`Dae`] with counters and timers.
pub(super) struct Equations<D> {
    pub dae: D,
    pub residuals: u64,
    pub jacobians: u64,
    pub residual_wall: Duration,
    pub jacobian_wall: Duration,
    pub integrand_wall: Duration,
}

impl<D: Dae> Equations<D> {
    pub fn new(dae: D) -> Self {
        Self {
            dae,
            residuals: 0,
            jacobians: 0,
            residual_wall: Duration::ZERO,
            jacobian_wall: Duration::ZERO,
            integrand_wall: Duration::ZERO,
        }
    }

    /// Evaluates `F(t, y, y')`; a result that is not finite is an error that names the equation.
    pub fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), StageError> {
        let begin = Instant::now();
        let done = self.dae.residual(t, y, yp, out);
        self.residuals += 1;
        let finite = kernels::first_not_finite(out);
        self.residual_wall += begin.elapsed();
        done?;
        match finite {
            None => Ok(()),
            Some(i) => Err(StageError::Recoverable(format!(
                "the equation of {} gives {} at t = {t:.6e} s",
                self.dae.name(i),
                out[i]
            ))),
        }
    }

    /// Evaluates `∂F/∂y + cj ∂F/∂y'` in the order of the pattern.
    pub fn jacobian(&mut self, t: f64, y: &[f64], yp: &[f64], cj: f64, values: &mut [f64]) -> Result<(), StageError> {
        let begin = Instant::now();
        let done = self.dae.jacobian(t, y, yp, Seeds::Step { cj }, values);
        self.jacobians += 1;
        let finite = kernels::first_not_finite(values);
        self.jacobian_wall += begin.elapsed();
        done?;
        match finite {
            None => Ok(()),
            Some(entry) => Err(StageError::Recoverable(not_finite(&self.dae, entry, t))),
        }
    }

    /// Evaluates the integrands of the integrals computed along with the solution.
    pub fn integrands(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), StageError> {
        let begin = Instant::now();
        let done = self.dae.integrands(t, y, yp, out);
        self.integrand_wall += begin.elapsed();
        Ok(done?)
    }
}
