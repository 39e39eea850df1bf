//! `deflection.svg`: shapes of the beam over the last cycle, blue to red.

use super::canvas::{Canvas, Stroke, picture};
use super::panel::{Panel, Place, time_bar, title};
use super::ticks::Scale;
use super::{Span, colour, extent};

/// Displacements of the beam at a few instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Deflection {
    /// Name of the case.
    pub case: String,
    /// What the instants span.
    pub span: Span,
    /// Times [s].
    pub times: Vec<f64>,
    /// Material coordinate [m].
    pub theta: Vec<f64>,
    /// Transverse displacement [m], one array an instant.
    pub u1: Vec<Vec<f64>>,
    /// Axial displacement [m], likewise.
    pub u3: Vec<Vec<f64>>,
}

/// Share of the length beyond which displacements are drawn as the shape they make, too.
const LARGE: f64 = 0.05;
/// Share of the length below which displacements are round-off.
const SMALL: f64 = 1e-7;

const LEFT: f64 = 72.0;
const TOP: f64 = 66.0;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 176.0;
const GAP: f64 = 22.0;
const SHEET: f64 = 740.0;

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Deflection) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    let (start, end) = extent(data.theta.iter().copied())?;
    let length = end - start;
    if length <= 0.0 {
        return None;
    }
    let e1 = extent(data.u1.iter().flatten().copied());
    let e3 = extent(data.u3.iter().flatten().copied());
    let largest = [e1, e3]
        .iter()
        .flatten()
        .fold(0.0, |m: f64, e| m.max(e.0.abs()).max(e.1.abs()));
    let x = Scale::exact(start, end, "m", 8);
    let floor = SMALL * length;
    let panels = [
        ("transverse u₁", &data.u1, Scale::around(e1, floor, "m", 5)),
        ("axial u₃", &data.u3, Scale::around(e3, floor, "m", 5)),
    ];
    let drawn = panels.iter().filter(|(_, u, _)| !u.is_empty()).count();
    if drawn == 0 {
        return None;
    }
    let shape = (largest > LARGE * length && drawn == 2)
        .then(|| Shape::of(data))
        .flatten();
    let last = TOP + drawn as f64 * HEIGHT + (drawn - 1) as f64 * GAP;
    let bottom = shape.as_ref().map_or(last, |s| last + 62.0 + s.height);
    Some(picture(SHEET, bottom + 48.0, |canvas| {
        title(
            canvas,
            LEFT,
            &format!("{} · deflection", data.case),
            &super::about(data.span, from, to),
        );
        for (k, (name, u, y)) in panels.into_iter().filter(|(_, u, _)| !u.is_empty()).enumerate() {
            let top = TOP + k as f64 * (HEIGHT + GAP);
            let place = Place::new(LEFT, top, WIDTH, HEIGHT);
            let panel = Panel { place, x: x.clone(), y };
            let curves = u.iter().map(|u| data.theta.iter().copied().zip(u.iter().copied()));
            draw_over_time(canvas, &panel, &data.times, curves);
            let x_name = (k + 1 == drawn).then_some("material coordinate θ");
            panel.axes(canvas, x_name, name);
        }
        if let Some(shape) = shape {
            let place = Place::new(LEFT, last + 62.0, WIDTH, shape.height);
            let panel = Panel::new(place, shape.z, shape.x);
            let curves = data.u1.iter().zip(&data.u3).map(|(u1, u3)| {
                let z = data.theta.iter().zip(u3).map(|(t, u)| t + u);
                z.zip(u1.iter().copied())
            });
            draw_over_time(canvas, &panel, &data.times, curves);
            panel.axes(canvas, Some("shape: z = θ + u₃"), "x = u₁");
        }
        let bar = Place::new(LEFT + WIDTH + 26.0, TOP + 8.0, 15.0, last - TOP - 8.0);
        time_bar(canvas, bar, from, to);
    }))
}

/// Axes of the true shape, equally scaled.
struct Shape {
    x: Scale,
    z: Scale,
    height: f64,
}

impl Shape {
    fn of(data: &Deflection) -> Option<Self> {
        let z = data
            .u3
            .iter()
            .flat_map(|u3| data.theta.iter().zip(u3).map(|(t, u)| t + u));
        let z = Scale::around(extent(z), 0.0, "m", 8);
        let (lo, hi) = extent(data.u1.iter().flatten().copied())?;
        let per_point = (z.hi - z.lo) / WIDTH;
        let height = ((hi - lo) * 1.1 / per_point).clamp(60.0, 420.0);
        let half = 0.5 * height * per_point;
        let middle = 0.5 * (lo + hi);
        let x = Scale::exact(middle - half, middle + half, "m", ((height / 30.0) as usize).max(3));
        Some(Self { x, z, height })
    }
}

/// Curves in the colours of their times, over the grid.
pub(super) fn draw_over_time<C: Iterator<Item = (f64, f64)>>(
    canvas: &mut Canvas,
    panel: &Panel,
    times: &[f64],
    curves: impl Iterator<Item = C>,
) {
    panel.grid(canvas);
    let (from, to) = (times[0], times[times.len() - 1]);
    let range = if to > from { to - from } else { 1.0 };
    for (t, curve) in times.iter().zip(curves) {
        panel.curve(canvas, curve, Stroke::solid(colour::of_time((t - from) / range), 1.3));
    }
}
