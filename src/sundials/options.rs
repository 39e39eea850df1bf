//! Settings of IDA.

use crate::integrate::AbsoluteTolerances;

/// Settings of [`super::Ida`]. Weights of the error norm are `1 / (relative |yᵢ| + absoluteᵢ)`.
#[derive(Clone, Debug, PartialEq)]
pub struct IdaOptions {
    /// Relative tolerance, > 0.
    pub relative: f64,
    /// Absolute tolerances, > 0.
    pub absolute: AbsoluteTolerances,
    /// Highest order of the backward differentiation formula, 1 to 5. Orders of 3 and above are unstable for undamped
    /// waves.
    pub max_order: u8,
    /// Safety factor of Newton's convergence test; IDA's default is 0.33.
    pub nonlinear_coefficient: f64,
    /// Relative change of `c_j` that requires a new Jacobian; IDA's default is 0.25.
    pub delta_cj_setup: f64,
    /// First step [s]; chosen by IDA if absent.
    pub initial_step: Option<f64>,
    /// Largest step [s].
    pub max_step: Option<f64>,
    /// Maximum number of Newton failures in one step; IDA's default is 10.
    pub max_newton_failures: u16,
    /// Maximum number of Newton iterations in one solve; IDA's default is 4.
    pub max_newton_iterations: u16,
    /// Maximum number of error-test failures in one step; IDA's default is 10. Each failure after the first divides the step by four. A
    /// first step may have to become very short if algebraic unknowns move, because their rates are not yet known.
    pub max_error_test_failures: u16,
    /// Excludes algebraic unknowns from the error test.
    ///
    /// May help if algebraic unknowns are rates of differential ones (currents, reactions). Their error is one order
    /// lower and jumps with each change of the step size. IDA may then remain at order 1 and reject every other
    /// attempt.
    pub suppress_algebraic: bool,
}

impl Default for IdaOptions {
    fn default() -> Self {
        Self {
            relative: 1e-4,
            absolute: AbsoluteTolerances::Same(1e-6),
            max_order: 2,
            nonlinear_coefficient: 0.33,
            delta_cj_setup: 0.25,
            initial_step: None,
            max_step: None,
            max_newton_failures: 10,
            max_newton_iterations: 4,
            max_error_test_failures: 20,
            suppress_algebraic: false,
        }
    }
}

impl IdaOptions {
    /// Checks the settings for a system of `n` unknowns; the error names the first invalid one.
    pub fn check(&self, n: usize) -> Result<(), String> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        self.absolute.check(self.relative, n)?;
        if !(1..=5).contains(&self.max_order) {
            return Err(format!("the highest order must be 1 to 5, it is {}", self.max_order));
        }
        if !positive(self.nonlinear_coefficient) {
            return Err(format!(
                "the coefficient of Newton's test must be positive, it is {}",
                self.nonlinear_coefficient
            ));
        }
        if !(0.0..1.0).contains(&self.delta_cj_setup) {
            return Err(format!(
                "the change of c_j for a new Jacobian must be in [0, 1), it is {}",
                self.delta_cj_setup
            ));
        }
        for (step, what) in [(self.initial_step, "first"), (self.max_step, "largest")] {
            if let Some(value) = step.filter(|&value| !positive(value)) {
                return Err(format!("the {what} step must be positive, it is {value}"));
            }
        }
        Ok(())
    }
}
