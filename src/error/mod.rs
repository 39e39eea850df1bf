//! What can go wrong, as one enum, and the exit code of each.

use std::path::PathBuf;

mod code;
mod listed;
pub mod numbers;
mod visible;

pub use code::Code;
pub use listed::{listed, shown};
pub use visible::{is_hidden, visible};

/// One fault in a case: what, where, what is allowed, what was probably meant.
#[derive(Clone, Debug, PartialEq)]
pub struct Violation {
    /// Its number.
    pub code: Code,
    /// JSON pointer of the offending value (or of its parent when something is missing), `""` for the whole file.
    pub pointer: String,
    /// What is wrong, one sentence.
    pub what: String,
    /// What is allowed there.
    pub allowed: Option<String>,
    /// Nearest valid name, when a name was not known.
    pub nearest: Option<String>,
    /// What to do.
    pub hint: Option<String>,
    /// Pointers of other values that it does not go with: one of them may be what was changed.
    pub beside: Vec<String>,
    /// Bytes of the text to point at; filled in by [`crate::case`] from the pointer when absent.
    pub span: Option<std::ops::Range<usize>>,
    /// The `--set` argument the value came from; `span` then points into it instead of the file.
    pub set: Option<String>,
    /// The option that has this argument.
    pub option: &'static str,
}

impl Violation {
    /// A fault at a JSON pointer.
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

    /// Says what is allowed there.
    pub fn allowed(self, allowed: impl Into<String>) -> Self {
        Self {
            allowed: Some(allowed.into()),
            ..self
        }
    }

    /// Says with which other values it does not go, by their pointers.
    pub fn beside(self, parts: &[&str]) -> Self {
        Self {
            beside: parts.iter().map(ToString::to_string).collect(),
            ..self
        }
    }

    /// Says what to do.
    pub fn hint(self, hint: impl Into<String>) -> Self {
        Self {
            hint: Some(hint.into()),
            ..self
        }
    }
}

/// A case that cannot be used, with all its faults and the text they point into.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseError {
    /// Where the text came from.
    pub path: PathBuf,
    /// The text.
    pub text: String,
    /// All faults found, in the order of the text.
    pub violations: Vec<Violation>,
}

/// Where something could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// A simulated time [s].
    Time(f64),
    /// A load factor: the share of the loads of an equilibrium.
    LoadFactor(f64),
}

impl At {
    /// The simulated time [s], if it is one.
    pub fn time_s(self) -> Option<f64> {
        match self {
            Self::Time(time) => Some(time),
            Self::LoadFactor(_) => None,
        }
    }
}

/// A run that could not go on.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverError {
    /// Its number.
    pub code: Code,
    /// Up to where results stand.
    pub at: At,
    /// What happened, in words.
    pub what: String,
    /// Unknown that is worst, by name and place, when known.
    pub unknown: Option<String>,
    /// Likely cause.
    pub cause: Option<String>,
    /// What to try.
    pub hint: Option<String>,
}

/// Everything that ends a command without success.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The command line makes no sense (exit code 2).
    #[error("{0}")]
    Usage(String),
    /// The case is not valid (exit code 3).
    #[error("{} fault(s) in {}", .0.violations.len(), .0.path.display())]
    Case(Box<CaseError>),
    /// The solver could not go on (exit code 4).
    #[error("{}", .0.what)]
    Solver(Box<SolverError>),
    /// Somebody ended the command before it had a result (exit code 4; after a signal that of the signal).
    #[error("{0}")]
    Interrupted(String),
    /// A file could not be read or written (exit code 5).
    #[error("cannot {action} {}: {source}", .path.display())]
    Output {
        /// What was tried: "write", "create", "read".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
}

impl Error {
    /// Number of the message; that of the first fault of a case.
    pub fn code(&self) -> Code {
        match self {
            Self::Usage(_) => Code::Usage,
            Self::Case(fault) => fault.violations.first().map_or(Code::Text, |v| v.code),
            Self::Solver(fault) => fault.code,
            Self::Interrupted(_) => Code::Interrupted,
            Self::Output { .. } => Code::File,
        }
    }

    /// The same where some arguments of `--set` were made of another option: that is the one to point at.
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

/// Result with the house's error.
pub type Result<T> = std::result::Result<T, Error>;
