//! `deflection.svg`: shapes of the beam over the last cycle, blue to red.

use super::canvas::LineStyle;
use super::colour::Colour;
use super::picture::{Panel, Picture, PictureAxis, PictureSeries, equally_scaled};
use super::{TimeSpan, extent, over_time, time_bar};
use crate::discrete::quantities::PlacedNodes;

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
    /// Places of the nodes of a structure, and the names of its beams.
    pub structure: Option<(PlacedNodes, Vec<String>)>,
}

/// Displacement, relative to the length, above which the shape is also drawn to scale.
const LARGE: f64 = 0.05;
/// Displacement, relative to the length, below which it is round-off.
const SMALL: f64 = 1e-7;

/// Width of a panel [pt].
const WIDTH: f64 = 560.0;

/// Largest number of beams of a structure with panels of their own.
const MOST_BEAMS: usize = 8;

/// Color of a straight structure.
const STRAIGHT: Colour = Colour(0xb4, 0xba, 0xc2);

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(data: &Deflection) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    if let Some((nodes, beams)) = &data.structure {
        return of_structure(data, nodes, beams);
    }
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

/// Picture of a structure: its shape to scale, and the displacements of each beam along its own axes.
fn of_structure(data: &Deflection, nodes: &PlacedNodes, beams: &[String]) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    let both = || data.u1.iter().zip(&data.u3);
    let all: Vec<_> = both().map(|(u1, u3)| nodes.line(u1, u3)).collect();
    let mut shape = structure_panel(nodes, over_time(&data.times, all), WIDTH)?;
    shape.bar = Some(time_bar(from, to));
    let mut rows = vec![vec![shape]];
    let parts = nodes.parts();
    for (beam, name) in beams.iter().enumerate().take(MOST_BEAMS) {
        let own: Vec<_> = parts.iter().filter(|part| nodes.beam[part.start] == beam).collect();
        let end = own.last().map_or(0.0, |part| nodes.theta[part.end - 1]);
        let along = PictureAxis::new("θ", "m", 5).between(0.0, end);
        let panel = |(symbol, u): (&str, &Vec<Vec<f64>>)| {
            let curve = |u: &Vec<f64>| -> Vec<(f64, f64)> {
                let nodes_of = own.iter().flat_map(|part| (*part).clone());
                nodes_of.map(|node| (nodes.theta[node], u[node])).collect()
            };
            let y = PictureAxis::new(symbol, "m", 5).above(SMALL * end);
            let curves = over_time(&data.times, u.iter().map(curve));
            Panel::new((WIDTH / 2.0 - 40.0, 130.0), along.clone(), y, curves).headed(name.as_str())
        };
        rows.push([("u₁", &data.u1), ("u₃", &data.u3)].into_iter().map(panel).collect());
    }
    let mut about = super::about(data.span, from, to);
    about += "; u₁ and u₃ along the axes of each beam";
    if beams.len() > MOST_BEAMS {
        about += &format!(", of the first {MOST_BEAMS} beams");
    }
    Picture {
        title: format!("{} · deflection", data.case),
        about,
        rows,
    }
    .svg()
}

/// Panel of shapes of a structure to scale, over its straight shape; `width` in points. None without nodes.
pub fn structure_panel(nodes: &PlacedNodes, shapes: Vec<PictureSeries>, width: f64) -> Option<Panel> {
    let zeros = vec![0.0; nodes.beam.len()];
    let straight = PictureSeries::line(nodes.line(&zeros, &zeros), LineStyle::dashed(STRAIGHT, 1.1, (4.0, 3.0)));
    let series: Vec<PictureSeries> = [straight].into_iter().chain(shapes).collect();
    let over = |of: fn(&(f64, f64)) -> f64| extent(series.iter().flat_map(|one| one.points().iter().map(of)));
    let (z, x, height) = equally_scaled(over(|p| p.0)?, over(|p| p.1)?, width);
    let z = PictureAxis::new("z", "m", 8).between(z.0, z.1);
    let x = PictureAxis::new("x", "m", ((height / 30.0) as usize).max(3)).between(x.0, x.1);
    Some(Panel::new((width, height), z, x, series).headed("shape to scale; dashed: straight"))
}
