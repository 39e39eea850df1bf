//! `study.svg`: what accuracy costs. Error across, time up, both in logarithms; one line a mesh and method, one marker a
//! tolerance.

mod legend;

use super::canvas::{Anchor, Canvas, FAINT_INK, INK, Stroke, Words, picture};
use super::colour::{Colour, PALETTE};
use super::extent;
use super::labels::LabelRoom;
use super::panel::{Panel, Place, title};
use super::ticks::Scale;
use crate::case::schema::Method;
use crate::output::numbers::{quantity, superscript, trimmed};
use crate::study::accuracy::Scheme;

/// A run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
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
    /// Whether the reference is good enough to judge it.
    pub judged: bool,
    /// Whether no other is cheaper and more accurate.
    pub front: bool,
}

/// Where temporal equals spatial error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Balance {
    /// Relative error.
    pub error: f64,
    /// Wall time [s].
    pub seconds: f64,
}

/// One mesh and scheme.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Cells a segment; the colour.
    pub cells: usize,
    /// How time is integrated; the marker.
    pub scheme: Scheme,
    /// Runs, loose to tight.
    pub markers: Vec<Marker>,
    /// Balance of errors.
    pub balance: Option<Balance>,
}

/// All that is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPrecision {
    /// Name of the case.
    pub case: String,
    /// What the error is of.
    pub measure: String,
    /// The reference's own error.
    pub own: f64,
    /// Timed runs a point, at most.
    pub repeats: usize,
    /// Lines, by scheme, then by mesh.
    pub lines: Vec<Line>,
    /// Whether errors in time have a panel of their own.
    pub split: bool,
}

const LEFT: f64 = 84.0;
const TOP: f64 = 64.0;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 400.0;
/// Of the panel of errors in time alone.
const LOWER: f64 = 300.0;
const GAP: f64 = 66.0;
const SHEET: f64 = 862.0;
/// Radius of a marker.
const RADIUS: f64 = 4.2;
/// Keeps logarithms of times off zero, where a panel draws the line of zero.
const OFF: f64 = 20.0;

const FRONT: Colour = Colour(0xd9, 0xdd, 0xe1);
const SHADE: Colour = Colour(0xf4, 0xf2, 0xec);
const PAPER: Colour = Colour(0xff, 0xff, 0xff);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &WorkPrecision) -> Option<String> {
    let markers = || {
        data.lines
            .iter()
            .flat_map(|l| &l.markers)
            .filter(|m| m.error > 0.0 && m.least_s > 0.0)
    };
    let times = extent(markers().flat_map(|m| [m.least_s.log10(), m.median_s.log10()]))?;
    let y = decades(times, OFF, |n| trimmed(&quantity(10_f64.powi(n), "s", 3)));
    let x = |errors: Option<(f64, f64)>| Some(decades(errors?, 0.0, |n| format!("10{}", superscript(n))));
    let place = Place::new(LEFT, TOP, WIDTH, HEIGHT);
    let total = Panel::new(place, x(extent(markers().map(|m| m.error.log10())))?, y.clone());
    let sheet = Sheet {
        panel: total,
        data,
        meshes: meshes(data),
        error: |m| Some(m.error),
    };
    let place = Place {
        top: TOP + HEIGHT + GAP,
        height: LOWER,
        ..place
    };
    let in_time = extent(markers().filter_map(|m| Some(m.temporal?.log10())));
    let lower = x(in_time).filter(|_| data.split).map(|x| Sheet {
        panel: Panel { place, x, y },
        data,
        meshes: meshes(data),
        error: |m| m.temporal,
    });
    let bottom = lower.as_ref().map_or(TOP + HEIGHT, |l| l.panel.place.bottom());
    Some(picture(SHEET, bottom + 52.0, |canvas| {
        sheet.draw(canvas);
        if let Some(lower) = lower {
            lower.draw_lines(canvas, "relative error of the time integration alone");
        }
    }))
}

/// Meshes, coarse to fine: each has a colour.
fn meshes(data: &WorkPrecision) -> Vec<usize> {
    let mut all: Vec<usize> = data.lines.iter().map(|l| l.cells).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// A logarithmic axis with its ticks at decades.
fn decades((lo, hi): (f64, f64), off: f64, label: impl Fn(i32) -> String) -> Scale {
    let margin = (0.05 * (hi - lo)).max(0.15);
    let (lo, hi) = (lo - margin, hi + margin);
    let ticks: Vec<(f64, String)> = (lo.ceil() as i32..=hi.floor() as i32)
        .map(|n| (f64::from(n) + off, label(n)))
        .collect();
    Scale {
        lo: lo + off,
        hi: hi + off,
        ticks,
        unit: String::new(),
    }
}

struct Sheet<'a> {
    panel: Panel,
    data: &'a WorkPrecision,
    meshes: Vec<usize>,
    /// Which error is across.
    error: fn(&Marker) -> Option<f64>,
}

impl Sheet<'_> {
    fn at(&self, error: f64, seconds: f64) -> (f64, f64) {
        self.panel.at((error.log10(), seconds.log10() + OFF))
    }

    fn colour(&self, cells: usize) -> Colour {
        // Blue, orange, green, purple, then the others; the palette's own order.
        PALETTE[self.meshes.iter().position(|k| *k == cells).unwrap_or(0) % PALETTE.len()]
    }

    fn draw(&self, canvas: &mut Canvas) {
        let data = self.data;
        let what = format!("error of {} against wall time, lower left is better", data.measure);
        title(canvas, LEFT, &format!("{} · what accuracy costs", data.case), &what);
        self.shade(canvas);
        self.panel.grid(canvas);
        self.front(canvas);
        let balances = self.balances(canvas);
        for line in &data.lines {
            self.line(canvas, line);
        }
        self.labels(canvas);
        let across = if data.split {
            "relative error, of time and space together"
        } else {
            "relative error"
        };
        self.panel.axes(canvas, Some(across), "wall time of a run");
        legend::draw(self, canvas, balances);
    }

    /// Axes and lines alone.
    fn draw_lines(&self, canvas: &mut Canvas, across: &str) {
        self.panel.grid(canvas);
        for line in &self.data.lines {
            self.line(canvas, line);
        }
        self.panel.axes(canvas, Some(across), "wall time of a run");
    }

    /// Errors that the reference is not good enough to judge.
    fn shade(&self, canvas: &mut Canvas) {
        let p = self.panel.place;
        let edge = self.at(10.0 * self.data.own, 1.0).0;
        if edge.is_finite() && edge > p.left {
            canvas.rectangle((p.left, p.top), (edge.min(p.right()), p.bottom()), SHADE);
        }
    }

    fn front(&self, canvas: &mut Canvas) {
        let mut front: Vec<&Marker> = self
            .data
            .lines
            .iter()
            .flat_map(|l| &l.markers)
            .filter(|m| m.front)
            .collect();
        front.sort_by(|a, b| b.error.total_cmp(&a.error));
        let points: Vec<_> = front.iter().map(|m| self.at(m.error, m.least_s)).collect();
        canvas.line(&points, Stroke::solid(FRONT, 9.0));
    }

    /// Lines of balance, one a scheme; returns whether there is any.
    fn balances(&self, canvas: &mut Canvas) -> bool {
        let mut schemes: Vec<Scheme> = self.data.lines.iter().map(|l| l.scheme).collect();
        schemes.dedup();
        let mut any = false;
        for scheme in schemes {
            let alike = self.data.lines.iter().filter(|l| l.scheme == scheme);
            let points: Vec<_> = alike
                .filter_map(|l| l.balance)
                .map(|b| self.at(b.error, b.seconds))
                .collect();
            any |= !points.is_empty();
            canvas.line(&points, Stroke::dashed(FAINT_INK, 1.0, (2.0, 4.0)));
            for p in points {
                cross(canvas, p);
            }
        }
        any
    }

    fn stroke(&self, line: &Line) -> Stroke {
        let solid = Stroke::solid(self.colour(line.cells), 1.5);
        let dash = match line.scheme {
            Scheme {
                method: Method::Ida,
                order: 1 | 2,
            } => None,
            Scheme {
                method: Method::Ida, ..
            } => Some((5.0, 3.5)),
            _ => Some((9.0, 2.5)),
        };
        Stroke { dash, ..solid }
    }

    fn line(&self, canvas: &mut Canvas, line: &Line) {
        let error = |m: &Marker| (self.error)(m).filter(|e| *e > 0.0 && m.least_s > 0.0);
        let shown = || line.markers.iter().filter_map(|m| Some((m, error(m)?)));
        let points: Vec<_> = shown().map(|(m, e)| self.at(e, m.least_s)).collect();
        canvas.line(&points, self.stroke(line));
        for (marker, e) in shown() {
            let (x, y) = self.at(e, marker.least_s);
            let median = self.at(e, marker.median_s).1;
            let colour = self.colour(line.cells);
            if y - median > RADIUS {
                canvas.line(&[(x, y), (x, median)], Stroke::solid(colour, 1.0));
            }
            draw_marker(canvas, (x, y), line.scheme, colour, marker.judged);
        }
    }

    /// Tolerances, at the markers of the front.
    fn labels(&self, canvas: &mut Canvas) {
        let markers = self.data.lines.iter().flat_map(|l| &l.markers);
        let mut labels = LabelRoom::new((30.0, 11.0));
        for marker in markers.filter(|m| m.front) {
            let at = self.at(marker.error, marker.least_s);
            let at = (at.0 - 8.0, at.1 + 10.0);
            if at.0 - self.panel.place.left > 28.0 && labels.claim(at) {
                let words = Words::new(9.5, Anchor::Right).coloured(FAINT_INK);
                canvas.text(at, &format!("{:e}", marker.rtol), words);
            }
        }
    }
}

fn cross(canvas: &mut Canvas, (x, y): (f64, f64)) {
    let r = 5.0;
    let stroke = Stroke::solid(INK, 1.3);
    canvas.line(&[(x - r, y - r), (x + r, y + r)], stroke);
    canvas.line(&[(x - r, y + r), (x + r, y - r)], stroke);
}

/// BDF: round for orders 1 and 2, a diamond for 5, a square for what lies between. One-step methods: triangles, upwards,
/// downwards and sideways by their order. Hollow when not judged.
fn draw_marker(canvas: &mut Canvas, (x, y): (f64, f64), scheme: Scheme, colour: Colour, filled: bool) {
    let shape = |r: f64| -> Vec<(f64, f64)> {
        let quarter = std::f64::consts::FRAC_PI_2;
        let (corners, turn, r) = match (scheme.is_ida(), scheme.order) {
            (true, 0..=2) => (14, 0.0, r),
            (true, 5) => (4, 0.0, 1.25 * r),
            (true, _) => (4, 0.5 * quarter, 1.2 * r),
            (false, order) => (3, quarter * f64::from(order % 4), 1.3 * r),
        };
        (0..corners)
            .map(|k| f64::from(k) * std::f64::consts::TAU / f64::from(corners) + turn)
            .map(|angle| (x + r * angle.cos(), y + r * angle.sin()))
            .collect()
    };
    canvas.polygon(&shape(RADIUS), colour);
    if !filled {
        canvas.polygon(&shape(RADIUS - 1.4), PAPER);
    }
}
