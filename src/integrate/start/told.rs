//! What a consistent start is asked for, and what is told of it.

use std::fmt;

/// Settings of [`super::consistent_start`].
#[derive(Clone, Debug, PartialEq)]
pub struct StartOptions {
    /// Correction, relative to 1 + |unknown|, below which the values count as consistent.
    pub tolerance: f64,
    /// Newton steps allowed.
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

/// How consistent values were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Newton steps.
    pub iterations: u16,
    /// Residuals evaluated.
    pub residual_evaluations: u64,
    /// Last correction, largest relative to 1 + |unknown|.
    pub correction: f64,
    /// Largest residual left.
    pub residual: f64,
}

/// Why no consistent values were found.
#[derive(Clone, Debug, PartialEq)]
pub struct StartError {
    /// What happened.
    pub what: String,
    /// Unknown that is worst, by position and name.
    pub worst: Option<(usize, String)>,
    /// Newton steps done.
    pub iterations: u16,
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no consistent start: {}", self.what)?;
        match &self.worst {
            Some((_, name)) => write!(f, "; worst is {name}, after {} iterations", self.iterations),
            None => Ok(()),
        }
    }
}

impl std::error::Error for StartError {}
