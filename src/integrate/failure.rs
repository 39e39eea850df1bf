//! Why the integrator could not go on.

use std::fmt;

use crate::dae::Dae;

/// The unknown whose error is largest against its tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Position.
    pub unknown: usize,
    /// Name, for people.
    pub name: String,
    /// Estimated error (or last Newton correction) over tolerance.
    pub ratio: f64,
}

/// A step that could not be done, or a request that cannot be met.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegrationError {
    /// IDA's code, negative; 0 when the failure is not IDA's.
    pub code: i32,
    /// What the code means.
    pub meaning: &'static str,
    /// The equations' own fatal fault, verbatim.
    pub fatal: Option<String>,
    /// IDA's message, or what was wrong with the request.
    pub message: String,
    /// Time reached [s].
    pub time: f64,
    /// Step last tried [s].
    pub step: f64,
    /// Order of that step.
    pub order: u8,
    /// The unknown that is worst, when a step has been tried.
    pub worst: Option<Worst>,
    /// Last recoverable fault of the equations, if any since the last accepted step.
    pub recoverable: Option<String>,
    /// Name of the unknown whose column had no pivot, when the last matrix was singular.
    pub singular: Option<String>,
}

impl IntegrationError {
    /// A request that cannot be met, at time `time` [s].
    pub(crate) fn request(message: String, time: f64) -> Box<Self> {
        Box::new(Self {
            code: 0,
            meaning: "the request cannot be met",
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
                "; worst is {} at {:.1e} times its tolerance",
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

/// Says which derivative is not finite; `entry` is a position in the pattern.
pub(crate) fn not_finite<D: Dae>(dae: &D, entry: usize, t: f64) -> String {
    let pattern = dae.pattern();
    let column = pattern.starts.partition_point(|&start| start as usize <= entry) - 1;
    let row = pattern.rows[entry] as usize;
    let (equation, unknown) = (dae.name(row), dae.name(column));
    format!("the derivative of the equation of {equation} by {unknown} is not finite at t = {t:.6e} s")
}
