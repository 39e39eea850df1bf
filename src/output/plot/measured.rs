//! `slcbeam measure --plot`: data, fit with its band of 95 %, and what the fit leaves.

use super::canvas::{Stroke, picture};
use super::colour::{Colour, PALETTE};
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// Data and fit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// What was measured.
    pub name: String,
    /// What was found, in words.
    pub about: String,
    /// Names of what was set and what was measured, with their SI units.
    pub axes: [(String, String); 2],
    /// Points of the data.
    pub points: Vec<(f64, f64)>,
    /// What the fit leaves of each.
    pub residuals: Vec<f64>,
    /// The fit and half of the width of its band: `(x, y, half)`.
    pub fit: Vec<(f64, f64, f64)>,
}

const LEFT: f64 = 84.0;
const WIDTH: f64 = 520.0;
const BAND: Colour = Colour(0xd5, 0xe3, 0xf0);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Measured) -> Option<String> {
    if data.points.len() < 2 || data.fit.len() < 2 {
        return None;
    }
    let [(x_name, x_unit), (y_name, y_unit)] = &data.axes;
    let xs = || Scale::around(extent(data.points.iter().map(|p| p.0)), 0.0, x_unit, 7);
    let banded = data.fit.iter().flat_map(|(_, y, half)| [y - half, y + half]);
    let ys = Scale::around(extent(data.points.iter().map(|p| p.1).chain(banded)), 0.0, y_unit, 7);
    let halves = data.fit.iter().flat_map(|(.., half)| [-half, *half]);
    let left_over = Scale::around(extent(data.residuals.iter().copied().chain(halves)), 0.0, y_unit, 4);
    Some(picture(LEFT + WIDTH + 30.0, 560.0, |canvas| {
        title(canvas, LEFT, &data.name, &data.about);
        let upper = Panel::new(Place::new(LEFT, 66.0, WIDTH, 280.0), xs(), ys);
        // about the fit, or about zero where residuals stand
        let band = |panel: &Panel, about_fit: f64| {
            let above = data.fit.iter().map(|(x, y, half)| (*x, about_fit * y + half));
            let below = data.fit.iter().rev().map(|(x, y, half)| (*x, about_fit * y - half));
            above.chain(below).map(|p| panel.at(p)).collect::<Vec<_>>()
        };
        canvas.polygon(&band(&upper, 1.0), BAND);
        upper.grid(canvas);
        upper.curve(
            canvas,
            data.fit.iter().map(|(x, y, _)| (*x, *y)),
            Stroke::solid(PALETTE[0], 1.6),
        );
        for point in &data.points {
            canvas.ring(upper.at(*point), 2.6, Stroke::solid(PALETTE[1], 1.1));
        }
        upper.axes(canvas, None, y_name);
        let lower = Panel::new(Place::new(LEFT, 370.0, WIDTH, 130.0), xs(), left_over);
        canvas.polygon(&band(&lower, 0.0), BAND);
        lower.grid(canvas);
        for ((x, _), residual) in data.points.iter().zip(&data.residuals) {
            canvas.ring(lower.at((*x, *residual)), 2.6, Stroke::solid(PALETTE[1], 1.1));
        }
        lower.axes(canvas, Some(x_name), "residual");
    }))
}
