//! `optimum.svg`: what is sought over the designs that were computed, and over each number.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::PALETTE;
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// A design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Where it stands.
    pub at: (f64, f64),
    /// Whether it holds the limits.
    pub held: bool,
}

/// What is drawn over one abscissa.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Name of the abscissa.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Whether it goes by its logarithm.
    pub logarithmic: bool,
    /// Designs.
    pub dots: Vec<Dot>,
    /// The best.
    pub best: Option<(f64, f64)>,
}

/// What is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Optimum {
    /// Title.
    pub name: String,
    /// What was found, in words.
    pub about: String,
    /// The figure.
    pub figure: String,
    /// Its unit.
    pub unit: String,
    /// Panels: designs in order, then numbers.
    pub parts: Vec<Part>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 76.0;
const WIDTH: f64 = 620.0;
const HEIGHT: f64 = 190.0;
const GAP: f64 = 62.0;
const RING: f64 = 2.6;
/// Numbers drawn at most.
const MOST: usize = 6;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Optimum) -> Option<String> {
    let parts = &data.parts[..data.parts.len().min(MOST + 1)];
    let values = || {
        parts
            .first()
            .map(|part| part.dots.iter().map(|dot| dot.at.1))
            .into_iter()
            .flatten()
    };
    let y = extent(values())?;
    let bottom = TOP + parts.len() as f64 * (HEIGHT + GAP) - GAP;
    Some(picture(LEFT + WIDTH + 30.0, bottom + 48.0, |canvas| {
        title(canvas, LEFT, &data.name, &data.about);
        legend(canvas);
        for (k, part) in parts.iter().enumerate() {
            let place = Place::new(LEFT, TOP + k as f64 * (HEIGHT + GAP), WIDTH, HEIGHT);
            let along = |x: f64| if part.logarithmic { x.log10() } else { x };
            let Some(range) = extent(part.dots.iter().map(|dot| along(dot.at.0))) else {
                continue;
            };
            let x = match part.logarithmic {
                true => Scale::logarithmic(range, 0.03, &[1.0, 2.0, 5.0], (&part.unit, 8)),
                false => Scale::around(Some(range), 0.0, &part.unit, 8),
            };
            let panel = Panel::new(place, x, Scale::around(Some(y), 0.0, &data.unit, 5));
            panel.grid(canvas);
            if k == 0 {
                best_so_far(canvas, &panel, part);
            }
            for dot in &part.dots {
                let colour = if dot.held { PALETTE[0] } else { FAINT_INK };
                canvas.ring(panel.at((along(dot.at.0), dot.at.1)), RING, Stroke::solid(colour, 1.1));
            }
            if let Some((x, value)) = part.best {
                canvas.ring(panel.at((along(x), value)), 2.0 * RING, Stroke::solid(PALETTE[1], 1.6));
            }
            panel.axes(canvas, Some(part.name.as_str()), &data.figure);
        }
    }))
}

/// A faint line through the designs in order.
fn best_so_far(canvas: &mut Canvas, panel: &Panel, part: &Part) {
    let points = part.dots.iter().map(|dot| dot.at);
    panel.curve(canvas, points, Stroke::dashed(PALETTE[9], 0.8, (3.0, 3.0)));
}

fn legend(canvas: &mut Canvas) {
    let (at, words) = (60.0, Words::new(11.0, Anchor::Left));
    for (left, radius, stroke, text) in [
        (0.0, RING, Stroke::solid(PALETTE[0], 1.1), "a design"),
        (90.0, RING, Stroke::solid(FAINT_INK, 1.1), "beyond a limit"),
        (210.0, 2.0 * RING, Stroke::solid(PALETTE[1], 1.6), "the best"),
    ] {
        canvas.ring((LEFT + left + 4.0, at), radius, stroke);
        canvas.text((LEFT + left + 16.0, at), text, words);
    }
}
