//! Every figure over two varied numbers, as colours.

use std::slice;

use super::{Drawn, LEFT, Numbers, TOP, name};
use crate::output::numbers::quantity;
use crate::output::plot::canvas::{Anchor, Canvas, Words, picture};
use crate::output::plot::colour::of_value;
use crate::output::plot::extent;
use crate::output::plot::panel::{Panel, Place, title};

/// Side of a map, and what lies between two.
const SIDE: f64 = 320.0;
const BETWEEN: f64 = 74.0;
/// Half the side of a cell where designs are no grid.
const DOT: f64 = 4.0;

/// Every figure over the first two varied numbers, as colours; `None` when there is nothing to draw.
pub fn over_two(data: &Drawn) -> Option<String> {
    let [x, y, ..] = &data.varied[..] else { return None };
    let (mut across, mut up) = (x.scale(7)?, y.scale(7)?);
    let (columns, lines) = (x.places(), y.places());
    // cells touch where the designs are a grid, and are small where they are not
    let grid = (columns.len() * lines.len()) as f64 <= 1.5 * data.designs.len() as f64;
    for (scale, places) in [(&mut across, &columns), (&mut up, &lines)] {
        let (lo, hi) = (*places.first()?, *places.last()?);
        let margin = 0.04 * if hi > lo { hi - lo } else { 1.0 };
        (scale.lo, scale.hi) = match &edges(places)[..] {
            [first, .., last] if grid => (*first, *last),
            _ => (lo - margin, hi + margin),
        };
        let range = scale.lo..=scale.hi;
        scale.ticks.retain(|(at, _)| range.contains(at));
    }
    let rows = data.figures.len() as f64;
    (rows > 0.0).then(|| {
        picture(LEFT + SIDE + 150.0, TOP + rows * (SIDE + BETWEEN), |canvas| {
            title(canvas, 16.0, &data.case, &data.about("a cell a design"));
            for (k, figure) in data.figures.iter().enumerate() {
                let Some((low, high)) = extent(figure.values.iter().copied()) else {
                    continue;
                };
                let place = Place::new(LEFT, TOP + k as f64 * (SIDE + BETWEEN), SIDE, SIDE);
                let panel = Panel::new(place, across.clone(), up.clone());
                let cells = x.on_axis().into_iter().zip(y.on_axis()).zip(&figure.values);
                for (n, ((a, b), value)) in cells.enumerate() {
                    if !(a.is_finite() && b.is_finite() && value.is_finite()) {
                        continue;
                    }
                    let (left, right) = around(&columns, a);
                    let (low_edge, high_edge) = around(&lines, b);
                    let at = panel.at((a, b));
                    let (from, to) = match grid {
                        true => (panel.at((left, high_edge)), panel.at((right, low_edge))),
                        false => ((at.0 - DOT, at.1 - DOT), (at.0 + DOT, at.1 + DOT)),
                    };
                    // a little more, so that no hairline shows between cells
                    let most = if grid { 0.0 } else { DOT };
                    let to = (
                        (to.0 + 0.4).min(place.right() + most),
                        (to.1 + 0.4).min(place.bottom() + most),
                    );
                    let colour = of_value(*value, low, high);
                    data.thing(canvas, n, slice::from_ref(figure), |canvas| {
                        canvas.rectangle(from, to, colour)
                    });
                }
                panel.axes(canvas, Some(&x.label), &y.label);
                name(canvas, place, &figure.label);
                bar(canvas, place, figure, low, high);
            }
        })
    })
}

/// Between places in their order: half way to the neighbours, and as far beyond the first and the last.
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

fn bar(canvas: &mut Canvas, beside: Place, figure: &Numbers, low: f64, high: f64) {
    const PIECES: usize = 64;
    let (left, height) = (beside.right() + 24.0, beside.height / PIECES as f64);
    for k in 0..PIECES {
        let bottom = beside.bottom() - k as f64 * height;
        let share = (k as f64 + 0.5) / PIECES as f64;
        let colour = of_value(low + share * (high - low), low, high);
        canvas.rectangle((left, bottom - height - 0.4), (left + 14.0, bottom), colour);
    }
    for share in [0.0, 0.5, 1.0] {
        let at = (left + 20.0, beside.bottom() - beside.height * share);
        let value = quantity(low + share * (high - low), &figure.unit, 3);
        canvas.text(at, &value, Words::new(11.0, Anchor::Left));
    }
}
