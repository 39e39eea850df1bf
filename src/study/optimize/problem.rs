//! What is sought, within what.

use serde::{Deserialize, Serialize};

use super::names::resolve;
use crate::case::Case;
use crate::case::parameter::{Parameter, with};
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::study::analysis::AnalysisKind;
use crate::study::evaluations::Evaluations;
use crate::study::span::{self, Span};

/// The figure that is to be largest or least.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Goal {
    /// The figure, by its name in the table of `slcbeam sweep`.
    pub figure: String,
    /// Whether the largest is sought; else the least.
    pub largest: bool,
}

impl Goal {
    /// 1 where the least is sought, -1 where the largest is.
    pub fn sign(&self) -> f64 {
        if self.largest { -1.0 } else { 1.0 }
    }
}

/// On which side of a limit a figure has to stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// It is at most the limit.
    AtMost,
    /// It is at least the limit.
    AtLeast,
}

/// What a figure has to hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// The figure.
    pub figure: String,
    /// On which side.
    pub side: Side,
    /// Of what, in its unit.
    pub bound: f64,
}

impl Limit {
    /// Of `FIGURE<=VALUE` or `FIGURE>=VALUE`.
    ///
    /// # Errors
    /// [`Error::Usage`] with what is wanted.
    pub fn parse(text: &str) -> Result<Self> {
        let sides = [("<=", Side::AtMost), (">=", Side::AtLeast)];
        let parts = sides.iter().find_map(|(sign, side)| {
            let (figure, bound) = text.split_once(sign)?;
            Some((figure.trim(), *side, bound.trim().parse::<f64>().ok()?))
        });
        match parts {
            Some((figure, side, bound)) if !figure.is_empty() && bound.is_finite() => Ok(Self {
                figure: figure.into(),
                side,
                bound,
            }),
            _ => Err(Error::Usage(format!(
                "--subject-to '{text}': a figure and its limit are wanted, such as 'max_pressure_pa<=2e4' or 'mode_1.frequency_hz>=12'"
            ))),
        }
    }

    /// As it is typed.
    pub fn sign(&self) -> &'static str {
        match self.side {
            Side::AtMost => "<=",
            Side::AtLeast => ">=",
        }
    }

    /// How far a figure is beyond the limit; below 0 where it is held.
    pub fn beyond(&self, figure: f64) -> f64 {
        self.sense() * (figure - self.bound)
    }

    /// 1 where the figure is at most the limit, -1 where it is at least that.
    pub fn sense(&self) -> f64 {
        match self.side {
            Side::AtMost => 1.0,
            Side::AtLeast => -1.0,
        }
    }
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// What every design goes through.
    pub what: AnalysisKind,
    /// Numbers that are sought, and where.
    pub spans: Vec<Span>,
    /// What is sought; its figure as it was typed.
    pub goal: Goal,
    /// What is to be held, likewise.
    pub limits: Vec<Limit>,
    /// Searches, each from another place.
    pub starts: usize,
    /// Designs at once.
    pub jobs: usize,
}

/// Everything that a search needs.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The case.
    pub case: Case,
    /// What every design goes through.
    pub what: AnalysisKind,
    /// Its effects, which every design of a run has: a figure must not jump where others would be chosen.
    pub system: Option<System>,
    /// Numbers that are sought, and where.
    pub spans: Vec<Span>,
    /// Their values to begin with.
    pub start: Vec<f64>,
    /// What is sought.
    pub goal: Goal,
    /// What is to be held.
    pub limits: Vec<Limit>,
    /// Why there are no exact derivatives, where there are none.
    pub differences: Option<String>,
    /// Designs that are computed already.
    pub evaluations: Evaluations,
}

impl Problem {
    /// Brings a case and what is asked for together.
    ///
    /// # Errors
    /// Everything that does not fit, before anything is computed.
    pub fn new(case: &Case, asked: &Asked) -> Result<Self> {
        let start = span::begin(case, &asked.spans, std::iter::empty())?;
        asked.what.analysis().check(case)?;
        let names = asked.what.analysis().names(case)?;
        let option = if asked.goal.largest { "--maximize" } else { "--minimize" };
        let figure = resolve(option, &asked.goal.figure, asked.what, &names)?;
        let limit = |one: &Limit| {
            let figure = resolve("--subject-to", &one.figure, asked.what, &names)?;
            Ok(Limit { figure, ..one.clone() })
        };
        let limits = asked.limits.iter().map(limit).collect::<Result<Vec<_>>>()?;
        contradictions(&limits)?;
        let mut problem = Self {
            case: case.clone(),
            what: asked.what,
            system: match asked.what {
                AnalysisKind::Run => Some(System::new(case)?),
                _ => None,
            },
            spans: asked.spans.clone(),
            start,
            goal: Goal {
                figure,
                largest: asked.goal.largest,
            },
            limits,
            differences: None,
            evaluations: Evaluations::default(),
        };
        let begin = problem.with(&problem.start)?;
        span::check(&begin, &problem.spans, false, &|case| {
            problem.what.analysis().check(case)
        })?;
        let found = problem
            .what
            .analysis()
            .allows(&begin, &problem.parameters(&problem.start));
        problem.differences = found.err().map(|error| error.to_string().replace("--sensitivity ", ""));
        Ok(problem)
    }

    /// The case with values of the numbers that are sought.
    ///
    /// # Errors
    /// It is not valid with them.
    pub fn with(&self, values: &[f64]) -> Result<Case> {
        let all = self.spans.iter().map(|span| span.pointer.as_str());
        with(&self.case, &all.zip(values.iter().copied()).collect::<Vec<_>>())
    }

    /// The numbers that are sought at values.
    pub fn parameters(&self, values: &[f64]) -> Vec<Parameter> {
        let parameter = |(span, value): (&Span, &f64)| Parameter {
            pointer: span.pointer.clone(),
            value: *value,
        };
        self.spans.iter().zip(values).map(parameter).collect()
    }

    /// Figures that are looked at: what is sought, then what is limited.
    pub fn figures(&self) -> Vec<&str> {
        let limits = self.limits.iter().map(|limit| limit.figure.as_str());
        std::iter::once(self.goal.figure.as_str()).chain(limits).collect()
    }
}

/// Limits of one figure between which nothing lies.
fn contradictions(limits: &[Limit]) -> Result<()> {
    for low in limits.iter().filter(|one| one.side == Side::AtLeast) {
        let high = limits
            .iter()
            .find(|one| one.side == Side::AtMost && one.figure == low.figure && one.bound < low.bound);
        if let Some(high) = high {
            return Err(Error::Usage(format!(
                "--subject-to: {} cannot be at least {} and at most {}",
                low.figure, low.bound, high.bound
            )));
        }
    }
    Ok(())
}
