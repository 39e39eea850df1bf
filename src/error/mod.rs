//! All errors as one enum, each with its exit code.

use std::path::PathBuf;

mod code;
mod listed;
pub mod numbers;
mod visible;

pub use code::Code;
pub use listed::{listed, shown};
pub use visible::{is_hidden, visible};

/// A fault in a case: the problem, its place, the allowed values, and the nearest valid name.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Code of the fault.
    pub code: Code,
    /// JSON pointer of the offending value (or of its parent when something is missing), `""` for the whole file.
    pub pointer: String,
    /// The problem, in one sentence.
    pub what: String,
    /// Allowed values.
    pub allowed: Option<String>,
    /// Nearest valid name, if a name is unknown.
    pub nearest: Option<String>,
    /// Suggested remedy.
    pub hint: Option<String>,
    /// Pointers of other values that conflict with this one. The mistake may be in any of them.
    pub beside: Vec<String>,
    /// Bytes of the text to point at; filled in by [`crate::case`] from the pointer when absent.
    pub span: Option<std::ops::Range<usize>>,
    /// Argument of `--set` that set the value. `span` then refers to this argument instead of the file.
    pub set: Option<String>,
    /// Command-line option that gave this argument.
    pub option: &'static str,
}

impl Violation {
    /// Creates a fault at a JSON pointer.
    pub fn new(code: Code, pointer: impl Into<String>, what: impl Into<String>) -> Self {
        let (pointer, what) = (pointer.into(), what.into());
        Self {
            code,
            pointer,
            what,
            allowed: None,
            nearest: None,
            hint: None,
            beside: vec![],
            span: None,
            set: None,
            option: "--set",
        }
    }

    /// Sets the allowed values.
    pub fn allowed(self, allowed: impl Into<String>) -> Self {
        Self {
            allowed: Some(allowed.into()),
            ..self
        }
    }

    /// Sets the pointers of values that conflict with this one.
    pub fn beside(self, parts: &[&str]) -> Self {
        Self {
            beside: parts.iter().map(ToString::to_string).collect(),
            ..self
        }
    }

    /// Sets the remedy.
    pub fn hint(self, hint: impl Into<String>) -> Self {
        Self {
            hint: Some(hint.into()),
            ..self
        }
    }
}

/// An invalid case: its text and all its faults.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseError {
    /// File of the text.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// All faults found, in the order of the text.
    pub violations: Vec<Violation>,
}

/// Point at which a computation stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopPoint {
    /// A simulated time [s].
    Time(f64),
    /// A load factor: the share of the loads of an equilibrium.
    LoadFactor(f64),
}

impl StopPoint {
    /// Simulated time [s]; `None` for a load factor.
    pub fn time_s(self) -> Option<f64> {
        match self {
            Self::Time(time) => Some(time),
            Self::LoadFactor(_) => None,
        }
    }
}

/// A computation that the solver could not continue.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverError {
    /// Code of the error.
    pub code: Code,
    /// Last point with results.
    pub at: StopPoint,
    /// Description of the failure.
    pub what: String,
    /// Name and place of the worst unknown, if known.
    pub unknown: Option<String>,
    /// Likely cause.
    pub cause: Option<String>,
    /// Suggested remedy.
    pub hint: Option<String>,
}

/// Errors that end a command.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line is invalid (exit code 2).
    #[error("{0}")]
    Usage(String),
    /// The case is invalid (exit code 3).
    #[error("{} fault(s) in {}", .0.violations.len(), .0.path.display())]
    Case(Box<CaseError>),
    /// The solver could not continue (exit code 4).
    #[error("{}", .0.what)]
    Solver(Box<SolverError>),
    /// The command was interrupted before it had a result (exit code 4; after a signal, the exit code of the signal).
    #[error("{0}")]
    Interrupted(String),
    /// A file could not be read or written (exit code 5).
    #[error("cannot {action} {}: {source}", .path.display())]
    Output {
        /// Attempted action: "write", "create", "read".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
}

impl Error {
    /// Code of the error; for an invalid case, the code of its first fault.
    pub fn code(&self) -> Code {
        match self {
            Self::Usage(_) => Code::Usage,
            Self::Case(fault) => fault.violations.first().map_or(Code::Text, |v| v.code),
            Self::Solver(fault) => fault.code,
            Self::Interrupted(_) => Code::Interrupted,
            Self::Output { .. } => Code::File,
        }
    }

    /// Attributes the arguments `sets` of `--set` to another option, so that messages refer to that option.
    #[must_use]
    pub fn by(self, option: &'static str, sets: &[String]) -> Self {
        match self {
            Self::Case(mut fault) => {
                let own = |one: &&mut Violation| one.set.as_ref().is_some_and(|set| sets.contains(set));
                let all = fault.violations.iter_mut().filter(own);
                all.for_each(|one| one.option = option);
                Self::Case(fault)
            }
            Self::Usage(mut text) => {
                for (pointer, _) in sets.iter().filter_map(|set| set.split_once('=')) {
                    text = text.replace(&format!("--set '{pointer}="), &format!("{option} '{pointer}="));
                }
                Self::Usage(text)
            }
            other => other,
        }
    }

    /// Exit code of the process.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Case(_) => 3,
            Self::Solver(_) | Self::Interrupted(_) => 4,
            Self::Output { .. } => 5,
        }
    }
}

/// Result with [`Error`] as its error.
pub type Result<T> = std::result::Result<T, Error>;

/// Rejects a request, with the reason.
///
/// # Errors
/// Always [`Error::Usage`].
pub fn usage<T>(what: impl Into<String>) -> Result<T> {
    Err(Error::Usage(what.into()))
}
