//! `study.svg`: cost of accuracy. Error on the horizontal axis, time on the vertical axis, both logarithmic; one line per mesh and method,
//! one marker per tolerance.

use std::f64::consts::FRAC_PI_2;

use super::canvas::{FAINT_INK, INK, LineStyle, TextAnchor, TextStyle};
use super::colour::{Colour, PALETTE};
use super::extent;
use super::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use crate::case::schema::Method;
use crate::output::numbers::significant;
use crate::study::accuracy::Scheme;

/// A run as a marker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunMarker {
    /// Relative error.
    pub error: f64,
    /// Relative error of the time integration alone.
    pub temporal: Option<f64>,
    /// Least wall time [s].
    pub least_s: f64,
    /// Median wall time [s].
    pub median_s: f64,
    /// Tolerance.
    pub rtol: f64,
    /// True if the reference is accurate enough to judge the run.
    pub judged: bool,
    /// True if no other run is cheaper and more accurate.
    pub front: bool,
}

/// Point of equal temporal and spatial error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BalanceMark {
    /// Relative error.
    pub error: f64,
    /// Wall time [s].
    pub seconds: f64,
}

/// Runs with one mesh and scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshLine {
    /// Cells per segment; determines the color.
    pub cells: usize,
    /// Scheme of time integration; determines the marker.
    pub scheme: Scheme,
    /// Runs, from loose to tight tolerance.
    pub markers: Vec<RunMarker>,
    /// Point of equal errors.
    pub balance: Option<BalanceMark>,
}

/// Data of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPrecision {
    /// Name of the case.
    pub case: String,
    /// Quantity whose error is shown.
    pub measure: String,
    /// Own error of the reference.
    pub own: f64,
    /// Largest number of timed runs per point.
    pub repeats: usize,
    /// Lines, ordered by scheme, then by mesh.
    pub lines: Vec<MeshLine>,
    /// True if errors in time have their own panel.
    pub split: bool,
}

/// Radius of a marker [pt].
const RADIUS: f64 = 4.2;

const FRONT: Colour = Colour(0xd9, 0xdd, 0xe1);
const SHADE: Colour = Colour(0xf4, 0xf2, 0xec);

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(data: &WorkPrecision) -> Option<String> {
    let markers = || {
        data.lines
            .iter()
            .flat_map(|l| &l.markers)
            .filter(|m| m.error > 0.0 && m.least_s > 0.0)
    };
    let times = around(extent(markers().flat_map(|m| [m.least_s, m.median_s]))?);
    let errors = around(extent(markers().map(|m| m.error))?);
    let y = PictureAxis::new("wall time of a run", "s", 8)
        .between(times.0, times.1)
        .logarithmic(true);
    let x = |name: &str, (lo, hi): (f64, f64)| PictureAxis::new(name, "1", 8).between(lo, hi).logarithmic(true);
    let mut series = vec![];
    // errors for which the reference is not accurate enough
    let edge = 10.0 * data.own;
    if edge > errors.0 {
        let (lo, hi) = times;
        series.push(PictureSeries::band(
            &[(errors.0, lo, hi), (edge.min(errors.1), lo, hi)],
            SHADE,
        ));
    }
    let mut front: Vec<&RunMarker> = markers().filter(|m| m.front).collect();
    front.sort_by(|a, b| b.error.total_cmp(&a.error));
    let line = PictureSeries::line(front.iter().map(|m| (m.error, m.least_s)), LineStyle::solid(FRONT, 9.0));
    let balances = balances(data);
    series.push(line);
    series.extend(balances.iter().cloned());
    series.extend(lines(data, |m| Some(m.error)));
    // tolerances at the markers of the front
    let words = TextStyle::new(9.5, TextAnchor::Right).coloured(FAINT_INK);
    let label =
        |m: &&RunMarker| PictureSeries::label((m.error, m.least_s), (-8.0, 10.0), format!("{:e}", m.rtol), words);
    series.extend(front.iter().map(label));
    series.extend(notes(data, !balances.is_empty()));
    let across = match data.split {
        true => "relative error, of time and space together",
        false => "relative error",
    };
    let total = Panel {
        legend_beside: true,
        ..Panel::new((560.0, 400.0), x(across, errors), y.clone(), series)
    };
    let in_time = extent(markers().filter_map(|m| m.temporal).filter(|e| *e > 0.0)).filter(|_| data.split);
    let lower = in_time.map(|errors| {
        let x = x("relative error of the time integration alone", around(errors));
        Panel::new((560.0, 300.0), x, y, lines(data, |m| m.temporal))
    });
    let title = format!("{} · what accuracy costs", data.case);
    let about = format!("error of {} against wall time, lower left is better", data.measure);
    Picture::stacked(title, about, [total].into_iter().chain(lower)).svg()
}

/// Adds a margin to a range on a logarithmic axis.
fn around((lo, hi): (f64, f64)) -> (f64, f64) {
    let margin = 10_f64.powf((0.05 * (hi / lo).log10()).max(0.15));
    (lo / margin, hi * margin)
}

/// Markers of every mesh and scheme over an error, joined by lines, with whiskers to their median times.
fn lines(data: &WorkPrecision, error: fn(&RunMarker) -> Option<f64>) -> Vec<PictureSeries> {
    let mut meshes: Vec<usize> = data.lines.iter().map(|l| l.cells).collect();
    meshes.sort_unstable();
    meshes.dedup();
    let mut series = vec![];
    for line in data.lines.iter().filter(|line| !line.markers.is_empty()) {
        let colour = PALETTE[meshes.iter().position(|k| *k == line.cells).unwrap_or(0) % PALETTE.len()];
        let found = |m: &RunMarker| error(m).filter(|e| *e > 0.0 && m.least_s > 0.0);
        let shown: Vec<(&RunMarker, f64)> = line.markers.iter().filter_map(|m| Some((m, found(m)?))).collect();
        let dash = match (line.scheme.method, line.scheme.order) {
            (Method::Ida, 1 | 2) => None,
            (Method::Ida, _) => Some((5.0, 3.5)),
            _ => Some((9.0, 2.5)),
        };
        let cells = if line.cells == 1 { "cell" } else { "cells" };
        let name = format!("{} {cells}, {}", line.cells, line.scheme);
        let stroke = LineStyle {
            dash,
            ..LineStyle::solid(colour, 1.5)
        };
        series.push(PictureSeries::line(shown.iter().map(|(m, e)| (*e, m.least_s)), stroke).named(&*name));
        let whisker = |(m, e): &(&RunMarker, f64)| {
            PictureSeries::line([(*e, m.least_s), (*e, m.median_s)], LineStyle::solid(colour, 1.0))
        };
        series.extend(shown.iter().map(whisker));
        for judged in [true, false] {
            let all = shown
                .iter()
                .filter(|(m, _)| m.judged == judged)
                .map(|(m, e)| (*e, m.least_s));
            let marks = PictureSeries::marks(all, glyph(line.scheme, judged), colour);
            series.push(if judged { marks.named(&*name) } else { marks });
        }
    }
    series
}

/// Lines of equal errors in time and space, one per scheme.
fn balances(data: &WorkPrecision) -> Vec<PictureSeries> {
    let mut schemes: Vec<Scheme> = data.lines.iter().map(|l| l.scheme).collect();
    schemes.dedup();
    let of = |scheme: Scheme| {
        let alike = data.lines.iter().filter(move |l| l.scheme == scheme);
        alike
            .filter_map(|l| l.balance)
            .map(|b| (b.error, b.seconds))
            .collect::<Vec<_>>()
    };
    let all = schemes.into_iter().map(of).filter(|points| !points.is_empty());
    let drawn = all.flat_map(|points| {
        [
            PictureSeries::line(points.iter().copied(), LineStyle::dashed(FAINT_INK, 1.0, (2.0, 4.0))),
            PictureSeries::marks(points, Glyph::Cross(5.0), INK),
        ]
    });
    drawn.collect()
}

/// Legend entries without a line of their own.
fn notes(data: &WorkPrecision, balances: bool) -> Vec<PictureSeries> {
    let front = PictureSeries::line([], LineStyle::solid(FRONT, 9.0));
    let mut all = vec![front.named("no run is cheaper and\nmore accurate; rtol\nbeside it")];
    let none = |glyph: Glyph, colour: Colour| PictureSeries::marks([], glyph, colour);
    if balances {
        all.push(none(Glyph::Cross(5.0), INK).named("error in time equals\nerror in space"));
    }
    if data.lines.iter().flat_map(|l| &l.markers).any(|m| !m.judged) {
        let hollow = none(glyph(Scheme::ida(2), false), FAINT_INK);
        all.push(hollow.named("reference not ten\ntimes better"));
    }
    all.push(PictureSeries::note(format!(
        "reference's own error {}",
        significant(data.own, 1)
    )));
    if data.repeats > 1 {
        let text = format!("time: least of {} runs;\nwhisker: to the median", data.repeats);
        all.push(PictureSeries::note(text));
    }
    all
}

/// Marker of a scheme. BDF: round for orders 1 and 2, a diamond for order 5, a square for orders between. One-step methods: a triangle,
/// turned by the order. Hollow if not judged.
fn glyph(scheme: Scheme, filled: bool) -> Glyph {
    match (scheme.is_ida(), scheme.order) {
        (true, 0..=2) => Glyph::Polygon(RADIUS, 14, 0.0, filled),
        (true, 5) => Glyph::Polygon(1.25 * RADIUS, 4, 0.0, filled),
        (true, _) => Glyph::Polygon(1.2 * RADIUS, 4, 0.5 * FRAC_PI_2, filled),
        (false, order) => Glyph::Polygon(1.3 * RADIUS, 3, FRAC_PI_2 * f64::from(order % 4), filled),
    }
}
