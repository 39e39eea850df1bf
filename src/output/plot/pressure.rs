//! `pressure.svg`: pressure along the networks over the last cycle, blue to red.

use super::canvas::{Anchor, Canvas, FAINT_INK, Stroke, Words, picture};
use super::colour::Colour;
use super::deflection::draw_over_time;
use super::panel::{Panel, Place, time_bar, title};
use super::ticks::Scale;
use super::{Span, extent};

/// Pressure of all cells at a few instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressure {
    /// Name of the case.
    pub case: String,
    /// What the instants span.
    pub span: Span,
    /// Times [s].
    pub times: Vec<f64>,
    /// Coordinate along the networks, one a cell.
    pub x_f: Vec<f64>,
    /// Bladder of each cell as `R j`: 3 in the upper row, −3 in the lower.
    pub bladder: Vec<i64>,
    /// Connected array of each cell; guessed from gaps in `x_f` when empty.
    pub network: Vec<i64>,
    /// Pressure [Pa], one array an instant.
    pub pressure: Vec<Vec<f64>>,
}

const LEFT: f64 = 72.0;
const TOP: f64 = 66.0;
const WIDTH: f64 = 720.0;
const HEIGHT: f64 = 300.0;
const SHEET: f64 = 900.0;
const BAND: Colour = Colour(0xf3, 0xf5, 0xf8);
const DIVIDE: Colour = Colour(0x8a, 0x91, 0x99);

/// Draws it; `None` when there is nothing to draw.
pub fn draw(data: &Pressure) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    let n = data.x_f.len();
    if n == 0 || data.pressure.iter().any(|p| p.len() != n) {
        return None;
    }
    let y = Scale::around(extent(data.pressure.iter().flatten().copied()), 1e-3, "Pa", 6);
    let bladders = runs(n, |k| data.bladder.get(k).copied().unwrap_or(0));
    let networks = networks(data, &bladders);
    let margin = 0.5 * least_step(&data.x_f).unwrap_or(1.0);
    let (lo, hi) = extent(data.x_f.iter().copied())?;
    let x = Scale::exact(lo - margin, hi + margin, "1", 10);
    let place = Place::new(LEFT, TOP, WIDTH, HEIGHT);
    let panel = Panel { place, x, y };
    Some(picture(SHEET, TOP + HEIGHT + 72.0, |canvas| {
        title(
            canvas,
            LEFT,
            &format!("{} · pressure", data.case),
            &super::about(data.span, from, to),
        );
        bands(canvas, &panel, data, &bladders, margin);
        let curves = data
            .pressure
            .iter()
            .map(|p| broken(&data.x_f, p, &networks).into_iter());
        draw_over_time(canvas, &panel, &data.times, curves);
        for pair in networks.windows(2) {
            let middle = 0.5 * (data.x_f[pair[0].1 - 1] + data.x_f[pair[1].0]);
            let at = panel.at((middle, panel.y.lo)).0;
            let dashed = Stroke::dashed(DIVIDE, 1.0, (5.0, 4.0));
            canvas.line(&[(at, TOP), (at, TOP + HEIGHT)], dashed);
        }
        let shifted = Panel {
            x: Scale {
                ticks: Vec::new(),
                ..panel.x.clone()
            },
            ..panel.clone()
        };
        shifted.axes(canvas, None, "pressure p");
        labels(canvas, &panel, data, &bladders);
        let bar = Place::new(LEFT + WIDTH + 26.0, TOP + 8.0, 15.0, HEIGHT - 8.0);
        time_bar(canvas, bar, from, to);
    }))
}

/// Half-open ranges of cells with equal keys.
fn runs<K: PartialEq>(n: usize, key: impl Fn(usize) -> K) -> Vec<(usize, usize)> {
    let mut runs: Vec<(usize, usize)> = Vec::new();
    for k in 0..n {
        match runs.last_mut() {
            Some(run) if key(run.0) == key(k) => run.1 = k + 1,
            _ => runs.push((k, k + 1)),
        }
    }
    runs
}

fn least_step(x: &[f64]) -> Option<f64> {
    let steps = x.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 0.0);
    steps.min_by(f64::total_cmp)
}

/// Ranges of cells that hang together. Without being told: where two bladders follow each other without the tube that
/// lies between others, or the coordinate runs back, a network ends.
fn networks(data: &Pressure, bladders: &[(usize, usize)]) -> Vec<(usize, usize)> {
    let n = data.x_f.len();
    if data.network.len() == n {
        return runs(n, |k| data.network[k]);
    }
    let gap = |k: usize| data.x_f[k] - data.x_f[k - 1];
    let inside = bladders.iter().flat_map(|b| b.0 + 1..b.1).map(gap).fold(0.0, f64::max);
    let between = bladders.iter().skip(1).map(|b| gap(b.0)).fold(0.0, f64::max);
    let least = if inside > 0.0 {
        0.5 * (inside + between)
    } else {
        0.85 * between
    };
    let mut ranges = vec![(0, n)];
    for b in bladders.iter().skip(1).filter(|b| gap(b.0) < least) {
        if let Some(last) = ranges.last_mut() {
            last.1 = b.0;
        }
        ranges.push((b.0, n));
    }
    ranges
}

/// Points of a curve with a break between networks.
fn broken(x: &[f64], y: &[f64], networks: &[(usize, usize)]) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(x.len() + networks.len());
    for &(start, end) in networks {
        points.extend(x[start..end].iter().copied().zip(y[start..end].iter().copied()));
        points.push((f64::NAN, f64::NAN));
    }
    points
}

/// Bladders as bands behind the curves; what lies between are tubes.
fn bands(canvas: &mut Canvas, panel: &Panel, data: &Pressure, bladders: &[(usize, usize)], margin: f64) {
    for &(start, end) in bladders {
        let left = panel.at((data.x_f[start] - margin, panel.y.hi));
        let right = panel.at((data.x_f[end - 1] + margin, panel.y.lo));
        canvas.rectangle(left, right, BAND);
    }
}

/// `[R j]` below each bladder, as many as fit, and the name of the axis.
fn labels(canvas: &mut Canvas, panel: &Panel, data: &Pressure, bladders: &[(usize, usize)]) {
    let (left, bottom) = (panel.place.left, panel.place.bottom());
    let mut free_from = left - 20.0;
    for &(start, end) in bladders {
        let Some(bladder) = data.bladder.get(start) else {
            break;
        };
        let text = format!("[{bladder}]").replace('-', "−");
        // Brackets are half as wide as digits.
        let half = 3.0 * (text.chars().count() - 1) as f64;
        let at = panel.at((0.5 * (data.x_f[start] + data.x_f[end - 1]), 0.0)).0;
        if at - half >= free_from {
            canvas.text((at, bottom + 12.0), &text, Words::new(10.5, Anchor::Centre));
            free_from = at + half + 3.0;
        }
    }
    for (x, label) in &panel.x.ticks {
        let at = panel.at((*x, 0.0)).0;
        canvas.text(
            (at, bottom + 29.0),
            label,
            Words::new(10.5, Anchor::Centre).coloured(FAINT_INK),
        );
    }
    let name = "coordinate along the networks, bladders [R j]";
    canvas.text(
        (left + 0.5 * panel.place.width, bottom + 49.0),
        name,
        Words::new(12.5, Anchor::Centre),
    );
}
