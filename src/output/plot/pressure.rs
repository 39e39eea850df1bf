//! `pressure.svg`: pressure along the networks over the last cycle, blue to red.

use super::canvas::LineStyle;
use super::colour::Colour;
use super::picture::{Panel, Picture, PictureAxis, PictureSeries};
use super::{TimeSpan, extent, over_time, time_bar};

/// Pressure of all cells at a few instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressure {
    /// Name of the case.
    pub case: String,
    /// Part of the run that the instants span.
    pub span: TimeSpan,
    /// Times [s].
    pub times: Vec<f64>,
    /// Coordinate along the networks, one per cell.
    pub x_f: Vec<f64>,
    /// Bladder of each cell as `R j`: 3 in the upper row, −3 in the lower; in a structure with its beam, left:3.
    pub bladder: Vec<String>,
    /// Network of each cell.
    pub network: Vec<i64>,
    /// Pressure [Pa], one array per instant.
    pub pressure: Vec<Vec<f64>>,
}

const BAND: Colour = Colour(0xf3, 0xf5, 0xf8);
const DIVIDE: Colour = Colour(0x8a, 0x91, 0x99);

/// Draws the picture; `None` if there is nothing to draw.
pub fn draw(data: &Pressure) -> Option<String> {
    let (&from, &to) = (data.times.first()?, data.times.last()?);
    let n = data.x_f.len();
    if n == 0 || data.pressure.iter().any(|p| p.len() != n) {
        return None;
    }
    let bladders = runs(n, |k| data.bladder.get(k));
    // ranges of connected cells
    let networks = runs(n, |k| data.network.get(k).copied().unwrap_or(0));
    let margin = 0.5 * least_step(&data.x_f).unwrap_or(1.0);
    let (lo, hi) = extent(data.x_f.iter().copied())?;
    let named = data.bladder.iter().any(|label| label.contains(':'));
    let kind = if named { "BEAM:R j" } else { "R j" };
    let name = format!("coordinate along the networks, bladders [{kind}]");
    let mut x = PictureAxis::new(name, "1", 10).between(lo - margin, hi + margin);
    let mut y = PictureAxis::new("pressure p", "Pa", 6).above(1e-3);
    let (low, high) = y.limits(data.pressure.iter().flatten().copied());
    y = y.between(low, high);
    // bladders as bands behind the curves, with tubes between them
    let mut series = vec![];
    for &(start, end) in &bladders {
        let (left, right) = (data.x_f[start] - margin, data.x_f[end - 1] + margin);
        series.push(PictureSeries::band(&[(left, low, high), (right, low, high)], BAND));
        let middle = 0.5 * (data.x_f[start] + data.x_f[end - 1]);
        let label = data
            .bladder
            .get(start)
            .map(|bladder| format!("[{bladder}]").replace('-', "−"));
        x.groups.extend(label.map(|label| (middle, label)));
    }
    let curves = data.pressure.iter().map(|p| broken(&data.x_f, p, &networks));
    series.extend(over_time(&data.times, curves));
    for pair in networks.windows(2) {
        let middle = 0.5 * (data.x_f[pair[0].1 - 1] + data.x_f[pair[1].0]);
        let dashed = LineStyle::dashed(DIVIDE, 1.0, (5.0, 4.0));
        series.push(PictureSeries::line([(middle, low), (middle, high)], dashed));
    }
    let panel = Panel {
        bar: Some(time_bar(from, to)),
        ..Panel::new((720.0, 300.0), x, y, series)
    };
    let about = super::about(data.span, from, to);
    Picture::stacked(format!("{} · pressure", data.case), about, [panel]).svg()
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

/// Points of a curve, with a break between networks.
fn broken(x: &[f64], y: &[f64], networks: &[(usize, usize)]) -> Vec<(f64, f64)> {
    let mut points = Vec::with_capacity(x.len() + networks.len());
    for &(start, end) in networks {
        points.extend(x[start..end].iter().copied().zip(y[start..end].iter().copied()));
        points.push((f64::NAN, f64::NAN));
    }
    points
}
