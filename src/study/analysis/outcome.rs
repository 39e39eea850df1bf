//! Figures of one case by name, and the outcome of its computation.

use serde::{Deserialize, Serialize};

use crate::error::{Error, visible};
use crate::run::summary::Status;

/// Largest relative difference between figures of one design from two computers.
const ALIKE: f64 = 1e-6;

/// Result of the analysis of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AnalysisOutcome {
    /// Outcome of the computation.
    pub status: Status,
    /// Reason, if it did not finish or missed the requested accuracy.
    pub reason: Option<String>,
    /// Time steps, or Newton iterations along a path; `None` for an analysis without steps.
    pub steps: Option<u64>,
    /// Figures by name, unit included; `NAME.error` is the estimated error of NAME, relative.
    pub figures: Vec<(String, f64)>,
    /// Codes of the warnings.
    pub warnings: Vec<String>,
    /// Texts of the warnings, which tables do not contain.
    #[serde(skip)]
    pub messages: Vec<String>,
}

impl AnalysisOutcome {
    /// Creates an empty result with the status finished.
    pub fn finished() -> Self {
        Self {
            status: Status::Finished,
            reason: None,
            steps: None,
            figures: vec![],
            warnings: vec![],
            messages: vec![],
        }
    }

    /// Creates the result of a failed computation.
    pub fn failed(error: &Error) -> Self {
        let text = match error {
            Error::Solver(fault) => fault.what.clone(),
            Error::Case(fault) => fault.violations.first().map_or(String::new(), |v| {
                let place = if v.pointer.is_empty() { "" } else { ": " };
                format!("{}{place}{}", v.pointer, v.what)
            }),
            other => other.to_string(),
        };
        Self {
            status: Status::Failed,
            reason: Some(format!("{} {}", error.code().id(), visible(&text))),
            ..Self::finished()
        }
    }

    /// Adds a figure if it is a finite number.
    pub fn put(&mut self, name: impl Into<String>, value: impl Into<Option<f64>>) {
        if let Some(value) = value.into().filter(|x| x.is_finite()) {
            self.figures.push((name.into(), value));
        }
    }

    /// Returns a figure by name.
    pub fn figure(&self, name: &str) -> Option<f64> {
        self.figures
            .iter()
            .find(|(own, _)| own == name)
            .map(|(_, value)| *value)
    }

    /// Returns the first figure in which two finished results differ by more than computers do, with both values; NaN
    /// for a missing one.
    pub fn conflict(&self, other: &Self) -> Option<(String, [f64; 2])> {
        let lack = |name: &str, one: &Self| one.figure(name).unwrap_or(f64::NAN);
        let all = self.figures.iter().chain(&other.figures).map(|(name, _)| name);
        let apart = |a: f64, b: f64| (a - b).abs() > ALIKE * a.abs().max(b.abs()) || a.is_nan() != b.is_nan();
        all.map(|name| (name, [lack(name, self), lack(name, other)]))
            .find(|(_, [a, b])| apart(*a, *b))
            .map(|(name, values)| (name.clone(), values))
    }

    /// Stores warnings and their codes, each once.
    pub fn warn(&mut self, warnings: &[String]) {
        for warning in warnings {
            if !self.messages.contains(warning) {
                self.messages.push(warning.clone());
            }
            let code = warning.split(' ').next().unwrap_or_default();
            if !self.warnings.iter().any(|own| own == code) {
                self.warnings.push(code.into());
            }
        }
    }
}

/// Name of a status, as in files.
pub fn word(status: Status) -> &'static str {
    match status {
        Status::Finished => "finished",
        Status::Stopped => "stopped",
        Status::OutOfRange => "out_of_range",
        Status::Failed => "failed",
    }
}
