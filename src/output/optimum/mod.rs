//! What a search for the best leaves behind: `optimum.json`, `designs.csv`, `optimum.svg`, `optimum-case.json`, and its words.

mod words;

use super::folder::{CASE, ResultFolder};
use super::numbers::{shortest, significant};
use super::plot::optimum::{self, Dot, Optimum as Drawn, Part};
use super::records;
use crate::case::readable;
use crate::error::{Result, visible};
use crate::results;
use crate::study::optimize::Optimised;
use crate::study::optimize::found::Design;
use crate::study::optimize::problem::Problem;
use crate::study::sweep::unit::unit;

pub use words::{place, ranked, words};

/// Everything that was found.
pub const JSON: &str = "optimum.json";
/// Every design that was computed, in order.
pub const CSV: &str = "designs.csv";
/// The figure over the designs and over the numbers.
pub const PICTURE: &str = "optimum.svg";
/// The case with the best numbers.
pub const BEST: &str = "optimum-case.json";

/// Writes the files into a folder; others in it stay.
///
/// # Errors
/// Something cannot be written.
pub fn write(folder: &mut ResultFolder, problem: &Problem, found: &Optimised) -> Result<()> {
    let (own, best) = (problem.case.written(), found.case.written());
    let case = own.with_tables(best.tables);
    let mut files = vec![
        (CSV, table(problem, found)),
        (JSON, results::text(&found.optimum)),
        (CASE, case.json.clone()),
        (BEST, best.json),
    ];
    files.extend(optimum::draw(&drawn(problem, found)).map(|text| (PICTURE, text)));
    folder.fill_with(&case, files).map(|_| ())
}

fn table(problem: &Problem, found: &Optimised) -> String {
    let (searches, alternatives) = (found.optimum.starts.len(), &found.optimum.alternatives);
    let choice = (!alternatives.is_empty()).then_some("alternative");
    let begin = ["design"].into_iter().chain(choice).chain(["search"]).map(String::from);
    let numbers = problem.spans.iter().map(|span| span.pointer.clone());
    let figures = problem.figures().into_iter().map(String::from);
    let end = ["limits held", "reason", "wall time [s]"].map(String::from);
    let headings = begin.chain(numbers).chain(figures).chain(end);
    let rows = found.history.iter().enumerate().map(|(k, one)| {
        let search = match one.start < searches {
            true => one.start.to_string(),
            false => "curvature".into(),
        };
        let mut cells = vec![k.to_string()];
        cells.extend(alternatives.get(one.alternative).map(|own| own.name.clone()));
        cells.push(search);
        cells.extend(one.values.iter().map(|x| shortest(*x)));
        match &one.figures {
            Some(figures) => cells.extend(figures.iter().map(|x| shortest(*x))),
            None => cells.extend(vec![String::new(); problem.limits.len() + 1]),
        }
        let reason = one
            .reason
            .as_deref()
            .map_or(String::new(), |why| visible(why).into_owned());
        cells.extend([u8::from(one.held).to_string(), reason, shortest(one.wall_s)]);
        cells
    });
    records::text(headings, rows)
}

fn drawn(problem: &Problem, found: &Optimised) -> Drawn {
    let optimum = &found.optimum;
    let dots = |x: &dyn Fn(usize, &Design) -> f64| -> Vec<Dot> {
        let dot = |(k, one): (usize, &Design)| {
            let figure = one.figures.as_ref()?[0];
            Some(Dot {
                at: (x(k, one), figure),
                held: one.held,
            })
        };
        found.history.iter().enumerate().filter_map(dot).collect()
    };
    let best = |x: f64| Some((x, optimum.value));
    let designs = Part {
        name: "design".into(),
        unit: "1".into(),
        logarithmic: false,
        dots: dots(&|k, _| k as f64),
        best: None,
    };
    let numbers = problem.spans.iter().enumerate().map(|(i, span)| Part {
        name: readable::pointer_name(&span.pointer),
        unit: readable::pointer_unit(&span.pointer).into(),
        logarithmic: span.logarithmic() && span.low > 0.0,
        dots: dots(&|_, one| one.values[i]),
        best: best(optimum.variables[i].value),
    });
    let numbers_told = optimum.variables.iter().map(|one| {
        let name = readable::pointer_name(&one.pointer);
        format!("{name} = {}", significant(one.value, 5))
    });
    Drawn {
        name: format!("{}, {}", optimum.case, optimum.goal.figure),
        about: numbers_told.collect::<Vec<_>>().join(", "),
        figure: readable::figure_name(&optimum.goal.figure),
        unit: unit(&optimum.goal.figure).into(),
        parts: std::iter::once(designs).chain(numbers).collect(),
    }
}
