//! Settings, result and error of a consistent start.

use std::fmt;

/// Settings of [`super::consistent_start`].
#[derive(Clone, Debug, PartialEq)]
pub struct StartOptions {
    /// Correction, relative to 1 + |unknown|, below which the values are consistent.
    pub tolerance: f64,
    /// Maximum number of Newton steps.
    pub max_iterations: u16,
    /// Smallest damping factor.
    pub smallest_damping: f64,
}

impl Default for StartOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-13,
            max_iterations: 100,
            smallest_damping: 1e-8,
        }
    }
}

/// Result of a consistent start.
#[derive(Clone, Debug, PartialEq)]
pub struct ConsistentStart {
    /// Number of Newton steps.
    pub iterations: u16,
    /// Number of residual evaluations.
    pub residual_evaluations: u64,
    /// Last correction: the largest relative to 1 + |unknown|.
    pub correction: f64,
    /// Largest remaining residual.
    pub residual: f64,
}

/// Error of a consistent start.
#[derive(Clone, Debug, PartialEq)]
pub struct StartError {
    /// Description of the failure.
    pub what: String,
    /// Unknown with the largest error, by index and name.
    pub worst: Option<(usize, String)>,
    /// Number of Newton steps done.
    pub iterations: u16,
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no consistent start: {}", self.what)?;
        match &self.worst {
            Some((_, name)) => write!(f, "; worst unknown: {name}, after {} iterations", self.iterations),
            None => Ok(()),
        }
    }
}

impl std::error::Error for StartError {}
