//! `floquet.svg`: multipliers about the unit circle.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::Colour;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// One multiplier.
#[derive(Clone, Debug, PartialEq)]
pub struct Dot {
    /// Real part.
    pub re: f64,
    /// Imaginary part; the conjugate is drawn too.
    pub im: f64,
    /// What it belongs to.
    pub name: String,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Multipliers {
    /// Name of the case.
    pub case: String,
    /// The verdict.
    pub words: String,
    /// Largest first.
    pub dots: Vec<Dot>,
}

const SIDE: f64 = 420.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 64.0;
const CIRCLE: Colour = Colour(0x6b, 0x72, 0x7a);
const INSIDE: Colour = Colour(0x00, 0x72, 0xb2);
const OUTSIDE: Colour = Colour(0xb5, 0x2b, 0x2b);
/// Dots with a name beside them.
const NAMED: usize = 6;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Multipliers) -> Option<String> {
    let first = data.dots.first()?;
    let reach = 1.15 * first.re.hypot(first.im).max(1.0);
    let panel = Panel::new(
        Place::new(LEFT, TOP, SIDE, SIDE),
        Scale::exact(-reach, reach, "1", 6),
        Scale::exact(-reach, reach, "1", 6),
    );
    Some(picture(LEFT + SIDE + 250.0, TOP + SIDE + 52.0, |canvas| {
        title(
            canvas,
            16.0,
            &format!("{} · Floquet multipliers", data.case),
            &data.words,
        );
        panel.grid(canvas);
        let circle = (0..=180).map(|k| f64::from(k) * std::f64::consts::TAU / 180.0);
        panel.curve(canvas, circle.map(|a| (a.cos(), a.sin())), Stroke::solid(CIRCLE, 1.2));
        for dot in &data.dots {
            let colour = if dot.re.hypot(dot.im) > 1.0 { OUTSIDE } else { INSIDE };
            for im in [dot.im, -dot.im] {
                disc(canvas, panel.at((dot.re, im)), colour);
            }
        }
        panel.axes(canvas, Some("real part"), "imaginary part");
        for (k, dot) in data.dots.iter().take(NAMED).enumerate() {
            let y = TOP + 16.0 + 38.0 * k as f64;
            let colour = if dot.re.hypot(dot.im) > 1.0 { OUTSIDE } else { INSIDE };
            disc(canvas, (LEFT + SIDE + 18.0, y), colour);
            let at = (LEFT + SIDE + 30.0, y);
            canvas.text(at, &dot.name, Words::new(11.5, Anchor::Left));
            let sign = if dot.im > 0.0 {
                format!(" ± {:.4} i", dot.im)
            } else {
                String::new()
            };
            let value = format!("{:.4}{sign}", dot.re).replacen('-', "−", 1);
            let faint = Words::new(11.0, Anchor::Left).coloured(FAINT_INK);
            canvas.text((at.0, y + 15.0), &value, faint);
        }
    }))
}

fn disc(canvas: &mut Canvas, (x, y): (f64, f64), colour: Colour) {
    let points: Vec<_> = (0..16)
        .map(|k| f64::from(k) * std::f64::consts::TAU / 16.0)
        .map(|angle| (x + 3.6 * angle.cos(), y + 3.6 * angle.sin()))
        .collect();
    canvas.polygon(&points, colour);
}
