//! Map of every figure over two varied numbers, in colors.

use std::slice;

use super::{DesignNumbers, Drawn};
use crate::output::plot::colour::{of_value, scale};
use crate::output::plot::extent;
use crate::output::plot::picture::{ColourBar, Glyph, Panel, Picture, PictureAxis, PictureSeries};

/// Draws every figure over the first two varied numbers, in colors; `None` if there is nothing to draw.
pub fn over_two(data: &Drawn) -> Option<String> {
    let [x, y, ..] = &data.varied[..] else { return None };
    let (columns, lines) = (x.places(), y.places());
    // cells touch if the designs form a grid; otherwise they are small
    let grid = (columns.len() * lines.len()) as f64 <= 1.5 * data.designs.len() as f64;
    let axis = |one: &DesignNumbers, places: &[f64]| {
        let (lo, hi) = (*places.first()?, *places.last()?);
        let margin = 0.04 * if hi > lo { hi - lo } else { 1.0 };
        let (lo, hi) = match &edges(places)[..] {
            [first, .., last] if grid => (*first, *last),
            _ => (lo - margin, hi + margin),
        };
        let axis = PictureAxis::new(&*one.label, &*one.unit, 7).logarithmic(one.logarithmic);
        Some(axis.between(one.raised(lo), one.raised(hi)))
    };
    let (across, up) = (axis(x, &columns)?, axis(y, &lines)?);
    let panel = |figure: &DesignNumbers| {
        let (low, high) = extent(figure.values.iter().copied())?;
        let mut series = vec![];
        for (n, value) in figure.values.iter().enumerate() {
            let (a, b) = (x.shown(x.values[n]), y.shown(y.values[n]));
            if !(a.is_finite() && b.is_finite() && value.is_finite()) {
                continue;
            }
            let colour = of_value(*value, low, high);
            let ((left, right), (bottom, top)) = (around(&columns, a), around(&lines, b));
            let drawn = match grid {
                true => PictureSeries::cell(
                    [(left, bottom), (right, top)].map(|(a, b)| (x.raised(a), y.raised(b))),
                    colour,
                ),
                false => PictureSeries::marks([(x.values[n], y.values[n])], Glyph::Square(4.0), colour),
            };
            series.push(data.linked(n, slice::from_ref(figure), drawn));
        }
        let bar = ColourBar {
            colours: scale(|share| of_value(low + share * (high - low), low, high)),
            axis: PictureAxis::new("", &*figure.unit, 5).between(low, high),
            besides: None,
        };
        let panel = Panel::new((320.0, 320.0), across.clone(), up.clone(), series).headed(&*figure.label);
        Some(Panel {
            bar: Some(bar),
            ..panel
        })
    };
    Picture::stacked(
        data.case.clone(),
        data.about("a cell a design"),
        data.figures.iter().filter_map(panel),
    )
    .svg()
}

/// Edges between sorted places: halfway to each neighbor, and equally far beyond the first and the last place.
pub(super) fn edges(places: &[f64]) -> Vec<f64> {
    let [first, .., last] = places else {
        return places.iter().flat_map(|at| [at - 0.5, at + 0.5]).collect();
    };
    let within: Vec<f64> = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let ends = within.first().zip(within.last());
    let (before, after) = ends.map_or((*first, *last), |(a, b)| (2.0 * first - a, 2.0 * last - b));
    [before].into_iter().chain(within).chain([after]).collect()
}

/// The edges on both sides of a place.
pub(super) fn around(places: &[f64], at: f64) -> (f64, f64) {
    let edges = edges(places);
    let k = places
        .partition_point(|place| *place < at)
        .min(places.len().saturating_sub(1));
    (edges[k], edges[k + 1])
}
