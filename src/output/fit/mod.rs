//! Output files of a fit, `fit.json`, `fit.csv`, `fit.svg` and `fitted-case.json`, and its text.

mod text;

use super::folder::ResultFolder;
use super::numbers::{shortest, significant};
use super::plot::canvas::LineStyle;
use super::plot::colour::PALETTE;
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::case::readable;
use crate::error::Result;
use crate::results;
use crate::study::data::Matched;
use crate::study::fit::Fitted;
use crate::study::fit::abscissa::Abscissa;
use crate::study::fit::comparison::DataComparison;
use crate::study::fit::outcome::FittedNumber;
use crate::study::fit::problem::FitProblem;

pub use text::{comparison, describe};

/// Complete result.
pub const JSON: &str = "fit.json";
/// Data, model, residual and weight, row by row.
pub const CSV: &str = "fit.csv";
/// Data with the model, and residuals.
pub const PICTURE: &str = "fit.svg";
/// The case with the estimates.
pub const FITTED: &str = "fitted-case.json";

/// Writes the files into a folder; other files in it stay.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, problem: &FitProblem, found: &Fitted) -> Result<()> {
    let files = vec![(CSV, table(problem, found)), (JSON, results::text(&found.fit))];
    let (picture, fitted) = ((PICTURE, drawn(problem, found)), found.case.written());
    folder.fill_with_both(&problem.case.written(), (FITTED, &fitted), files, picture)
}

/// Columns beside the observations: names with units, and values.
fn beside(problem: &FitProblem) -> Vec<(String, Vec<f64>)> {
    match &problem.abscissa {
        Abscissa::Time(instants) => vec![("t [s]".into(), instants.clone())],
        Abscissa::Frequencies(_, hz) => vec![("frequency [Hz]".into(), hz.clone())],
        Abscissa::Drives(drives) => drives
            .iter()
            .map(|(drive, values)| (drive.pointer.clone(), values.clone()))
            .collect(),
    }
}

/// Index of the observation of a column in each row, if there is one.
fn places(problem: &FitProblem, column: usize) -> Vec<Option<usize>> {
    let mut all = vec![None; problem.rows()];
    for (place, one) in problem.observations(column) {
        all[one.row] = Some(place);
    }
    all
}

fn table(problem: &FitProblem, found: &Fitted) -> String {
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

fn drawn(problem: &FitProblem, found: &Fitted) -> Option<String> {
    let aside = beside(problem);
    let (name, xs) = aside.first()?;
    let x = match &problem.abscissa {
        Abscissa::Time(_) => PictureAxis::new("time t", "s", 8),
        Abscissa::Frequencies(..) => PictureAxis::new("frequency", "Hz", 8),
        Abscissa::Drives(_) => PictureAxis::new(readable::pointer_name(name), readable::pointer_unit(name), 8),
    };
    let line = aside.len() == 1;
    let panels = problem.matched.iter().enumerate().map(|(k, one)| {
        let places = places(problem, k);
        let points = |value: &dyn Fn(usize) -> f64| -> Vec<(f64, f64)> {
            let all = places.iter().enumerate();
            let mut all: Vec<_> = all.filter_map(|(row, i)| Some((xs[row], value((*i)?)))).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all
        };
        let data = |i: usize| problem.observations[i].value;
        let curves = [
            points(&data),
            points(&|i| found.model[i]),
            points(&|i| found.model[i] - data(i)),
        ];
        let noise = Some(2.0 * found.fit.columns[k].noise);
        over_data((&one.name, &one.unit), &x, line, curves, noise)
    });
    let named = |one: &FittedNumber| format!("{} = {}", readable::pointer_name(&one.pointer), shown(one));
    let estimates = found.fit.parameters.iter().map(named);
    let about = estimates.collect::<Vec<_>>().join(", ");
    Picture::stacked(format!("{}, fitted", found.fit.case), about, panels.flatten()).svg()
}

/// An estimate with its standard error, if known.
pub fn shown(one: &FittedNumber) -> String {
    let error = one.standard_error.map(|error| format!(" ± {}", significant(error, 2)));
    significant(one.value, 5) + &error.unwrap_or_default()
}

/// Panels of one quantity: data with the model, and residuals with two standard deviations of the noise, if known.
fn over_data(
    (name, unit): (&str, &str),
    x: &PictureAxis,
    line: bool,
    [data, model, residuals]: [Vec<(f64, f64)>; 3],
    noise: Option<f64>,
) -> [Panel; 2] {
    let rings = |points: Vec<(f64, f64)>| PictureSeries::marks(points, Glyph::Ring(2.6, 1.1), PALETTE[1]);
    let stroke = LineStyle::solid(PALETTE[0], 1.6);
    let levels: Vec<f64> = noise.into_iter().flat_map(|noise| [-noise, noise]).collect();
    let ends = [data.first(), data.last()].map(|p| p.map_or(0.0, |p| p.0));
    let dashed = LineStyle::dashed(PALETTE[9], 0.8, (4.0, 3.0));
    let level = |level: &f64| PictureSeries::line(ends.map(|x| (x, *level)), dashed);
    let left = levels.iter().map(level).chain([rings(residuals)]).collect();
    let model = match line {
        true => PictureSeries::line(model, stroke),
        false => PictureSeries::marks(model, Glyph::Ring(1.3, 1.6), PALETTE[0]),
    };
    let both = vec![model.named("model"), rings(data).named("measured")];
    [
        Panel::new(
            (620.0, 220.0),
            x.clone(),
            PictureAxis::new(name.replace('_', " "), unit, 6),
            both,
        ),
        Panel::new(
            (620.0, 90.0),
            x.clone(),
            PictureAxis::new("model − data", unit, 3),
            left,
        ),
    ]
}

/// Picture of a run over data; `curve` returns time [s] and value of a quantity by its name.
pub fn picture(found: &DataComparison, curve: impl Fn(&str) -> Vec<(f64, f64)>) -> Option<String> {
    let panels = found.columns.iter().flat_map(|column| {
        let at = |values: &mut dyn Iterator<Item = f64>| column.times_s.iter().copied().zip(values).collect();
        let residuals = column.computed.iter().zip(&column.measured).map(|(a, b)| a - b);
        let curves = [
            at(&mut column.measured.iter().copied()),
            curve(&column.quantity),
            at(&mut { residuals }),
        ];
        over_data(
            (&column.quantity, &column.unit),
            &PictureAxis::new("time t", "s", 8),
            true,
            curves,
            None,
        )
    });
    let title = format!("{} over {}", found.case, found.data);
    Picture::stacked(title, "a run over measured data", panels).svg()
}
