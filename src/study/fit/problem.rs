//! Fit problem: a case, the numbers to be fitted, and measured values.

use super::abscissa::{AMPLITUDE, Abscissa, DrivenNumber, FitAnalysis, columns, figure_of_response};
use super::robust::LossFunction;
use crate::case::parameter::{Parameter, with};
use crate::case::schema::{Case, Thinning};
use crate::discrete::quantities::Observable;
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::study::analysis::{AnalysisKind, ResponseAnalysis};
use crate::study::data::{DataTable, Match, Matched, matching};
use crate::study::evaluations::Evaluations;
use crate::study::search_bounds::{self, ParameterBounds};

/// Requested fit.
#[derive(Clone, Debug, PartialEq)]
pub struct FitRequest {
    /// Numbers to be fitted, with bounds.
    pub spans: Vec<ParameterBounds>,
    /// Assignments of columns to quantities.
    pub matches: Vec<Match>,
    /// Column of time of a run.
    pub time: Option<String>,
    /// Numbers that rows set, for equilibria; empty for a run.
    pub drives: Vec<DrivenNumber>,
    /// Standard deviations of columns in their own units.
    pub noise: Vec<(String, f64)>,
    /// Input of a response: the JSON pointer of a signal of the case.
    pub input: Option<String>,
    /// Loss function.
    pub loss: LossFunction,
    /// Number of searches, each from another start.
    pub starts: usize,
    /// Number of parallel simulations.
    pub jobs: usize,
}

impl FitRequest {
    /// Returns the analysis of the case.
    pub fn through(&self) -> FitAnalysis {
        match (&self.input, self.drives.is_empty()) {
            (Some(_), _) => FitAnalysis::Response,
            (None, true) => FitAnalysis::Run,
            (None, false) => FitAnalysis::Equilibrium,
        }
    }
}

/// A measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Index of its [`Matched`].
    pub of: usize,
    /// Row of the abscissa.
    pub row: usize,
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// Standard deviation, if given.
    pub sigma: Option<f64>,
}

/// All data of a fit.
#[derive(Clone, Debug)]
pub struct FitProblem {
    /// Case, with the probes that are compared.
    pub case: Case,
    /// Numbers to be fitted, with bounds.
    pub spans: Vec<ParameterBounds>,
    /// Initial values.
    pub start: Vec<f64>,
    /// Matched columns.
    pub matched: Vec<Matched>,
    /// Independent variable of the rows with measured values.
    pub abscissa: Abscissa,
    /// Measured values, row after row.
    pub observations: Vec<Observation>,
    /// Stored simulations.
    pub evaluations: Evaluations,
}

impl FitProblem {
    /// Combines a case and data.
    ///
    /// # Errors
    /// Inconsistent input, found before anything is computed.
    pub fn new(case: &Case, table: &DataTable, asked: &FitRequest) -> Result<Self> {
        if asked.spans.is_empty() {
            let what = "nothing to fit. Use --vary POINTER=LOW:HIGH, such as /beam/young_modulus_pa=1e5:1e7";
            return Err(Error::Usage(what.into()));
        }
        let set = asked.drives.iter().map(|drive| drive.pointer.as_str());
        let start = search_bounds::begin(case, &asked.spans, set)?;
        let mut case = case.clone();
        case.time.history = Thinning::All;
        let names = asked.matches.iter().map(|one| one.placed(&mut case));
        let mut names = names.collect::<Result<Vec<_>>>()?;
        let columns = columns(&case, asked)?;
        if asked.through() == FitAnalysis::Response {
            names
                .iter_mut()
                .for_each(|name| *name = figure_of_response(&columns, name));
        }
        let matched = matching::resolve(table, &asked.matches, &names, &columns)?;
        for one in &matched {
            let aside = ["t", "load_factor"].contains(&one.name.as_str());
            if aside || Observable::named(&one.name).is_some_and(|one| !one.has_derivative()) {
                let what = "it does not depend on numbers of the case, so it cannot be fitted";
                return Err(Error::Usage(format!("--match {}: {what}", one.asked.describe())));
            }
        }
        if asked.through() == FitAnalysis::Response {
            ratios(table, &matched)?;
        }
        let sigmas = sigmas(table, &matched, asked)?;
        let measured = |row: &usize| matched.iter().any(|one| one.values[*row].is_some());
        let rows: Vec<usize> = (0..table.len()).filter(measured).collect();
        let abscissa = Abscissa::read(&case, table, asked, &rows)?;
        let mut observations = vec![];
        for (place, row) in rows.iter().enumerate() {
            for (of, one) in matched.iter().enumerate() {
                observations.extend(one.values[*row].map(|value| Observation {
                    of,
                    row: place,
                    value,
                    sigma: sigmas[of].as_ref().map(|all| all[*row]),
                }));
            }
        }
        let (values, sought) = (observations.len(), asked.spans.len());
        if values < sought + usize::from(sigmas.iter().any(Option::is_none)) {
            return Err(Error::Usage(format!(
                "{} cannot determine {} of the case{}",
                counted(values as u64, "measured value"),
                counted(sought as u64, "number"),
                if values < sought {
                    ""
                } else {
                    " and the noise of the data. Give the noise with --noise"
                }
            )));
        }
        let problem = Self {
            case,
            spans: asked.spans.clone(),
            start,
            matched,
            abscissa,
            observations,
            evaluations: Evaluations::default(),
        };
        let begin = problem.with(&problem.start)?;
        let what = problem.analysis();
        search_bounds::check(&begin, &problem.spans, true, &|case| what.analysis().check(case))?;
        Ok(problem)
    }

    /// Measured values of a column, with their indices.
    pub fn observations(&self, column: usize) -> impl Iterator<Item = (usize, &Observation)> {
        self.observations
            .iter()
            .enumerate()
            .filter(move |(_, one)| one.of == column)
    }

    /// Returns the analysis of the case.
    pub fn through(&self) -> FitAnalysis {
        match self.abscissa {
            Abscissa::Time(_) => FitAnalysis::Run,
            Abscissa::Drives(_) => FitAnalysis::Equilibrium,
            Abscissa::Frequencies(..) => FitAnalysis::Response,
        }
    }

    /// Returns the command that computes the case alone.
    pub fn analysis(&self) -> AnalysisKind {
        match &self.abscissa {
            Abscissa::Time(_) => AnalysisKind::Run,
            Abscissa::Drives(_) => AnalysisKind::Equilibrium,
            Abscissa::Frequencies(input, hz) => AnalysisKind::Response(ResponseAnalysis {
                input: input.clone(),
                outputs: self.outputs(),
                band: [
                    hz.iter().copied().fold(f64::INFINITY, f64::min),
                    hz.iter().copied().fold(0.0, f64::max),
                ],
                frequencies: vec![],
            }),
        }
    }

    /// Outputs of a response, each once.
    pub fn outputs(&self) -> Vec<String> {
        let mut all: Vec<String> = vec![];
        for (output, _) in self.matched.iter().filter_map(|one| one.name.rsplit_once('.')) {
            if !all.iter().any(|own| own == output) {
                all.push(output.into());
            }
        }
        all
    }

    /// Number of rows with measured values.
    pub fn rows(&self) -> usize {
        self.abscissa.rows()
    }

    /// Returns the case with values of the fitted numbers.
    ///
    /// # Errors
    /// The case is not valid with them.
    pub fn with(&self, values: &[f64]) -> Result<Case> {
        with(&self.case, &self.changes(values).collect::<Vec<_>>())
    }

    /// Returns pointers and values.
    pub fn changes<'a>(&'a self, values: &'a [f64]) -> impl Iterator<Item = (&'a str, f64)> {
        self.spans
            .iter()
            .map(|span| span.pointer.as_str())
            .zip(values.iter().copied())
    }

    /// Returns the fitted numbers at values.
    pub fn parameters(&self, values: &[f64]) -> Vec<Parameter> {
        let parameter = |(pointer, value): (&str, f64)| Parameter {
            pointer: pointer.into(),
            value,
        };
        self.changes(values).map(parameter).collect()
    }

    /// Converts positions between the bounds to values.
    pub fn values(&self, places: &[f64]) -> Vec<f64> {
        search_bounds::values(&self.spans, places)
    }
}

/// Rejects amplitudes of a response in decibels, and negative ones.
fn ratios(table: &DataTable, matched: &[Matched]) -> Result<()> {
    let mut faults = vec![];
    for one in matched.iter().filter(|one| one.name.ends_with(AMPLITUDE)) {
        let heading = &table.columns[one.column].heading;
        if heading.to_ascii_lowercase().ends_with("db") {
            return Err(Error::Usage(format!(
                "{heading}: decibels are not read; give the amplitude, 10^(dB/20)"
            )));
        }
        let negative = (0..table.len()).filter(|row| one.values[*row].is_some_and(|value| value < 0.0));
        faults.extend(negative.map(|row| table.fault(row, one.column, "an amplitude is not below 0")));
    }
    table.sound(faults)
}

/// Standard deviations of each column in the unit of its quantity, row by row; `None` if not given.
fn sigmas(table: &DataTable, matched: &[Matched], asked: &FitRequest) -> Result<Vec<Option<Vec<f64>>>> {
    for (name, _) in &asked.noise {
        let column = table.wanted(name, "--noise")?;
        if !matched.iter().any(|one| one.column == column) {
            return Err(Error::Usage(format!(
                "--noise {name}: the column is not matched to anything"
            )));
        }
    }
    let of = |one: &Matched| {
        let given = asked
            .noise
            .iter()
            .find(|(name, _)| table.find(name) == Some(one.column));
        if let Some((name, sigma)) = given {
            if !(sigma.is_finite() && *sigma > 0.0) {
                return Err(Error::Usage(format!(
                    "--noise {name}={sigma}: the standard deviation must be above 0"
                )));
            }
            return Ok(Some(vec![sigma * one.scale; table.len()]));
        }
        let Some(beside) = table.deviation(one.column) else {
            return Ok(None);
        };
        let own = &table.columns[beside];
        let scale = match own.unit.is_some() || own.unknown.is_some() {
            true => table.scale(beside, &one.unit, &one.name)?,
            false => one.scale,
        };
        let all = table.numbers(beside, scale)?;
        let wrong = |row: &usize| one.values[*row].is_some() && all[*row].is_none_or(|sigma| sigma <= 0.0);
        let faults = (0..table.len()).filter(wrong);
        let faults = faults.map(|row| table.fault(row, beside, "each value needs a standard deviation above 0"));
        table.sound(faults.collect())?;
        Ok(Some(all.into_iter().map(|sigma| sigma.unwrap_or(f64::NAN)).collect()))
    };
    matched.iter().map(of).collect()
}
