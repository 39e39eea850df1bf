//! `slcbeam sense`: loads with their bands, pressures as measured and as the loads make them, what more sensors are worth.

use super::canvas::{Stroke, picture};
use super::colour::{Colour, PALETTE};
use super::extent;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;

/// A line with its band and points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Places, values and half of the width of the band.
    pub line: Vec<(f64, f64, f64)>,
    /// Points besides.
    pub points: Vec<(f64, f64)>,
}

/// One pair of axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Names and units of the axes.
    pub axes: [(String, String); 2],
    /// What is drawn, each in a colour of its own.
    pub series: Vec<Series>,
}

/// The picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Name of the case.
    pub case: String,
    /// What it is of.
    pub about: String,
    /// Its parts.
    pub parts: Vec<Part>,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 66.0;
const WIDTH: f64 = 330.0;
const HEIGHT: f64 = 220.0;
const BESIDE: f64 = 96.0;
const BELOW: f64 = 66.0;
const BAND: Colour = Colour(0xd5, 0xe3, 0xf0);

/// Draws it, two parts beside each other; `None` when there is nothing to draw.
pub fn draw(data: &Drawn) -> Option<String> {
    if data.parts.is_empty() {
        return None;
    }
    let (columns, rows) = (data.parts.len().min(2), data.parts.len().div_ceil(2));
    let width = LEFT + columns as f64 * (WIDTH + BESIDE) - BESIDE + 30.0;
    let height = TOP + rows as f64 * (HEIGHT + BELOW);
    Some(picture(width.max(560.0), height, |canvas| {
        title(canvas, LEFT, &data.case, &data.about);
        for (k, part) in data.parts.iter().enumerate() {
            let (row, column) = ((k / 2) as f64, (k % 2) as f64);
            let place = Place::new(
                LEFT + column * (WIDTH + BESIDE),
                TOP + row * (HEIGHT + BELOW),
                WIDTH,
                HEIGHT,
            );
            let [(x_name, x_unit), (y_name, y_unit)] = &part.axes;
            let lines = || part.series.iter().flat_map(|s| &s.line);
            let points = || part.series.iter().flat_map(|s| &s.points);
            let xs = extent(lines().map(|p| p.0).chain(points().map(|p| p.0)));
            let ys = lines().flat_map(|(_, y, half)| [y - half, y + half]);
            let ys = extent(ys.chain(points().map(|p| p.1)).chain([0.0]));
            let panel = Panel::new(
                place,
                Scale::around(xs, 0.0, x_unit, 7),
                Scale::around(ys, 0.0, y_unit, 6),
            );
            for one in &part.series {
                let above = one.line.iter().map(|(x, y, half)| (*x, y + half));
                let below = one.line.iter().rev().map(|(x, y, half)| (*x, y - half));
                let band: Vec<_> = above.chain(below).map(|p| panel.at(p)).collect();
                if one.line.iter().any(|p| p.2 > 0.0) {
                    canvas.polygon(&band, BAND);
                }
            }
            panel.grid(canvas);
            for (one, colour) in part.series.iter().zip(PALETTE.iter().cycle()) {
                let line = one.line.iter().map(|(x, y, _)| (*x, *y));
                panel.curve(canvas, line, Stroke::solid(*colour, 1.6));
                for point in &one.points {
                    canvas.ring(panel.at(*point), 2.6, Stroke::solid(*colour, 1.1));
                }
            }
            panel.axes(canvas, Some(x_name), y_name);
        }
    }))
}
