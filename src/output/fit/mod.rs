//! What a fit leaves behind: `fit.json`, `fit.csv`, `fit.svg`, `fitted-case.json`, and its words.

mod words;

use super::folder::{CASE, ResultFolder};
use super::numbers::{shortest, significant};
use super::plot::fitted::{self, Fitted as Drawn, Part};
use super::records;
use crate::case::readable;
use crate::error::Result;
use crate::results;
use crate::study::data::Matched;
use crate::study::fit::Fitted;
use crate::study::fit::beside::Beside;
use crate::study::fit::problem::{Abscissa, Problem};

pub use words::{comparison, words};

/// Everything that was found.
pub const JSON: &str = "fit.json";
/// Data, model, residual and weight, row by row.
pub const CSV: &str = "fit.csv";
/// Data over model, and residuals.
pub const PICTURE: &str = "fit.svg";
/// The case with the estimates.
pub const FITTED: &str = "fitted-case.json";

/// Writes the files into a folder; others in it stay.
///
/// # Errors
/// Something cannot be written.
pub fn write(folder: &mut ResultFolder, problem: &Problem, found: &Fitted) -> Result<()> {
    let (own, fitted) = (problem.case.written(), found.case.written());
    let case = own.with_tables(fitted.tables);
    let mut files = vec![
        (CSV, table(problem, found)),
        (JSON, results::text(&found.fit)),
        (CASE, case.json.clone()),
        (FITTED, fitted.json),
    ];
    files.extend(fitted::draw(&drawn(problem, found)).map(|text| (PICTURE, text)));
    folder.fill_with(&case, files).map(|_| ())
}

/// Names with units, and values, of what stands beside the rows.
fn beside(problem: &Problem) -> Vec<(String, Vec<f64>)> {
    match &problem.abscissa {
        Abscissa::Time(instants) => vec![("t [s]".into(), instants.clone())],
        Abscissa::Drives(drives) => drives
            .iter()
            .map(|(drive, values)| (drive.pointer.clone(), values.clone()))
            .collect(),
    }
}

/// Places of the observations of a column, by row.
fn places(problem: &Problem, column: usize) -> Vec<Option<usize>> {
    let mut all = vec![None; problem.rows()];
    for (place, one) in problem.of(column) {
        all[one.row] = Some(place);
    }
    all
}

fn table(problem: &Problem, found: &Fitted) -> String {
    let aside = beside(problem);
    let places: Vec<_> = (0..problem.matched.len()).map(|k| places(problem, k)).collect();
    let of = |one: &Matched| {
        let (name, unit) = (&one.name, &one.unit);
        let per = if unit == "1" {
            "1".into()
        } else {
            format!("1/({unit})^2")
        };
        [
            format!("{name} measured [{unit}]"),
            format!("{name} model [{unit}]"),
            format!("{name} residual [{unit}]"),
            format!("{name} weight [{per}]"),
        ]
    };
    let headings = aside.iter().map(|(name, _)| name.clone());
    let headings = headings.chain(problem.matched.iter().flat_map(of));
    let rows = (0..problem.rows()).map(|row| {
        let mut cells: Vec<String> = aside.iter().map(|(_, values)| shortest(values[row])).collect();
        for places in &places {
            match places[row] {
                None => cells.extend(vec![String::new(); 4]),
                Some(i) => {
                    let (data, model) = (problem.observations[i].value, found.model[i]);
                    cells.extend([data, model, model - data, found.weights[i]].map(shortest));
                }
            }
        }
        cells
    });
    records::text(headings, rows)
}

fn drawn(problem: &Problem, found: &Fitted) -> Drawn {
    let aside = beside(problem);
    let (name, xs) = &aside[0];
    let x = match &problem.abscissa {
        Abscissa::Time(_) => ("time t".into(), "s".into()),
        Abscissa::Drives(_) => (readable::pointer_name(name), readable::pointer_unit(name).into()),
    };
    let part = |(k, one): (usize, &Matched)| {
        let places = places(problem, k);
        let points = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            let all = places.iter().enumerate();
            let mut all: Vec<_> = all.filter_map(|(row, i)| Some((xs[row], value((*i)?)))).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all
        };
        let data = |i: usize| problem.observations[i].value;
        Part {
            name: one.name.replace('_', " "),
            unit: one.unit.clone(),
            data: points(&data),
            model: points(&|i| found.model[i]),
            residuals: points(&|i| found.model[i] - data(i)),
            noise: Some(2.0 * found.fit.columns[k].noise),
        }
    };
    let estimates = found.fit.parameters.iter().map(|one| {
        let error = one
            .standard_error
            .map_or(String::new(), |error| format!(" ± {}", significant(error, 2)));
        let name = readable::pointer_name(&one.pointer);
        format!("{name} = {}{error}", significant(one.value, 5))
    });
    Drawn {
        name: format!("{}, fitted", found.fit.case),
        about: estimates.collect::<Vec<_>>().join(", "),
        x,
        line: aside.len() == 1,
        parts: problem.matched.iter().enumerate().map(part).collect(),
    }
}

/// The picture of a run over data: its curves are given by name, time [s] and value.
pub fn picture(found: &Beside, curve: impl Fn(&str) -> Vec<(f64, f64)>) -> Option<String> {
    let part = |column: &crate::study::fit::beside::Column| {
        let at = |values: &[f64]| column.times_s.iter().copied().zip(values.iter().copied()).collect();
        let residuals: Vec<f64> = column
            .computed
            .iter()
            .zip(&column.measured)
            .map(|(a, b)| a - b)
            .collect();
        Part {
            name: column.quantity.replace('_', " "),
            unit: column.unit.clone(),
            data: at(&column.measured),
            model: curve(&column.quantity),
            residuals: at(&residuals),
            noise: None,
        }
    };
    fitted::draw(&Drawn {
        name: format!("{} over {}", found.case, found.data),
        about: "a run over measured data".into(),
        x: ("time t".into(), "s".into()),
        line: true,
        parts: found.columns.iter().map(part).collect(),
    })
}
