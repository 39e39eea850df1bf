//! Settings of a one-step method.

use super::tableau::TableauMethod;
use crate::case::schema;
use crate::integrate::AbsoluteTolerances;

/// Settings of [`super::OneStep`]. Weights of the error norm are IDA's, `1 / (relative |yᵢ| + absoluteᵢ)`.
#[derive(Clone, Debug, PartialEq)]
pub struct OneStepOptions {
    /// Coefficients.
    pub method: TableauMethod,
    /// Relative tolerance, > 0.
    pub relative: f64,
    /// Absolute tolerances, > 0.
    pub absolute: AbsoluteTolerances,
    /// Remaining error of Newton's iteration as a fraction of the tolerance; absent:
    /// [`super::Tableau::newton_tolerance`].
    pub newton_tolerance: Option<f64>,
    /// Relative change of `1/(h γ)` that requires a new matrix.
    pub matrix_band: f64,
    /// First step [s] after every restart; chosen automatically if absent.
    pub initial_step: Option<f64>,
    /// Largest step [s].
    pub max_step: Option<f64>,
    /// Maximum number of failures in one step, of Newton's iteration and of the error test together.
    pub max_failures: u16,
}

impl Default for OneStepOptions {
    fn default() -> Self {
        Self {
            method: TableauMethod::Esdirk34,
            relative: 1e-4,
            absolute: AbsoluteTolerances::Same(1e-6),
            newton_tolerance: None,
            matrix_band: 0.3,
            initial_step: None,
            max_step: None,
            max_failures: 30,
        }
    }
}

/// Name of the method in a case.
impl From<TableauMethod> for schema::Method {
    fn from(method: TableauMethod) -> Self {
        match method {
            TableauMethod::TrBdf2 => Self::Trbdf2,
            TableauMethod::Esdirk34 => Self::Esdirk34,
            TableauMethod::Esdirk46 => Self::Esdirk46,
            TableauMethod::Esdirk57 => Self::Esdirk57,
        }
    }
}

impl OneStepOptions {
    /// Checks the settings for a system of `n` unknowns; the error names the first invalid one.
    pub fn check(&self, n: usize) -> Result<(), String> {
        self.absolute.check(self.relative, n)?;
        let positive = |value: f64| value.is_finite() && value > 0.0;
        for (value, what) in [
            (self.newton_tolerance.unwrap_or(1.0), "tolerance of Newton's iteration"),
            (self.matrix_band, "change of the step for a new matrix"),
            (self.initial_step.unwrap_or(1.0), "first step"),
            (self.max_step.unwrap_or(1.0), "largest step"),
        ] {
            if !positive(value) {
                return Err(format!("the {what} must be positive, it is {value}"));
            }
        }
        Ok(())
    }
}
