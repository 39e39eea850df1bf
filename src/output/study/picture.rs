//! `study.svg`: cost of accuracy. Error on the horizontal axis, time on the vertical axis, both logarithmic; one line per mesh and method,
//! one marker per tolerance.

use std::f64::consts::FRAC_PI_2;

use super::text::spoken;
use crate::case::schema::Method;
use crate::output::numbers::significant;
use crate::output::plot::canvas::{FAINT_INK, INK, LineStyle, TextAnchor, TextStyle};
use crate::output::plot::colour::{Colour, PALETTE};
use crate::output::plot::extent;
use crate::output::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries};
use crate::study::accuracy::{Scheme, Study, StudyPlan};

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

/// Runs with one mesh and scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshLine {
    /// Cells per segment; determines the color.
    pub cells: usize,
    /// Scheme of time integration; determines the marker.
    pub scheme: Scheme,
    /// Runs, from loose to tight tolerance.
    pub markers: Vec<RunMarker>,
}

/// Runs of a study by mesh and scheme, ordered by scheme, then by mesh.
pub fn mesh_lines(study: &Study) -> Vec<MeshLine> {
    let marker = |k: usize| {
        let trial = &study.points[k].trial;
        let error = study.error(k)?;
        Some(RunMarker {
            error: error.total.max,
            temporal: error.temporal.map(|e| e.max),
            least_s: trial.wall_min_s,
            median_s: trial.wall_median_s,
            rtol: trial.setting.rtol,
            judged: error.judged,
            front: study.points[k].on_front,
        })
    };
    let line = |scheme: Scheme, cells: usize| MeshLine {
        cells,
        scheme,
        markers: study.line(cells, scheme).into_iter().filter_map(marker).collect(),
    };
    let StudyPlan { schemes, cells, .. } = &study.plan;
    let all = schemes
        .iter()
        .flat_map(|scheme| cells.iter().map(|cells| line(*scheme, *cells)));
    all.collect()
}

/// Radius of a marker [pt].
const RADIUS: f64 = 4.2;

const FRONT: Colour = Colour(0xd9, 0xdd, 0xe1);
const SHADE: Colour = Colour(0xf4, 0xf2, 0xec);

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(study: &Study) -> Option<String> {
    let measure = study.measure()?;
    let (meshes, own) = (mesh_lines(study), measure.own().max);
    // errors in time have their own panel
    let split = study.references.len() > 1;
    let markers = || {
        let all = meshes.iter().flat_map(|line| &line.markers);
        all.filter(|m| m.error > 0.0 && m.least_s > 0.0)
    };
    let times = around(extent(markers().flat_map(|m| [m.least_s, m.median_s]))?);
    let errors = around(extent(markers().map(|m| m.error))?);
    let y = PictureAxis::new("wall time of a run", "s", 8)
        .between(times.0, times.1)
        .logarithmic(true);
    let x = |name: &str, (lo, hi): (f64, f64)| PictureAxis::new(name, "1", 8).between(lo, hi).logarithmic(true);
    let mut series = vec![];
    // errors for which the reference is not accurate enough
    let edge = 10.0 * own;
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
    let balances = balances(study);
    series.push(line);
    series.extend(balances.iter().cloned());
    series.extend(lines(&meshes, |m| Some(m.error)));
    // tolerances at the markers of the front
    let words = TextStyle::new(9.5, TextAnchor::Right).coloured(FAINT_INK);
    let label =
        |m: &&RunMarker| PictureSeries::label((m.error, m.least_s), (-8.0, 10.0), format!("{:e}", m.rtol), words);
    series.extend(front.iter().map(label));
    series.extend(notes(study, &meshes, (own, !balances.is_empty())));
    let across = match split {
        true => "relative error, of time and space together",
        false => "relative error",
    };
    let total = Panel {
        legend_beside: true,
        ..Panel::new((560.0, 400.0), x(across, errors), y.clone(), series)
    };
    let in_time = extent(markers().filter_map(|m| m.temporal).filter(|e| *e > 0.0)).filter(|_| split);
    let lower = in_time.map(|errors| {
        let x = x("relative error of the time integration alone", around(errors));
        Panel::new((560.0, 300.0), x, y, lines(&meshes, |m| m.temporal))
    });
    let title = format!("{} · what accuracy costs", study.case);
    let about = format!(
        "error of {} against wall time, lower left is better",
        spoken(&measure.name)
    );
    Picture::stacked(title, about, [total].into_iter().chain(lower)).svg()
}

/// Adds a margin to a range on a logarithmic axis.
fn around((lo, hi): (f64, f64)) -> (f64, f64) {
    let margin = 10_f64.powf((0.05 * (hi / lo).log10()).max(0.15));
    (lo / margin, hi * margin)
}

/// Markers of every mesh and scheme over an error, joined by lines, with whiskers to their median times.
fn lines(all: &[MeshLine], error: fn(&RunMarker) -> Option<f64>) -> Vec<PictureSeries> {
    let mut meshes: Vec<usize> = all.iter().map(|l| l.cells).collect();
    meshes.sort_unstable();
    meshes.dedup();
    let mut series = vec![];
    for line in all.iter().filter(|line| !line.markers.is_empty()) {
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
fn balances(study: &Study) -> Vec<PictureSeries> {
    let of = |scheme: &Scheme| {
        let mesh = |cells: &usize| study.balances.iter().find(|b| (b.cells, b.scheme) == (*cells, *scheme));
        let alike = study.plan.cells.iter().filter_map(mesh);
        alike.map(|b| (b.at.error, b.at.cost)).collect::<Vec<_>>()
    };
    let all = study.plan.schemes.iter().map(of).filter(|points| !points.is_empty());
    let drawn = all.flat_map(|points| {
        [
            PictureSeries::line(points.iter().copied(), LineStyle::dashed(FAINT_INK, 1.0, (2.0, 4.0))),
            PictureSeries::marks(points, Glyph::Cross(5.0), INK),
        ]
    });
    drawn.collect()
}

/// Legend entries without a line of their own.
fn notes(study: &Study, meshes: &[MeshLine], (own, balances): (f64, bool)) -> Vec<PictureSeries> {
    let front = PictureSeries::line([], LineStyle::solid(FRONT, 9.0));
    let mut all = vec![front.named("no run is cheaper and\nmore accurate; rtol\nbeside it")];
    let none = |glyph: Glyph, colour: Colour| PictureSeries::marks([], glyph, colour);
    if balances {
        all.push(none(Glyph::Cross(5.0), INK).named("error in time equals\nerror in space"));
    }
    if meshes.iter().flat_map(|l| &l.markers).any(|m| !m.judged) {
        let hollow = none(glyph(Scheme::ida(2), false), FAINT_INK);
        all.push(hollow.named("reference not ten\ntimes better"));
    }
    all.push(PictureSeries::note(format!(
        "reference's own error {}",
        significant(own, 1)
    )));
    let repeats = study.points.iter().map(|p| p.trial.repeats).max().unwrap_or(1);
    if repeats > 1 {
        let text = format!("time: least of {repeats} runs;\nwhisker: to the median");
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
