//! Differential-algebraic systems `F(t, y, y') = 0`, and the beam as one of them. Knows no solver.

pub mod beam;
mod between;
mod chain;
mod corotation;
mod jumps;
pub mod perturbed;
pub mod statics;
pub mod trace;
mod turns;

pub use beam::BeamDae;
pub use corotation::{Corotation, Vectors};
pub use perturbed::PerturbedSystems;
pub use statics::StaticBeam;

use std::ops::Range;

use crate::numerics::Planar;
use crate::sparse::Pattern;

/// Why an evaluation could not be done.
#[derive(Clone, Debug, PartialEq)]
pub enum EvaluationError {
    /// A shorter step may succeed: the solver may try again.
    Recoverable(String),
    /// No step can succeed.
    Fatal(String),
}

impl EvaluationError {
    /// The reason in words.
    pub fn reason(self) -> String {
        match self {
            Self::Recoverable(what) | Self::Fatal(what) => what,
        }
    }
}

/// Which combination of partial derivatives a Jacobian holds: column j is `y[j] ∂F/∂y_j + yp[j] ∂F/∂y'_j`.
#[derive(Clone, Copy, Debug)]
pub enum Seeds<'a> {
    /// `∂F/∂y + c_j ∂F/∂y'`, the matrix of an implicit step.
    Step {
        /// IDA's `c_j`, proportional to 1/step.
        cj: f64,
    },
    /// Any factors, one pair a column.
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

    /// True where the unknown's derivative appears (differential), false where it does not (algebraic). Length `len`.
    fn differential(&self) -> &[bool];

    /// Positions of the Jacobian's stored entries, the same for all times and states.
    fn pattern(&self) -> &Pattern;

    /// Writes `F(t, y, y')` into `residual`. All slices have length `len`. Allocates nothing.
    fn residual(&mut self, t: f64, y: &[f64], yp: &[f64], residual: &mut [f64]) -> Result<(), EvaluationError>;

    /// Writes the entries of the Jacobian in the order of [`Dae::pattern`] into `values`. Allocates nothing.
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> Result<(), EvaluationError>;

    /// Tells `c_j` of the implicit step for which residuals and Jacobians are asked for from now on: the rate of an unknown moves by so
    /// much with it. Equations may be written so that they are nearly linear along such a step; their roots are the same.
    fn approach(&mut self, _cj: f64) {}

    /// Unknowns that turn with the beam; none where nothing turns, or not so that its forces would turn with it.
    fn vectors(&self) -> Vec<Vectors> {
        vec![]
    }

    /// Unit vectors along the beam at the first nodes, in the state in which [`Dae::residual`] was evaluated last.
    fn directions(&self, _out: &mut [Planar<f64>]) {}

    /// Number of integrals that the solver carries along without feedback, `I' = g(t, y, y')`.
    fn integrals(&self) -> usize {
        0
    }

    /// The integrals of powers: their integrands are quadratic in the state, those of the others linear.
    fn integrals_of_powers(&self) -> Range<usize> {
        0..0
    }

    /// Writes the integrands `g(t, y, y')`; `out` has length [`Dae::integrals`]. Allocates nothing.
    fn integrands(&mut self, _t: f64, _y: &[f64], _yp: &[f64], _out: &mut [f64]) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// Writes `F_y dyₖ + F_y' dy'ₖ` into `out[k]` for every direction k: `dy`, `dyp` and `out` are equally many slices of length
    /// `len`. This one goes through the Jacobian, whose columns add up to it; it allocates.
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

    /// Number of parameters whose sensitivities `∂y/∂σₖ` the solver may carry along.
    fn parameters(&self) -> usize {
        0
    }

    /// Writes `∂F/∂σₖ` at fixed unknowns and rates into `out`, of length `len`; k is below [`Dae::parameters`].
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

    /// Name of an unknown, for people: `"u1 [m] of node 3"`.
    fn name(&self, unknown: usize) -> String;

    /// True when there is nothing to solve.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
