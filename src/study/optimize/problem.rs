//! Goal, numbers and limits of an optimization.

use serde::{Deserialize, Serialize};

use super::names::resolve;
use crate::case::Case;
use crate::case::parameter::{Parameter, with};
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::study::analysis::AnalysisKind;
use crate::study::evaluations::Evaluations;
use crate::study::search_bounds::{self, ParameterBounds};

/// Figure to be maximized or minimized.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Goal {
    /// Name of the figure in the table of `slcbeam sweep`.
    pub figure: String,
    /// True to maximize, false to minimize.
    pub largest: bool,
}

impl Goal {
    /// Returns 1 to minimize, -1 to maximize.
    pub fn sign(&self) -> f64 {
        if self.largest { -1.0 } else { 1.0 }
    }
}

/// Side of a limit on which a figure must stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitSide {
    /// It is at most the limit.
    AtMost,
    /// It is at least the limit.
    AtLeast,
}

/// Limit of a figure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FigureLimit {
    /// The figure.
    pub figure: String,
    /// Side of the bound.
    pub side: LimitSide,
    /// Bound, in the unit of the figure.
    pub bound: f64,
}

impl FigureLimit {
    /// Parses `FIGURE<=VALUE` or `FIGURE>=VALUE`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse(text: &str) -> Result<Self> {
        let sides = [("<=", LimitSide::AtMost), (">=", LimitSide::AtLeast)];
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
                "--subject-to '{text}': expected a figure and its limit with <= or >=, such as 'max_pressure_pa<=2e4' or \
                 'mode_1.frequency_hz>=12'"
            ))),
        }
    }

    /// Returns the sign as on the command line.
    pub fn sign(&self) -> &'static str {
        match self.side {
            LimitSide::AtMost => "<=",
            LimitSide::AtLeast => ">=",
        }
    }

    /// Excess of a figure over the limit; negative if the limit is met.
    pub fn beyond(&self, figure: f64) -> f64 {
        self.sense() * (figure - self.bound)
    }

    /// Returns 1 for an upper limit, -1 for a lower limit.
    pub fn sense(&self) -> f64 {
        match self.side {
            LimitSide::AtMost => 1.0,
            LimitSide::AtLeast => -1.0,
        }
    }
}

/// Requested optimization.
#[derive(Clone, Debug, PartialEq)]
pub struct OptimizationRequest {
    /// Analysis of every design.
    pub what: AnalysisKind,
    /// Numbers to be optimized, with bounds.
    pub spans: Vec<ParameterBounds>,
    /// Goal, its figure as typed.
    pub goal: Goal,
    /// Limits, their figures as typed.
    pub limits: Vec<FigureLimit>,
    /// Number of searches, each from another start.
    pub starts: usize,
    /// Number of parallel designs.
    pub jobs: usize,
}

/// All data of an optimization.
#[derive(Clone, Debug)]
pub struct OptimizationProblem {
    /// The case.
    pub case: Case,
    /// Analysis of every design.
    pub what: AnalysisKind,
    /// System of a run, whose effects every design uses: a figure must not jump where others would be chosen.
    pub system: Option<System>,
    /// Numbers to be optimized, with bounds.
    pub spans: Vec<ParameterBounds>,
    /// Initial values.
    pub start: Vec<f64>,
    /// Goal.
    pub goal: Goal,
    /// Limits.
    pub limits: Vec<FigureLimit>,
    /// Reason why exact derivatives are not available, if they are not.
    pub differences: Option<String>,
    /// Stored designs.
    pub evaluations: Evaluations,
}

impl OptimizationProblem {
    /// Combines a case and a request.
    ///
    /// # Errors
    /// Inconsistent input, found before anything is computed.
    pub fn new(case: &Case, asked: &OptimizationRequest) -> Result<Self> {
        let start = search_bounds::begin(case, &asked.spans, std::iter::empty())?;
        asked.what.analysis().check(case)?;
        let names = asked.what.analysis().names(case)?;
        let option = if asked.goal.largest { "--maximize" } else { "--minimize" };
        let figure = resolve(option, &asked.goal.figure, &asked.what, &names)?;
        let limit = |one: &FigureLimit| {
            let figure = resolve("--subject-to", &one.figure, &asked.what, &names)?;
            Ok(FigureLimit { figure, ..one.clone() })
        };
        let limits = asked.limits.iter().map(limit).collect::<Result<Vec<_>>>()?;
        contradictions(&limits)?;
        let mut problem = Self {
            case: case.clone(),
            what: asked.what.clone(),
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
        search_bounds::check(&begin, &problem.spans, false, &|case| {
            problem.what.analysis().check(case)
        })?;
        let found = problem
            .what
            .analysis()
            .allows(&begin, &problem.parameters(&problem.start));
        problem.differences = found.err().map(|error| error.to_string().replace("--sensitivity ", ""));
        Ok(problem)
    }

    /// Returns the case with values of the optimized numbers.
    ///
    /// # Errors
    /// The case is not valid with them.
    pub fn with(&self, values: &[f64]) -> Result<Case> {
        let all = self.spans.iter().map(|span| span.pointer.as_str());
        with(&self.case, &all.zip(values.iter().copied()).collect::<Vec<_>>())
    }

    /// Returns the optimized numbers at values.
    pub fn parameters(&self, values: &[f64]) -> Vec<Parameter> {
        let parameter = |(span, value): (&ParameterBounds, &f64)| Parameter {
            pointer: span.pointer.clone(),
            value: *value,
        };
        self.spans.iter().zip(values).map(parameter).collect()
    }

    /// Returns the figures that are evaluated: the goal, then the limits.
    pub fn figures(&self) -> Vec<&str> {
        let limits = self.limits.iter().map(|limit| limit.figure.as_str());
        std::iter::once(self.goal.figure.as_str()).chain(limits).collect()
    }
}

/// Rejects limits of one figure that contradict each other.
fn contradictions(limits: &[FigureLimit]) -> Result<()> {
    for low in limits.iter().filter(|one| one.side == LimitSide::AtLeast) {
        let high = limits
            .iter()
            .find(|one| one.side == LimitSide::AtMost && one.figure == low.figure && one.bound < low.bound);
        if let Some(high) = high {
            return Err(Error::Usage(format!(
                "--subject-to: {} cannot be at least {} and at most {}",
                low.figure, low.bound, high.bound
            )));
        }
    }
    Ok(())
}
