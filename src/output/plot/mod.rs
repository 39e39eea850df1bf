//! Pictures: plain data to SVG text or PDF. One picture per file; absent data give no picture.
//!
//! ```text
//! picture     a picture as data: panels, axes, series, color scales
//! layout      positions of its panels, labels and legends
//! drawing     the only code that draws a picture
//! canvas      lines, areas and text of a drawing, in points
//! svg, pdf    a drawing as SVG, and as PDF with its font
//! style       sizes, fonts and lines of pictures for screens and for papers
//! colour      color scales, and a palette that every reader can distinguish
//! ticks       round numbers along an axis, with SI prefixes
//! labels      labels without overlap
//! deflection, pressure, history, energy   a run
//! designs     many designs along one number, or over two
//! cell        a cell of the section under one load
//! ```
//!
//! Pictures of a single command are built beside its files.

pub mod canvas;
pub mod colour;
mod drawing;
mod labels;
mod layout;
pub mod pdf;
pub mod picture;
pub mod style;
mod svg;
mod ticks;

pub mod cell;
pub mod deflection;
pub mod designs;
pub mod energy;
pub mod history;
pub mod pressure;

use self::canvas::LineStyle;
use self::picture::{ColourBar, PictureAxis, PictureSeries};
use super::numbers;
use crate::discrete::quantities::Observable;
use crate::study::companion::band::width_at;
use colour::Colour;

pub use deflection::Deflection;
pub use layout::width_of;
pub use pressure::Pressure;

/// A named line over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlottedCurve {
    /// Column name, without unit.
    pub name: String,
    /// Unit as in the column.
    pub unit: String,
    /// Time [s] and value, in order of time; not finite if absent.
    pub points: Vec<(f64, f64)>,
    /// Time [s] and half width of the error band; empty if there is none.
    pub widths: Vec<(f64, f64)>,
}

/// Half width of a band, relative to the range of its curves, below which the line hides it.
const HIDDEN: f64 = 3e-3;

/// Error bands of curves in one panel, each in its color, without those that a line hides; `floor` is the smallest half range of the axis.
fn error_bands<'a>(curves: impl Iterator<Item = (&'a PlottedCurve, Colour)> + Clone, floor: f64) -> Vec<PictureSeries> {
    let values = curves.clone().flat_map(|(curve, _)| curve.points.iter().map(|p| p.1));
    let (low, high) = extent(values).unwrap_or_default();
    let least = HIDDEN * (high - low).max(2.0 * floor);
    let band = |(curve, colour): (&PlottedCurve, Colour)| {
        let wide = curve.widths.iter().any(|(_, width)| *width > least);
        let around = |(t, y): &(f64, f64)| width_at(&curve.widths, *t).map(|width| (*t, y - width, y + width));
        let points = || {
            curve
                .points
                .iter()
                .filter(|p| p.1.is_finite())
                .filter_map(around)
                .collect::<Vec<_>>()
        };
        wide.then(|| PictureSeries::shade(&points(), colour))
    };
    curves.filter_map(band).collect()
}

impl PlottedCurve {
    /// The observable with this name, if there is one.
    pub fn observable(&self) -> Option<Observable> {
        Observable::named(&self.name)
    }

    /// Largest magnitude; 0 if there are no values.
    pub fn max_abs(&self) -> f64 {
        let finite = self.points.iter().map(|p| p.1.abs()).filter(|y| y.is_finite());
        finite.fold(0.0, f64::max)
    }
}

/// Part of a run shown in pictures over space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeSpan {
    /// The last cycle of the drive.
    LastCycle,
    /// Everything.
    WholeRun,
}

impl TimeSpan {
    fn label(self) -> &'static str {
        match self {
            Self::LastCycle => "last cycle",
            Self::WholeRun => "whole run",
        }
    }
}

/// Chooses about `count` instants for a picture over space, evenly spread over the last cycle. Without a frequency, or for a run shorter
/// than a cycle, they spread over the whole run. Returns indices into `times`.
pub fn instants(times: &[f64], frequency_hz: Option<f64>, count: usize) -> (TimeSpan, Vec<usize>) {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return (TimeSpan::WholeRun, Vec::new());
    };
    let cycle = frequency_hz.filter(|f| *f > 0.0).map(f64::recip);
    let (span, start) = match cycle {
        Some(cycle) if last - first >= cycle => (TimeSpan::LastCycle, last - cycle),
        _ => (TimeSpan::WholeRun, first),
    };
    let nearest = |t: f64| {
        let after = times.partition_point(|&x| x < t).min(times.len() - 1);
        if after > 0 && t - times[after - 1] < times[after] - t {
            after - 1
        } else {
            after
        }
    };
    let steps = count.max(2) - 1;
    let wanted = (0..=steps).map(|k| start + (last - start) * k as f64 / steps as f64);
    let mut chosen: Vec<usize> = wanted.map(nearest).collect();
    chosen.dedup();
    (span, chosen)
}

/// Least and largest finite value; `None` if there are none.
pub fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|x| x.is_finite()).fold(None, |so_far, x| match so_far {
        None => Some((x, x)),
        Some((lo, hi)) => Some((f64::min(lo, x), f64::max(hi, x))),
    })
}

/// Text about the displayed part of the run.
fn about(span: TimeSpan, from: f64, to: f64) -> String {
    let time = |t: f64| numbers::trimmed(&numbers::quantity(t, "s", 4));
    if from == to {
        return format!("at {}", time(to));
    }
    format!("{}, {} to {}", span.label(), time(from), time(to))
}

/// Curves in the colors of their times.
pub fn over_time(times: &[f64], curves: impl IntoIterator<Item = Vec<(f64, f64)>>) -> Vec<PictureSeries> {
    let (from, to) = extent(times.iter().copied()).unwrap_or_default();
    let range = if to > from { to - from } else { 1.0 };
    let colours = times.iter().map(|t| colour::of_time((t - from) / range));
    let lines = colours
        .zip(curves)
        .map(|(colour, curve)| PictureSeries::line(curve, LineStyle::solid(colour, 1.3)));
    lines.collect()
}

/// Time axis of curves; `None` if they have no points.
fn times_of<'a>(curves: impl Iterator<Item = &'a PlottedCurve>) -> Option<PictureAxis> {
    let (from, to) = extent(curves.flat_map(|c| c.points.iter().map(|p| p.0)))?;
    Some(PictureAxis::new("time t", "s", 10).between(from, to))
}

/// Color scale of times.
fn time_bar(from: f64, to: f64) -> ColourBar {
    ColourBar {
        colours: colour::scale(colour::of_time),
        axis: PictureAxis::new("t", "s", 5).between(from, to),
        besides: None,
    }
}
