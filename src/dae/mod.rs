//! Differential-algebraic systems `F(t, y, y') = 0`, and the beam as one of them. Independent of solvers.

mod angle_unwrapping;
pub mod beam;
mod corotation;
mod jacobian;
mod jumps;
pub mod perturbed;
mod projection;
pub mod sparsity_tracer;
pub mod statics;

pub use beam::BeamDae;
pub use corotation::{Corotation, RotatedVectors};
pub use perturbed::PerturbedSystems;
pub use statics::StaticBeam;

use std::ops::Range;

use crate::numerics::Planar;
use crate::sparse::Pattern;

/// Reason why an evaluation failed.
#[derive(Clone, Debug, PartialEq)]
pub enum EvaluationError {
    /// Recoverable: a shorter step may succeed.
    Recoverable(String),
    /// No step can succeed.
    Fatal(String),
}

impl EvaluationError {
    /// Reason as text.
    pub fn reason(self) -> String {
        match self {
            Self::Recoverable(what) | Self::Fatal(what) => what,
        }
    }
}

/// Combination of partial derivatives in a Jacobian: column j is `y[j] ∂F/∂y_j + yp[j] ∂F/∂y'_j`.
#[derive(Clone, Copy, Debug)]
pub enum Seeds<'a> {
    /// `∂F/∂y + c_j ∂F/∂y'`, the matrix of an implicit step.
    Step {
        /// IDA's `c_j`, proportional to 1/step.
        cj: f64,
    },
    /// Arbitrary factors, one pair per column.
    Columns {
        /// Factor of `∂F/∂y_j`.
        y: &'a [f64],
        /// Factor of `∂F/∂y'_j`.
        yp: &'a [f64],
    },
}

/// A differential-algebraic system of index one, `F(t, y, y') = 0`, every unknown scaled to order one.
pub trait Dae {
    /// Number of unknowns.
    fn len(&self) -> usize;

    /// True if the unknown's derivative appears (differential), false if it does not (algebraic). Length `len`.
    fn differential(&self) -> &[bool];

    /// Pattern of the Jacobian, equal for all times and states.
    fn pattern(&self) -> &Pattern;

    /// Writes `F(t, y, y')` to `residual`. All slices have length `len`. Does not allocate.
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError>;

    /// Writes the entries of the Jacobian to `values`, in the order of [`Dae::pattern`]. Does not allocate.
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError>;

    /// Sets `c_j` of the implicit step for subsequent residuals and Jacobians: the derivative of a rate by its unknown. Equations may be
    /// formulated such that they are nearly linear along such a step; their roots are unchanged.
    fn approach(&mut self, _cj: f64) {}

    /// Unknowns that rotate with the beam; none if there is no rotation, or if forces would not rotate with it.
    fn vectors(&self) -> Vec<RotatedVectors> {
        vec![]
    }

    /// Unit vectors along the beam at the first nodes, for the state of the last [`Dae::residual`].
    fn directions(&self, _out: &mut [Planar<f64>]) {}

    /// Number of integrals that the solver computes along with the solution, `I' = g(t, y, y')`, without feedback.
    fn integrals(&self) -> usize {
        0
    }

    /// Range of the integrals of powers: their integrands are quadratic in the state, all others linear.
    fn integrals_of_powers(&self) -> Range<usize> {
        0..0
    }

    /// Writes the integrands `g(t, y, y')`; `out` has length [`Dae::integrals`]. Does not allocate.
    fn integrands(&mut self, _t: f64, _y: &[f64], _yp: &[f64], _out: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// Writes `F_y dyₖ + F_y' dy'ₖ` to `out[k]` for every direction k; `dy`, `dyp` and `out` contain equally many slices of length `len`.
    /// The default sums the columns of the Jacobian; it allocates.
    fn tangent(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        [dy, dyp]: [&[&[f64]]; 2],
        out: &mut [&mut [f64]],
    ) -> Result<(), EvaluationError> {
        let mut values = vec![0.0; self.pattern().rows.len()];
        for ((dy, dyp), out) in dy.iter().zip(dyp).zip(out) {
            self.jacobian(t, y, yp, Seeds::Columns { y: dy, yp: dyp }, &mut values)?;
            out.fill(0.0);
            for (&row, value) in self.pattern().rows.iter().zip(&values) {
                out[row as usize] += value;
            }
        }
        Ok(())
    }

    /// Number of parameters whose sensitivities `∂y/∂σₖ` the solver may compute along with the solution.
    fn parameters(&self) -> usize {
        0
    }

    /// Writes `∂F/∂σₖ` at fixed unknowns and rates to `out`, of length `len`; k is below [`Dae::parameters`].
    fn parameter_derivative(
        &mut self,
        _k: usize,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        out.fill(0.0);
        Ok(())
    }

    /// Writes `g_y s + g_y' s' + ∂g/∂σₖ` of the integrands g along a sensitivity `[s, s']`; `out` has length
    /// [`Dae::integrals`].
    fn integrand_derivative(
        &mut self,
        _k: usize,
        _t: f64,
        _state: [&[f64]; 2],
        _along: [&[f64]; 2],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        out.fill(0.0);
        Ok(())
    }

    /// Name of an unknown, for messages: `"u1 [m] of node 3"`.
    fn name(&self, unknown: usize) -> String;

    /// True if there is nothing to solve.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
