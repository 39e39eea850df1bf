//! The figures of one case by name, and how the computation ended.

use serde::{Deserialize, Serialize};

use crate::error::{Error, visible};
use crate::run::summary::Status;

/// Relative difference of figures of one design that another computer may make.
const ALIKE: f64 = 1e-6;

/// What was found of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// How it ended.
    pub status: Status,
    /// Why, when it did not finish, or not as well as was asked.
    pub reason: Option<String>,
    /// Steps of time, of Newton along a path; none where there are none.
    pub steps: Option<u64>,
    /// Figures by name, unit included; `NAME.error` is the estimated error of NAME, relative.
    pub figures: Vec<(String, f64)>,
    /// Numbers of the warnings.
    pub warnings: Vec<String>,
    /// The warnings themselves, which no table has.
    #[serde(skip)]
    pub told: Vec<String>,
}

impl Found {
    /// Of what finished, to be filled.
    pub fn finished() -> Self {
        Self {
            status: Status::Finished,
            reason: None,
            steps: None,
            figures: vec![],
            warnings: vec![],
            told: vec![],
        }
    }

    /// That nothing was found.
    pub fn failed(error: &Error) -> Self {
        let told = match error {
            Error::Solver(fault) => fault.what.clone(),
            Error::Case(fault) => fault.violations.first().map_or(String::new(), |v| {
                let place = if v.pointer.is_empty() { "" } else { ": " };
                format!("{}{place}{}", v.pointer, v.what)
            }),
            other => other.to_string(),
        };
        Self {
            status: Status::Failed,
            reason: Some(format!("{} {}", error.code().id(), visible(&told))),
            ..Self::finished()
        }
    }

    /// Adds a figure, where it is a number.
    pub fn put(&mut self, name: impl Into<String>, value: impl Into<Option<f64>>) {
        if let Some(value) = value.into().filter(|x| x.is_finite()) {
            self.figures.push((name.into(), value));
        }
    }

    /// A figure by name.
    pub fn figure(&self, name: &str) -> Option<f64> {
        self.figures
            .iter()
            .find(|(own, _)| own == name)
            .map(|(_, value)| *value)
    }

    /// The first figure in which two that finished differ by more than computers do, with both values; NaN where one has none.
    pub fn conflict(&self, other: &Self) -> Option<(String, [f64; 2])> {
        let lack = |name: &str, one: &Self| one.figure(name).unwrap_or(f64::NAN);
        let all = self.figures.iter().chain(&other.figures).map(|(name, _)| name);
        let apart = |a: f64, b: f64| (a - b).abs() > ALIKE * a.abs().max(b.abs()) || a.is_nan() != b.is_nan();
        all.map(|name| (name, [lack(name, self), lack(name, other)]))
            .find(|(_, [a, b])| apart(*a, *b))
            .map(|(name, values)| (name.clone(), values))
    }

    /// Keeps warnings and their numbers, each once.
    pub fn warn(&mut self, warnings: &[String]) {
        for warning in warnings {
            if !self.told.contains(warning) {
                self.told.push(warning.clone());
            }
            let code = warning.split(' ').next().unwrap_or_default();
            if !self.warnings.iter().any(|own| own == code) {
                self.warnings.push(code.into());
            }
        }
    }
}

/// A status in a word, as files have it.
pub fn word(status: Status) -> &'static str {
    match status {
        Status::Finished => "finished",
        Status::Stopped => "stopped",
        Status::OutOfRange => "out_of_range",
        Status::Failed => "failed",
    }
}
