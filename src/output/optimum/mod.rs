//! Output files of an optimization, `optimum.json`, `designs.csv`, `optimum.svg` and `optimum-case.json`, and its text.

mod text;

use super::folder::ResultFolder;
use super::numbers::{shortest, significant};
use super::plot::canvas::{FAINT_INK, LineStyle};
use super::plot::colour::PALETTE;
use super::plot::extent;
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use super::records;
use crate::case::readable;
use crate::error::{Result, visible};
use crate::results;
use crate::study::optimize::OptimizedCase;
use crate::study::optimize::outcome::ComputedDesign;
use crate::study::optimize::problem::OptimizationProblem;
use crate::study::sweep::unit::unit;

pub use text::{describe, place, ranked};

/// Complete result.
pub const JSON: &str = "optimum.json";
/// All computed designs, in order.
pub const CSV: &str = "designs.csv";
/// The figure over the designs and over the varied numbers.
pub const PICTURE: &str = "optimum.svg";
/// The case with the optimal numbers.
pub const BEST: &str = "optimum-case.json";

/// Writes the files into a folder; other files in it stay.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &mut ResultFolder, problem: &OptimizationProblem, found: &OptimizedCase) -> Result<()> {
    let files = vec![(CSV, table(problem, found)), (JSON, results::text(&found.optimum))];
    let (picture, best) = ((PICTURE, drawn(problem, found)), found.case.written());
    folder.fill_with_both(&problem.case.written(), (BEST, &best), files, picture)
}

fn table(problem: &OptimizationProblem, found: &OptimizedCase) -> String {
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

/// Largest number of varied numbers drawn.
const DRAWN: usize = 6;

/// Picture of the figure over the designs in order, and over each varied number.
fn drawn(problem: &OptimizationProblem, found: &OptimizedCase) -> Option<String> {
    let optimum = &found.optimum;
    let name = readable::figure_name(&optimum.goal.figure);
    let all = found.history.iter().enumerate();
    let computed: Vec<_> = all
        .filter_map(|(k, one)| Some((k, one, one.figures.as_ref()?[0])))
        .collect();
    let figures: Vec<f64> = computed.iter().map(|(.., figure)| *figure).collect();
    extent(figures.iter().copied())?;
    let y = PictureAxis::new(name, unit(&optimum.goal.figure), 5).with(&figures);
    let panel = |x: PictureAxis, at: &dyn Fn(usize, &ComputedDesign) -> f64, best: Option<f64>| {
        let held = |wanted: bool| {
            let all = computed.iter().filter(move |(_, one, _)| one.held == wanted);
            all.map(|(k, one, figure)| (at(*k, one), *figure))
        };
        let rings = [(true, PALETTE[0], "a design"), (false, FAINT_INK, "beyond a limit")];
        let mut series: Vec<_> = rings
            .map(|(wanted, colour, name)| {
                let marks = PictureSeries::marks(held(wanted), Glyph::Ring(2.6, 1.1), colour);
                marks.named(name)
            })
            .into();
        let large = PictureSeries::marks(best.map(|x| (x, optimum.value)), Glyph::Ring(5.2, 1.6), PALETTE[1]);
        series.push(large.named("the best"));
        Panel::new((620.0, 190.0), x, y.clone(), series)
    };
    let mut designs = panel(PictureAxis::new("design", "1", 8), &|k, _| k as f64, None);
    let in_order = computed.iter().map(|(k, _, figure)| (*k as f64, *figure));
    let dashed = LineStyle::dashed(PALETTE[9], 0.8, (3.0, 3.0));
    designs.series.insert(0, PictureSeries::line(in_order, dashed));
    let numbers = problem.spans.iter().enumerate().take(DRAWN).map(|(i, span)| {
        let (name, unit) = (
            readable::pointer_name(&span.pointer),
            readable::pointer_unit(&span.pointer),
        );
        let x = PictureAxis::new(name, unit, 8).logarithmic(span.logarithmic() && span.low > 0.0);
        panel(x, &|_, one| one.values[i], Some(optimum.variables[i].value))
    });
    let values = optimum.variables.iter().map(|one| {
        let name = readable::pointer_name(&one.pointer);
        format!("{name} = {}", significant(one.value, 5))
    });
    let title = format!("{}, {}", optimum.case, optimum.goal.figure);
    let about = values.collect::<Vec<_>>().join(", ");
    Picture::stacked(title, about, std::iter::once(designs).chain(numbers)).svg()
}
