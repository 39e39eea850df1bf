//! Interpolation of a recording to the times and positions of another.

use super::interpolate::{cubic, hermite, interval, monotone};
use super::recording::{Array, Recording};
use crate::discrete::quantities::{BeamField, FieldAxis};

/// Name of the field that contains the time derivatives of another.
pub fn slopes_of(name: &str) -> Option<&'static str> {
    Some(BeamField::named(name)?.rate()?.name())
}

/// Coordinate of a field.
pub fn axis_of(name: &str) -> FieldAxis {
    BeamField::named(name).map_or(FieldAxis::Nodes, BeamField::axis)
}

/// Positions of a field. Positions along the beam are relative to its length, so that beams of different length can be
/// compared. Positions along the network are divided into pieces, one per connected array, and those of a structure into
/// its beams; nothing is interpolated across pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldPositions {
    /// Positions.
    pub x: Vec<f64>,
    /// Pieces, as ranges of positions.
    pub pieces: Vec<std::ops::Range<usize>>,
    /// True if the field may have jumps and kinks along the positions.
    pub rough: bool,
}

impl FieldPositions {
    /// Returns the positions of a field in a recording; `None` if its coordinate is missing.
    pub fn find(recording: &Recording, field: &Array) -> Option<Self> {
        let axis = axis_of(&field.name);
        let raw = recording.axis(axis.name()).filter(|x| x.len() == field.len)?;
        let rough = axis == FieldAxis::Network;
        let length = if rough { 1.0 } else { recording.length() };
        let x: Vec<f64> = raw.iter().map(|x| x / length).collect();
        let number = recording.axis(FieldAxis::Array.name()).filter(|_| rough);
        let of_beam = match axis {
            FieldAxis::Cells => recording.axis(FieldAxis::BeamOfCell.name()),
            FieldAxis::Nodes => recording.axis(FieldAxis::BeamOfNode.name()),
            _ => None,
        };
        let number = number.or(of_beam.filter(|beam| beam.len() == x.len()));
        let mut pieces = vec![];
        let mut begin = 0;
        for k in 1..=x.len() {
            // parts of a beam between joints meet in two nodes at one place
            let parted = |n: &[f64]| n[k] != n[begin] || (!rough && x[k] <= x[k - 1]);
            if k == x.len() || number.is_some_and(parted) {
                pieces.push(begin..k);
                begin = k;
            }
        }
        Some(Self { x, pieces, rough })
    }

    /// True if two fields have the same number of pieces: the same network.
    pub fn alike(&self, other: &Self) -> bool {
        self.pieces.len() == other.pieces.len()
    }

    /// Interpolates values at these positions to the positions of another.
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

/// Returns a field at a time: from values and slopes if both are recorded, else from four neighbors.
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

/// Evaluates the cubic through values and slopes at the instants `a` and `b`.
fn between(field: &Array, slopes: &Array, times: &[f64], a: usize, b: usize, t: f64) -> Vec<f64> {
    let h = times[b] - times[a];
    let w = hermite((t - times[a]) / h, h);
    let (ya, yb, va, vb) = (field.row(a), field.row(b), slopes.row(a), slopes.row(b));
    (0..field.len)
        .map(|i| w[0] * ya[i] + w[1] * yb[i] + w[2] * va[i] + w[3] * vb[i])
        .collect()
}

/// Instants tested when the error of an interpolation is measured.
const TRIED: usize = 200;
/// Factor by which halving the interval reduces a fourth-order error.
const HALVED: f64 = 16.0;

/// Estimates the error of interpolating a field in time: interpolates instants at twice the spacing and divides the
/// largest error by 16.
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

/// Estimates the error of interpolating a column of the history in time, by the method of
/// [`field_interpolation_error`].
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

/// Weights that interpolate the instant `k` from `k - 3`, `k - 1`, `k + 1`, `k + 3`.
fn skipping(times: &[f64], k: usize) -> [(usize, f64); 4] {
    let used = [k - 3, k - 1, k + 1, k + 3];
    let xs = used.map(|j| times[j]);
    let w = cubic(&xs, times[k]).weights;
    [0, 1, 2, 3].map(|i| (used[i], w[i]))
}
