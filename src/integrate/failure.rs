//! Errors of integrators.

use std::fmt;

use crate::dae::Dae;

/// Unknown with the largest error relative to its tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstUnknown {
    /// Index of the unknown.
    pub unknown: usize,
    /// Name of the unknown, for messages.
    pub name: String,
    /// Estimated error (or last Newton correction) over tolerance.
    pub ratio: f64,
}

/// A failed step, or an invalid request.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegrationError {
    /// IDA's error code, negative; 0 if the error is not from IDA.
    pub code: i32,
    /// Meaning of the code.
    pub meaning: &'static str,
    /// Fatal error of the equations, verbatim.
    pub fatal: Option<String>,
    /// IDA's message, or the reason why the request is invalid.
    pub message: String,
    /// Time reached [s].
    pub time: f64,
    /// Size of the last attempted step [s].
    pub step: f64,
    /// Order of that step.
    pub order: u8,
    /// Unknown with the largest error, if a step has been attempted.
    pub worst: Option<WorstUnknown>,
    /// Last recoverable error of the equations since the last accepted step, if any.
    pub recoverable: Option<String>,
    /// Name of the unknown whose column had no pivot, if the last matrix was singular.
    pub singular: Option<String>,
}

impl IntegrationError {
    /// Error for an invalid request, at time `time` [s].
    pub(crate) fn request(message: String, time: f64) -> Box<Self> {
        Box::new(Self {
            code: 0,
            meaning: "invalid request",
            fatal: None,
            message,
            time,
            step: 0.0,
            order: 0,
            worst: None,
            recoverable: None,
            singular: None,
        })
    }
}

impl fmt::Display for IntegrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(fatal) = &self.fatal {
            return f.write_str(fatal);
        }
        write!(f, "{} at t = {:.6e} s", self.meaning, self.time)?;
        if self.step != 0.0 {
            write!(f, " with step {:.3e} s of order {}", self.step, self.order)?;
        }
        if let Some(name) = &self.singular {
            write!(f, "; the matrix is singular in the column of {name}")?;
        }
        if let Some(what) = &self.recoverable {
            write!(f, "; {what}")?;
        }
        if let Some(worst) = &self.worst {
            write!(
                f,
                "; worst unknown: {}, error {:.1e} times its tolerance",
                worst.name, worst.ratio
            )?;
        }
        if self.code == 0 && !self.message.is_empty() {
            write!(f, ": {}", self.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for IntegrationError {}

/// Message that names the derivative that is not finite; `entry` is its index in the pattern.
pub(crate) fn not_finite<D: Dae>(dae: &D, entry: usize, t: f64) -> String {
    let pattern = dae.pattern();
    let column = pattern.starts.partition_point(|&start| start as usize <= entry) - 1;
    let row = pattern.rows[entry] as usize;
    let (equation, unknown) = (dae.name(row), dae.name(column));
    format!("the derivative of the equation of {equation} by {unknown} is not finite at t = {t:.6e} s")
}
