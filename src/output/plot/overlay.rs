//! Two runs over each other, and what is between them.

use super::canvas::{Anchor, Canvas, Stroke, Words, picture};
use super::colour::PALETTE;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use super::{Curve, extent};

/// One quantity of both runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Of the first.
    pub a: Curve,
    /// Of the second.
    pub b: Curve,
    /// First less second, where both are known.
    pub difference: Curve,
}

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Names of the two runs.
    pub names: [String; 2],
    /// Quantities, one a pair of panels.
    pub pairs: Vec<Pair>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 76.0;
const WIDTH: f64 = 650.0;
const HEIGHT: f64 = 120.0;
const BELOW: f64 = 62.0;
const NEAR: f64 = 8.0;
const GAP: f64 = 22.0;
const SHEET: f64 = 764.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Overlay) -> Option<String> {
    let all = data.pairs.iter().flat_map(|p| [&p.a, &p.b]);
    let (from, to) = extent(all.flat_map(|c| c.points.iter().map(|p| p.0)))?;
    let x = Scale::exact(from, to, "s", 10);
    let count = data.pairs.len() as f64;
    let bottom = TOP + count * (HEIGHT + NEAR + BELOW + GAP) - GAP;
    Some(picture(SHEET, bottom + 48.0, |canvas| {
        title(
            canvas,
            LEFT,
            "two runs over each other",
            "below each quantity the first less the second",
        );
        legend(canvas, &data.names);
        for (k, pair) in data.pairs.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + NEAR + BELOW + GAP);
            let last = k + 1 == data.pairs.len();
            let place = Place::new(LEFT, top, WIDTH, HEIGHT);
            let both = [
                (&pair.a, Stroke::solid(PALETTE[0], 2.2)),
                (&pair.b, Stroke::solid(PALETTE[1], 1.1)),
            ];
            panel(canvas, &x, place, &both, &pair.a.name, false);
            let place = Place {
                top: top + HEIGHT + NEAR,
                height: BELOW,
                ..place
            };
            panel(
                canvas,
                &x,
                place,
                &[(&pair.difference, Stroke::solid(PALETTE[9], 1.0))],
                "less",
                last,
            );
        }
    }))
}

fn panel(canvas: &mut Canvas, x: &Scale, place: Place, curves: &[(&Curve, Stroke)], name: &str, labelled: bool) {
    let values = curves.iter().flat_map(|(c, _)| c.points.iter().map(|p| p.1));
    let ticks = if place.height > 100.0 { 4 } else { 3 };
    let y = Scale::around(extent(values), 0.0, curves.first().map_or("1", |c| &c.0.unit), ticks);
    let panel = Panel { place, x: x.clone(), y };
    panel.grid(canvas);
    for (curve, stroke) in curves {
        panel.curve(canvas, curve.points.iter().copied(), *stroke);
    }
    panel.axes(canvas, labelled.then_some("time t"), name);
}

fn legend(canvas: &mut Canvas, names: &[String; 2]) {
    for (k, name) in names.iter().enumerate() {
        let left = LEFT + 0.5 * WIDTH * k as f64;
        let width = if k == 0 { 2.2 } else { 1.1 };
        canvas.line(&[(left, 60.0), (left + 26.0, 60.0)], Stroke::solid(PALETTE[k], width));
        canvas.text((left + 34.0, 60.0), name, Words::new(11.0, Anchor::Left));
    }
}
