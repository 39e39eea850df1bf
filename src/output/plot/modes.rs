//! `modes.svg`: the shapes of modes, displacements on the left, pressures on the right.

use nalgebra::Complex;

use super::canvas::{Anchor, Canvas, INK, Stroke, Words, picture};
use super::colour::{Colour, PALETTE};
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// One mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// Its number in the table.
    pub number: usize,
    /// What it does, in a few words.
    pub words: String,
    /// Whether it grows.
    pub grows: bool,
    /// Transverse displacement of each node [m].
    pub u1: Vec<Complex<f64>>,
    /// Axial displacement of each node [m].
    pub u3: Vec<Complex<f64>>,
    /// Pressure of each bladder, upper row first [Pa].
    pub pressure: Vec<Complex<f64>>,
}

/// The modes of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeShapes {
    /// Name of the case.
    pub case: String,
    /// State about which.
    pub about: String,
    /// Material coordinate of the nodes [m].
    pub theta: Vec<f64>,
    /// Bladders in a row.
    pub per_row: usize,
    /// Modes, in the order of the table.
    pub modes: Vec<Shown>,
}

/// Modes that are drawn.
const MOST: usize = 8;
const LEFT: f64 = 78.0;
const TOP: f64 = 84.0;
const WIDTH: f64 = 380.0;
const HEIGHT: f64 = 112.0;
const GAP: f64 = 44.0;
const BESIDE: f64 = 110.0;
const UNSTABLE: Colour = Colour(0xb0, 0x1c, 0x2e);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &ModeShapes) -> Option<String> {
    let (start, end) = extent(data.theta.iter().copied())?;
    let shown = &data.modes[..data.modes.len().min(MOST)];
    if shown.is_empty() || end <= start {
        return None;
    }
    let wet = data.per_row > 0;
    let sheet = LEFT + WIDTH + 24.0 + if wet { BESIDE + WIDTH } else { 0.0 };
    let rows = shown.len() as f64;
    let x = Scale::exact(start, end, "m", 6);
    Some(picture(sheet, TOP + rows * (HEIGHT + GAP) + 12.0, |canvas| {
        let about = format!(
            "about {}; full lines in phase, dashed a quarter of a period behind",
            data.about
        );
        title(canvas, LEFT, &format!("{} · modes", data.case), &about);
        legend(canvas, LEFT, &["u₁ across", "u₃ along"]);
        if wet {
            legend(canvas, LEFT + WIDTH + BESIDE, &["upper row", "lower row"]);
        }
        for (k, mode) in shown.iter().enumerate() {
            let last = k + 1 == shown.len();
            let place = Place::new(LEFT, TOP + 14.0 + k as f64 * (HEIGHT + GAP), WIDTH, HEIGHT);
            let words = Words {
                bold: true,
                ..Words::new(12.0, Anchor::Left).coloured(if mode.grows { UNSTABLE } else { INK })
            };
            let text = format!("{}  {}", mode.number, mode.words);
            canvas.text((place.left, place.top - 12.0), &text, words);
            let name = last.then_some("material coordinate θ");
            let lines = [(&data.theta[..], &mode.u1[..]), (&data.theta, &mode.u3)];
            curves(canvas, place, x.clone(), "m", lines, name, "u");
            if wet && mode.pressure.len() == 2 * data.per_row {
                let place = Place {
                    left: LEFT + WIDTH + BESIDE,
                    ..place
                };
                let numbers: Vec<f64> = (1..=data.per_row).map(|j| j as f64).collect();
                let x = Scale::exact(0.5, data.per_row as f64 + 0.5, "1", 10);
                let (upper, lower) = mode.pressure.split_at(data.per_row);
                let name = last.then_some("bladder");
                curves(
                    canvas,
                    place,
                    x,
                    "Pa",
                    [(&numbers, upper), (&numbers, lower)],
                    name,
                    "p",
                );
            }
        }
    }))
}

/// Two complex lines over a place of the sheet.
fn curves(
    canvas: &mut Canvas,
    place: Place,
    x: Scale,
    unit: &str,
    lines: [(&[f64], &[Complex<f64>]); 2],
    x_name: Option<&str>,
    y_name: &str,
) {
    let parts = lines.iter().flat_map(|(_, y)| y.iter().flat_map(|y| [y.re, y.im]));
    let size = parts.clone().fold(0.0_f64, |m, y| m.max(y.abs()));
    let y = Scale::around(extent(parts), (1e-3 * size).max(f64::MIN_POSITIVE.sqrt()), unit, 3);
    let panel = Panel { place, x, y };
    panel.grid(canvas);
    for ((x, y), colour) in lines.into_iter().zip(PALETTE) {
        let behind = Stroke::dashed(colour, 1.1, (4.0, 3.0));
        // what is in phase throughout has no second part to show
        if y.iter().any(|y| y.im.abs() > 1e-3 * size) {
            panel.curve(canvas, x.iter().copied().zip(y.iter().map(|y| y.im)), behind);
        }
        let ahead = Stroke::solid(colour, 1.6);
        panel.curve(canvas, x.iter().copied().zip(y.iter().map(|y| y.re)), ahead);
    }
    panel.axes(canvas, x_name, y_name);
}

fn legend(canvas: &mut Canvas, left: f64, names: &[&str]) {
    for (k, (name, colour)) in names.iter().zip(PALETTE).enumerate() {
        let at = left + k as f64 * 96.0;
        let y = TOP - 22.0;
        canvas.line(&[(at, y), (at + 18.0, y)], Stroke::solid(colour, 1.8));
        canvas.text((at + 24.0, y), name, Words::new(11.5, Anchor::Left));
    }
}
