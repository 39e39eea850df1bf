//! Rows of measured data: instants of a run, numbers that equilibria set, frequencies of a response; and the quantities of each.

use serde::{Deserialize, Serialize};

use super::problem::FitRequest;
use crate::case::heading::Heading;
use crate::case::parameter::with;
use crate::case::schema::Case;
use crate::case::{nearest, units};
use crate::discrete::System;
use crate::error::{Error, Result, visible};
use crate::run::equilibrium;
use crate::run::observe::Observer;
use crate::run::record::HistoryColumn;
use crate::run::response;
use crate::study::data::DataTable;
use crate::study::data::matching::Named;

/// Figures of an output of a response.
pub const AMPLITUDE: &str = "amplitude";
/// Phase of the output before the input.
pub const PHASE: &str = "phase";

/// Analysis of the case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FitAnalysis {
    /// Run in time: one row per instant.
    Run,
    /// Equilibria: one case per row.
    Equilibrium,
    /// Frequency response: one frequency per row.
    Response,
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

/// Independent variable of the rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Abscissa {
    /// Instants [s].
    Time(Vec<f64>),
    /// Numbers of the case, with a list of values each.
    Drives(Vec<(DrivenNumber, Vec<f64>)>),
    /// Input of a response, as a JSON pointer, and frequencies [Hz].
    Frequencies(String, Vec<f64>),
}

impl Abscissa {
    /// Reads the rows of a table; `rows` are those with measured values.
    ///
    /// # Errors
    /// Values that the case cannot have, with their positions.
    pub fn read(case: &Case, table: &DataTable, asked: &FitRequest, rows: &[usize]) -> Result<Self> {
        Ok(match asked.through() {
            FitAnalysis::Run => Self::Time(instants(case, table, asked, rows)?),
            FitAnalysis::Equilibrium => Self::Drives(driven(case, table, asked, rows)?),
            FitAnalysis::Response => {
                let all = table.frequencies()?;
                let input = asked.input.clone().unwrap_or_default();
                Self::Frequencies(input, rows.iter().map(|row| all[*row]).collect())
            }
        })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Self::Time(all) | Self::Frequencies(_, all) => all.len(),
            Self::Drives(drives) => drives.first().map_or(0, |(_, values)| values.len()),
        }
    }
}

/// Columns of the result of a case.
pub fn columns(case: &Case, asked: &FitRequest) -> Result<Vec<Named>> {
    let all = match asked.through() {
        FitAnalysis::Run => Observer::header(case, &System::new(case)?).columns,
        FitAnalysis::Equilibrium => equilibrium::columns(&equilibrium::system(case, case.time.end_s)?),
        FitAnalysis::Response => return of_response(case, asked.input.as_deref().unwrap_or_default()),
    };
    Ok(all
        .into_iter()
        .map(|column| (column.name, column.unit.into()))
        .collect())
}

/// Amplitude and phase of each output, the former in the unit of the output over that of the input.
fn of_response(case: &Case, input: &str) -> Result<Vec<Named>> {
    let below = units::of_pointer(input).map(|unit| unit.si);
    let of = |column: HistoryColumn| {
        let ratio = match below {
            Some(below) if below == column.unit => "1".into(),
            below => format!("{}/{}", column.unit, below.unwrap_or("input")),
        };
        [
            (format!("{}.{AMPLITUDE}", column.name), ratio),
            (format!("{}.{PHASE}", column.name), "rad".into()),
        ]
    };
    Ok(response::all_outputs(case)?.into_iter().flat_map(of).collect())
}

/// Name of a figure of a response: an output alone, with or without its unit, means its amplitude.
pub fn figure_of_response(columns: &[Named], name: &str) -> String {
    let (output, figure) = name.rsplit_once('.').unwrap_or((name, AMPLITUDE));
    let plain = units::suffixed(output).map_or(output, |(plain, _)| plain);
    let known = |name: &String| columns.iter().any(|(own, _)| own == name);
    let [given, plain] = [output, plain].map(|output| format!("{output}.{figure}"));
    if known(&plain) { plain } else { given }
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
