//! `deflection.svg`: shapes of the beam over the last cycle, blue to red.

use super::picture::{Panel, Picture, PictureAxis, equally_scaled};
use super::{TimeSpan, extent, over_time, time_bar};

/// Displacements of the beam at a few instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Deflection {
    /// Name of the case.
    pub case: String,
    /// Part of the run that the instants span.
    pub span: TimeSpan,
    /// Times [s].
    pub times: Vec<f64>,
    /// Material coordinate [m].
    pub theta: Vec<f64>,
    /// Transverse displacement [m], one array per instant.
    pub u1: Vec<Vec<f64>>,
    /// Axial displacement [m], one array per instant.
    pub u3: Vec<Vec<f64>>,
}

/// Displacement, relative to the length, above which the shape is also drawn to scale.
const LARGE: f64 = 0.05;
/// Displacement, relative to the length, below which it is round-off.
const SMALL: f64 = 1e-7;

/// Width of a panel [pt].
const WIDTH: f64 = 560.0;

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(data: &Deflection) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    let (start, end) = extent(data.theta.iter().copied())?;
    let length = end - start;
    if length <= 0.0 {
        return None;
    }
    let theta = || data.theta.iter().copied();
    let along = PictureAxis::new("material coordinate θ", "m", 8).between(start, end);
    let both = [("transverse u₁", &data.u1), ("axial u₃", &data.u3)];
    let drawn = both.into_iter().filter(|(_, u)| !u.is_empty());
    let mut panels: Vec<Panel> = drawn
        .map(|(name, u)| {
            let curves = u.iter().map(|u| theta().zip(u.iter().copied()).collect());
            let y = PictureAxis::new(name, "m", 5).above(SMALL * length);
            Panel::new((WIDTH, 176.0), along.clone(), y, over_time(&data.times, curves))
        })
        .collect();
    panels.first_mut()?.bar = Some(time_bar(from, to));
    let all = data.u1.iter().chain(&data.u3).flatten();
    let largest = all.fold(0.0, |m: f64, u| m.max(u.abs()));
    if largest > LARGE * length && panels.len() == 2 {
        panels.extend(shape(data));
    }
    let about = super::about(data.span, from, to);
    Picture::stacked(format!("{} · deflection", data.case), about, panels).svg()
}

/// Panel of the shape to scale.
fn shape(data: &Deflection) -> Option<Panel> {
    let curve = |(u1, u3): (&Vec<f64>, &Vec<f64>)| -> Vec<(f64, f64)> {
        let z = data.theta.iter().zip(u3).map(|(t, u)| t + u);
        z.zip(u1.iter().copied()).collect()
    };
    let curves: Vec<_> = data.u1.iter().zip(&data.u3).map(curve).collect();
    let over = |of: fn(&(f64, f64)) -> f64| extent(curves.iter().flatten().map(of));
    let (z, x, height) = equally_scaled(over(|p| p.0)?, over(|p| p.1)?, WIDTH);
    let z = PictureAxis::new("shape: z = θ + u₃", "m", 8).between(z.0, z.1);
    let x = PictureAxis::new("x = u₁", "m", ((height / 30.0) as usize).max(3)).between(x.0, x.1);
    Some(Panel::new((WIDTH, height), z, x, over_time(&data.times, curves)))
}
