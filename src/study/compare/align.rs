//! A recording at the times and places of another.

use super::interpolate::{cubic, hermite, interval, monotone};
use super::recording::{Array, Recording};
use crate::discrete::quantities::{Axis, Field};

/// Field whose values are the slopes of another in time.
pub fn slopes_of(name: &str) -> Option<&'static str> {
    Some(Field::named(name)?.rate()?.name())
}

/// Coordinate of a field.
pub fn axis_of(name: &str) -> Axis {
    Field::named(name).map_or(Axis::Nodes, Field::axis)
}

/// Positions of a field. Those along the beam are relative to its length, so that beams of different length compare.
/// Those along the network come in pieces, one a connected array, between which nothing is interpolated.
#[derive(Clone, Debug, PartialEq)]
pub struct Places {
    /// Positions.
    pub x: Vec<f64>,
    /// Pieces, as ranges of positions.
    pub pieces: Vec<std::ops::Range<usize>>,
    /// Whether the field may jump and kink along them.
    pub rough: bool,
}

impl Places {
    /// Of a field in a recording.
    pub fn of(recording: &Recording, field: &Array) -> Option<Self> {
        let axis = axis_of(&field.name);
        let raw = recording.axis(axis.name()).filter(|x| x.len() == field.len)?;
        let rough = axis == Axis::Network;
        let length = if rough { 1.0 } else { recording.length() };
        let x: Vec<f64> = raw.iter().map(|x| x / length).collect();
        let number = recording.axis(Axis::Array.name()).filter(|_| rough);
        let mut pieces = vec![];
        let mut begin = 0;
        for k in 1..=x.len() {
            if k == x.len() || number.is_some_and(|n| n[k] != n[begin]) {
                pieces.push(begin..k);
                begin = k;
            }
        }
        Some(Self { x, pieces, rough })
    }

    /// Whether two fields have the same number of pieces: the same network.
    pub fn alike(&self, other: &Self) -> bool {
        self.pieces.len() == other.pieces.len()
    }

    /// Values given here brought to the places of another.
    pub fn bring(&self, values: &[f64], to: &Self) -> Vec<f64> {
        if self.x == to.x {
            return values.to_vec();
        }
        let mut out = Vec::with_capacity(to.x.len());
        for (own, theirs) in self.pieces.iter().zip(&to.pieces) {
            let (xs, ys) = (&self.x[own.clone()], &values[own.clone()]);
            out.extend(to.x[theirs.clone()].iter().map(|&x| {
                if self.rough {
                    monotone(xs, ys, x)
                } else {
                    cubic(xs, x).mean(|k| ys[k])
                }
            }));
        }
        out
    }
}

/// A field at a time: by values and slopes where both are recorded, else by four neighbours.
pub fn row_at(recording: &Recording, field: &Array, t: f64) -> Vec<f64> {
    let times = &recording.field_times;
    let weights = cubic(times, t);
    if weights.is_exact() {
        return field.row(weights.first).to_vec();
    }
    match slopes_of(&field.name).and_then(|name| recording.field(name)) {
        Some(slopes) => {
            let k = interval(times, t);
            between(field, slopes, times, k, k + 1, t)
        }
        None => (0..field.len).map(|i| weights.mean(|k| field.row(k)[i])).collect(),
    }
}

/// The cubic through values and slopes at the instants `a` and `b`.
fn between(field: &Array, slopes: &Array, times: &[f64], a: usize, b: usize, t: f64) -> Vec<f64> {
    let h = times[b] - times[a];
    let w = hermite((t - times[a]) / h, h);
    let (ya, yb, va, vb) = (field.row(a), field.row(b), slopes.row(a), slopes.row(b));
    (0..field.len)
        .map(|i| w[0] * ya[i] + w[1] * yb[i] + w[2] * va[i] + w[3] * vb[i])
        .collect()
}

/// Instants tried when the error of an interpolation is measured.
const TRIED: usize = 200;
/// What halving the interval leaves of a fourth-order error.
const HALVED: f64 = 16.0;

/// Error of interpolating a field in time: every second instant from its neighbours, over 16.
pub fn field_interpolation_error(recording: &Recording, field: &Array) -> f64 {
    let times = &recording.field_times;
    let slopes = slopes_of(&field.name).and_then(|name| recording.field(name));
    tried(times).fold(0.0, |worst, k| {
        let guess = match slopes {
            Some(slopes) => between(field, slopes, times, k - 1, k + 1, times[k]),
            None => {
                let w = skipping(times, k);
                (0..field.len)
                    .map(|i| w.iter().map(|&(j, w)| w * field.row(j)[i]).sum())
                    .collect()
            }
        };
        let off = guess.iter().zip(field.row(k)).map(|(g, x): (&f64, _)| (g - x).abs());
        off.fold(worst, f64::max)
    }) / HALVED
}

/// The same of a column of the history.
pub fn column_interpolation_error(times: &[f64], values: &[f64]) -> f64 {
    tried(times).fold(0.0, |worst: f64, k| {
        let guess: f64 = skipping(times, k).iter().map(|&(j, w)| w * values[j]).sum();
        worst.max((guess - values[k]).abs())
    }) / HALVED
}

fn tried(times: &[f64]) -> impl Iterator<Item = usize> {
    let end = times.len().saturating_sub(3);
    (3..end).step_by((end / TRIED).max(1))
}

/// The instant `k` from `k - 3`, `k - 1`, `k + 1`, `k + 3`.
fn skipping(times: &[f64], k: usize) -> [(usize, f64); 4] {
    let used = [k - 3, k - 1, k + 1, k + 3];
    let xs = used.map(|j| times[j]);
    let w = cubic(&xs, times[k]).weights;
    [0, 1, 2, 3].map(|i| (used[i], w[i]))
}
