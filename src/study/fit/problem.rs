//! Fit problem: a case, the numbers to be fitted, and measured values.

use serde::{Deserialize, Serialize};

use super::robust::LossFunction;
use crate::case::heading::Heading;
use crate::case::parameter::{Parameter, with};
use crate::case::schema::{Case, Thinning};
use crate::case::{nearest, units};
use crate::discrete::System;
use crate::discrete::quantities::Observable;
use crate::error::numbers::counted;
use crate::error::{Error, Result, visible};
use crate::run::equilibrium;
use crate::run::observe::Observer;
use crate::study::analysis::AnalysisKind;
use crate::study::data::matching::Named;
use crate::study::data::{DataTable, Match, Matched, matching};
use crate::study::evaluations::Evaluations;
use crate::study::search_bounds::{self, ParameterBounds};

/// Analysis of the case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FitAnalysis {
    /// Run in time: one row per instant.
    Run,
    /// Equilibria: one case per row.
    Equilibrium,
}

impl FitAnalysis {
    /// Returns the command.
    pub fn command(self) -> AnalysisKind {
        match self {
            Self::Run => AnalysisKind::Run,
            Self::Equilibrium => AnalysisKind::Equilibrium,
        }
    }
}

/// `COLUMN=POINTER`: a number of the case that every row sets.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DrivenNumber {
    /// Column of the data.
    pub column: String,
    /// JSON pointer into the case.
    pub pointer: String,
}

impl DrivenNumber {
    /// Parses `COLUMN=POINTER`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the expected form.
    pub fn parse(text: &str) -> Result<Self> {
        let parts = text
            .rsplit_once('=')
            .map(|(column, pointer)| (column.trim(), pointer.trim()));
        match parts {
            Some((column, pointer)) if !column.is_empty() && pointer.starts_with('/') => Ok(Self {
                column: column.into(),
                pointer: pointer.into(),
            }),
            _ => Err(Error::Usage(format!(
                "--drive '{text}': expected a column and a JSON pointer, such as \
                 pressure_kpa=/network/chains/0/ends/0/pressure_pa"
            ))),
        }
    }
}

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
    /// Loss function.
    pub loss: LossFunction,
    /// Number of searches, each from another start.
    pub starts: usize,
    /// Number of parallel simulations.
    pub jobs: usize,
}

/// Independent variable of the rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Abscissa {
    /// Instants [s].
    Time(Vec<f64>),
    /// Numbers of the case, with a list of values each.
    Drives(Vec<(DrivenNumber, Vec<f64>)>),
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
        let names = names.collect::<Result<Vec<_>>>()?;
        let through = if asked.drives.is_empty() {
            FitAnalysis::Run
        } else {
            FitAnalysis::Equilibrium
        };
        let columns = columns(&case, through)?;
        let matched = matching::resolve(table, &asked.matches, &names, &columns)?;
        for one in &matched {
            let aside = ["t", "load_factor"].contains(&one.name.as_str());
            if aside || Observable::named(&one.name).is_some_and(|one| !one.has_derivative()) {
                let what = "it does not depend on numbers of the case, so it cannot be fitted";
                return Err(Error::Usage(format!("--match {}: {what}", one.asked.describe())));
            }
        }
        let sigmas = sigmas(table, &matched, asked)?;
        let measured = |row: &usize| matched.iter().any(|one| one.values[*row].is_some());
        let rows: Vec<usize> = (0..table.len()).filter(measured).collect();
        let abscissa = match through {
            FitAnalysis::Run => Abscissa::Time(instants(&case, table, asked, &rows)?),
            FitAnalysis::Equilibrium => Abscissa::Drives(driven(&case, table, asked, &rows)?),
        };
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
        let what = through.command();
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
        }
    }

    /// Number of rows with measured values.
    pub fn rows(&self) -> usize {
        match &self.abscissa {
            Abscissa::Time(instants) => instants.len(),
            Abscissa::Drives(drives) => drives.first().map_or(0, |(_, values)| values.len()),
        }
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

/// Columns of the result of a case.
fn columns(case: &Case, through: FitAnalysis) -> Result<Vec<Named>> {
    let all = match through {
        FitAnalysis::Run => Observer::header(case, &System::new(case)?).columns,
        FitAnalysis::Equilibrium => equilibrium::columns(&equilibrium::system(case, case.time.end_s)?),
    };
    Ok(all
        .into_iter()
        .map(|column| (column.name, column.unit.into()))
        .collect())
}

/// Returns the instants of the rows; rejects instants after the end of the run.
fn instants(case: &Case, table: &DataTable, asked: &FitRequest, rows: &[usize]) -> Result<Vec<f64>> {
    let column = table.time(asked.time.as_deref())?;
    let all = table.instants(column)?;
    let end = case.time.end_s;
    let late = (0..all.len()).find(|row| all[*row] > end * (1.0 + 1e-12));
    if let Some(row) = late {
        let what = format!("{} s is after the end of the run at {end} s", all[row]);
        let last = all[all.len() - 1];
        let fault = table
            .fault(row, column, &what)
            .hint(format!("--set /time/end_s={last}"));
        return table.sound(vec![fault]).map(|()| vec![]);
    }
    Ok(rows.iter().map(|row| all[*row].min(end)).collect())
}

/// Returns the values that each row sets.
fn driven(case: &Case, table: &DataTable, asked: &FitRequest, rows: &[usize]) -> Result<Vec<(DrivenNumber, Vec<f64>)>> {
    let resolved = serde_json::to_value(case.resolved()).unwrap_or_default();
    let mut all = vec![];
    for drive in &asked.drives {
        let wrong = |what: String| Error::Usage(format!("--drive {}={}: {what}", drive.column, drive.pointer));
        let column = table.wanted(&drive.column, "--drive")?;
        if resolved.pointer(&drive.pointer).is_none() {
            let (parent, key) = drive.pointer.rsplit_once('/').unwrap_or_default();
            let keys = resolved.pointer(parent).and_then(|parent| parent.as_object());
            let meant = keys.and_then(|keys| nearest(key, keys.keys().map(String::as_str)));
            let meant = meant.map_or(String::new(), |meant| format!("; nearest is {parent}/{meant}"));
            return Err(wrong(format!("the case has no such entry{meant}")));
        }
        let scale = match units::of_pointer(&drive.pointer) {
            Some(unit) => table.scale(column, unit.si, &drive.pointer)?,
            None => unnamed(&table.columns[column], &drive.pointer).map_err(wrong)?,
        };
        let values = table.all_numbers(column, scale)?;
        let chosen: Vec<f64> = rows.iter().map(|row| values[*row]).collect();
        all.push((drive.clone(), chosen));
    }
    // every row must give a valid case
    for row in 0..rows.len() {
        let changes: Vec<(&str, f64)> = all
            .iter()
            .map(|(drive, values)| (&*drive.pointer, values[row]))
            .collect();
        with(case, &changes)?;
    }
    Ok(all)
}

/// Factor from the unit of a column to that of a number whose key has no known unit (`_pa_s_m3`, or none): 1 for the key's own unit or for
/// none, the scale of a dimensionless unit.
fn unnamed(column: &Heading, pointer: &str) -> std::result::Result<f64, String> {
    let key = pointer
        .rsplit('/')
        .find(|key| key.parse::<usize>().is_err())
        .unwrap_or("");
    let unit_name = match (&column.unit, &column.unknown) {
        (None, None) => return Ok(1.0),
        (Some(unit), _) => unit.name,
        (None, Some(unknown)) => unknown,
    };
    let same = column.unknown.as_ref().is_some_and(|unit| {
        let end = unit.to_ascii_lowercase().replace('^', "").replace([' ', '/'], "_");
        let end = format!("_{end}");
        format!("_{key}").ends_with(&end)
    });
    let share = column.unit.filter(|unit| unit.si == "1");
    match share {
        Some(share) => Ok(share.scale),
        None if same => Ok(1.0),
        None => Err(format!(
            "the column {} has the unit {}, but the unit of {key} is unknown. Convert the column to the unit of the \
             case and remove the unit from its heading",
            visible(&column.heading),
            visible(unit_name)
        )),
    }
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
