//! The system of equations, counted and timed; faults become obstacles.

use std::time::{Duration, Instant};

use crate::dae::{Dae, EvaluationError, Seeds};
use crate::integrate::not_finite;
use crate::numerics::kernels;

/// Why an attempt at a step was given up.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StageError {
    /// Newton's iteration does not converge.
    Newton,
    /// No pivot is left in a column.
    Singular(usize),
    /// The equations ask for a shorter step.
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

/// A [`Dae`] with its account.
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

    /// `F(t, y, y')`; finite, or an obstacle that names the equation.
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

    /// `∂F/∂y + cj ∂F/∂y'` in the order of the pattern.
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

    /// Integrands of the integrals carried along.
    pub fn integrands(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), StageError> {
        let begin = Instant::now();
        let done = self.dae.integrands(t, y, yp, out);
        self.integrand_wall += begin.elapsed();
        Ok(done?)
    }
}
