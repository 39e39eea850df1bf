//! A model over measured data, and what is between them.

use super::canvas::{Anchor, Canvas, Stroke, Words, picture};
use super::colour::PALETTE;
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// One quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The data.
    pub data: Vec<(f64, f64)>,
    /// The model, in order of the abscissa.
    pub model: Vec<(f64, f64)>,
    /// Model less data.
    pub residuals: Vec<(f64, f64)>,
    /// Two standard deviations of the data's noise, where that is known.
    pub noise: Option<f64>,
}

/// What is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fitted {
    /// Title.
    pub name: String,
    /// What was found, in words.
    pub about: String,
    /// Name and unit of the abscissa.
    pub x: (String, String),
    /// Whether the model is a line along the abscissa.
    pub line: bool,
    /// Quantities, a pair of panels each.
    pub parts: Vec<Part>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 76.0;
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 220.0;
const BELOW: f64 = 90.0;
const NEAR: f64 = 10.0;
const GAP: f64 = 26.0;
const RING: f64 = 2.6;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Fitted) -> Option<String> {
    let all = data.parts.iter().flat_map(|part| part.data.iter().chain(&part.model));
    let x = Scale::around(Some(extent(all.map(|p| p.0))?), 0.0, &data.x.1, 8);
    let bottom = TOP + data.parts.len() as f64 * (HEIGHT + NEAR + BELOW + GAP) - GAP;
    Some(picture(LEFT + WIDTH + 30.0, bottom + 48.0, |canvas| {
        title(canvas, LEFT, &data.name, &data.about);
        legend(canvas, data.line);
        for (k, part) in data.parts.iter().enumerate() {
            let top = TOP + k as f64 * (HEIGHT + NEAR + BELOW + GAP);
            let values = part.data.iter().chain(&part.model).map(|p| p.1);
            let y = Scale::around(extent(values), 0.0, &part.unit, 6);
            let upper = Panel::new(Place::new(LEFT, top, WIDTH, HEIGHT), x.clone(), y);
            upper.grid(canvas);
            model(canvas, &upper, part, data.line);
            rings(canvas, &upper, &part.data);
            upper.axes(canvas, None, &part.name);
            let band = part.noise.into_iter().flat_map(|noise| [-noise, noise]);
            let y = Scale::around(
                extent(part.residuals.iter().map(|p| p.1).chain(band)),
                0.0,
                &part.unit,
                3,
            );
            let place = Place::new(LEFT, top + HEIGHT + NEAR, WIDTH, BELOW);
            let lower = Panel::new(place, x.clone(), y);
            lower.grid(canvas);
            for level in part.noise.into_iter().flat_map(|noise| [-noise, noise]) {
                let ends = [(x.lo, level), (x.hi, level)].map(|p| lower.at(p));
                canvas.line(&ends, Stroke::dashed(PALETTE[9], 0.8, (4.0, 3.0)));
            }
            rings(canvas, &lower, &part.residuals);
            let last = k + 1 == data.parts.len();
            lower.axes(canvas, last.then_some(data.x.0.as_str()), "model − data");
        }
    }))
}

fn rings(canvas: &mut Canvas, panel: &Panel, points: &[(f64, f64)]) {
    for point in points {
        canvas.ring(panel.at(*point), RING, Stroke::solid(PALETTE[1], 1.1));
    }
}

fn model(canvas: &mut Canvas, panel: &Panel, part: &Part, line: bool) {
    let stroke = Stroke::solid(PALETTE[0], 1.6);
    if line {
        panel.curve(canvas, part.model.iter().copied(), stroke);
        return;
    }
    for point in &part.model {
        canvas.ring(panel.at(*point), 0.5 * RING, stroke);
    }
}

fn legend(canvas: &mut Canvas, line: bool) {
    let (at, words) = (60.0, Words::new(11.0, Anchor::Left));
    canvas.ring((LEFT + 4.0, at), RING, Stroke::solid(PALETTE[1], 1.1));
    canvas.text((LEFT + 14.0, at), "measured", words);
    let next = LEFT + 100.0;
    match line {
        true => canvas.line(&[(next, at), (next + 20.0, at)], Stroke::solid(PALETTE[0], 1.6)),
        false => canvas.ring((next + 10.0, at), 0.5 * RING, Stroke::solid(PALETTE[0], 1.6)),
    }
    canvas.text((next + 28.0, at), "model", words);
}
