//! A curve through given points: linear, monotone cubic, or a natural cubic spline; constant beyond its ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::jet::Jet;

/// Interpolation between the points of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Cubics with continuous slopes that rise where the points rise and fall where they fall: never beyond the points' values.
    #[default]
    Monotone,
    /// Natural cubic spline: twice continuously differentiable; it swings beyond the values of points that jump.
    Cubic,
}

/// Points with the second derivatives of the curve at both ends of each piece.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PiecewiseCurve {
    pub(super) at: Vec<f64>,
    pub(super) values: Vec<f64>,
    pub(super) second: Vec<[f64; 2]>,
    /// Places at which the value jumps.
    pub(super) jumps: Vec<f64>,
}

/// Points beyond each end of a period included in its spline: their influence at least halves from point to point.
const BEYOND: usize = 64;

impl PiecewiseCurve {
    /// Curve through `(at, values)`; none unless `at` ascends strictly and both have the same length of at least 1.
    pub fn through(at: &[f64], values: &[f64], interpolation: Interpolation) -> Option<Self> {
        let ascending = at.windows(2).all(|w| w[0] < w[1]);
        ascending.then(|| Self::with_jumps(at, values, interpolation))?
    }

    /// [`Self::through`] with jumps: two points at one place end one curve and begin another.
    pub fn with_jumps(at: &[f64], values: &[f64], interpolation: Interpolation) -> Option<Self> {
        let ascending = at.windows(2).all(|w| w[0] <= w[1]) && at.windows(3).all(|w| w[0] < w[2]);
        let finite = at.iter().chain(values).all(|v| v.is_finite());
        if at.is_empty() || at.len() != values.len() || !ascending || !finite {
            return None;
        }
        Some(Self {
            at: at.to_vec(),
            values: values.to_vec(),
            second: second_between_jumps(at, values, interpolation),
            jumps: at.windows(2).filter(|w| w[0] == w[1]).map(|w| w[0]).collect(),
        })
    }

    /// One period of a repeated curve, as long as its points reach. If the first and last value are equal, the curve is
    /// smooth there; otherwise it jumps.
    pub fn repeated(at: &[f64], values: &[f64], interpolation: Interpolation) -> Option<Self> {
        let mut curve = Self::with_jumps(at, values, interpolation)?;
        let (Some(&[first, last]), pieces) = (curve.ends().as_ref(), at.len() - 1) else {
            return None;
        };
        if last <= first {
            return None;
        }
        if curve.joins() {
            let copies = BEYOND.div_ceil(pieces);
            let shift = |k: usize| (k as f64 - copies as f64) * (last - first);
            let copy = |k: usize| (0..pieces).map(move |i| (at[i] + shift(k), values[i]));
            let all = (0..=2 * copies)
                .flat_map(copy)
                .chain([(last + shift(2 * copies), values[0])]);
            let (at, values): (Vec<f64>, Vec<f64>) = all.unzip();
            let second = second_between_jumps(&at, &values, interpolation);
            curve.second = second[copies * pieces..(copies + 1) * pieces].to_vec();
        }
        Some(curve)
    }

    /// First and last place.
    pub fn ends(&self) -> Option<[f64; 2]> {
        Some([*self.at.first()?, *self.at.last()?])
    }

    /// True if the first and the last value are equal.
    pub fn joins(&self) -> bool {
        self.values.first() == self.values.last()
    }

    /// Places at which the value jumps.
    pub fn jumps(&self) -> &[f64] {
        &self.jumps
    }

    /// Value and derivatives at `x`, on the branch (before, along, after) that contains `within`.
    pub fn jet(&self, x: f64, within: f64, interpolation: Interpolation) -> Jet {
        let (Some(&first), Some(&last)) = (self.at.first(), self.at.last()) else {
            return Jet::default();
        };
        let jumps_at_once = self.jumps.first() == Some(&first);
        if within < first || self.at.len() == 1 || (within == first && !jumps_at_once) {
            return Jet::constant(self.values[0]);
        }
        if within >= last {
            return Jet::constant(self.values[self.at.len() - 1]);
        }
        self.inside(x, within, interpolation)
    }

    /// [`Self::jet`] between its ends.
    pub fn inside(&self, x: f64, within: f64, interpolation: Interpolation) -> Jet {
        // Knots of linear and monotone tables end a smooth interval. A spline is C2 across inner knots, but not across
        // a jump.
        if interpolation != Interpolation::Cubic {
            return self.piece(self.piece_of(within), x);
        }
        let next = self.jumps.partition_point(|jump| *jump <= within);
        let from = next.checked_sub(1).map_or(0, |k| self.piece_of(self.jumps[k]));
        let to = self
            .jumps
            .get(next)
            .map_or(self.at.len() - 1, |jump| self.at.partition_point(|knot| knot < jump));
        self.piece(self.piece_of(x).clamp(from, to.max(from + 1) - 1), x)
    }

    /// Value and derivatives at `x`; at the ends those of the curve, not of the constant continuation.
    pub fn at(&self, x: f64) -> Jet {
        match (self.at.first(), self.at.last()) {
            (Some(&first), Some(_)) if x < first || self.at.len() == 1 => Jet::constant(self.values[0]),
            (Some(_), Some(&last)) if x > last => Jet::constant(self.values[self.at.len() - 1]),
            (Some(_), Some(_)) => self.piece(self.piece_of(x), x),
            _ => Jet::default(),
        }
    }

    fn piece_of(&self, x: f64) -> usize {
        self.at.partition_point(|&knot| knot <= x).clamp(1, self.at.len() - 1) - 1
    }

    /// The cubic of piece `i`: with `a = (x1 - x)/h`, `b = (x - x0)/h`,
    /// `y = a y0 + b y1 + ((a^3 - a) y0'' + (b^3 - b) y1'') h^2/6`.
    pub(super) fn piece(&self, i: usize, x: f64) -> Jet {
        let (x0, x1) = (self.at[i], self.at[i + 1]);
        let (y0, y1) = (self.values[i], self.values[i + 1]);
        let [m0, m1] = self.second[i];
        let h = x1 - x0;
        let (a, b) = ((x1 - x) / h, (x - x0) / h);
        Jet {
            value: a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0,
            rate: (y1 - y0) / h + ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) * h / 6.0,
            acceleration: a * m0 + b * m1,
            jerk: (m1 - m0) / h,
        }
    }

    /// Places and values of the points.
    pub(super) fn points(&self) -> (Vec<f64>, Vec<f64>) {
        (self.at.clone(), self.values.clone())
    }

    /// Places of the points.
    pub(super) fn knots(&self) -> &[f64] {
        &self.at
    }

    /// Indices of pieces that overlap `[from, to]`.
    pub(super) fn pieces(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let last = self.at.len().saturating_sub(1);
        let first = self.at.partition_point(|&knot| knot <= from).saturating_sub(1);
        let stop = self.at.partition_point(|&knot| knot < to).min(last);
        first..stop.max(first)
    }

    /// Candidates for extrema of value or rate of the cubic of piece `i`; some are outside or NaN.
    pub(super) fn extremes(&self, i: usize) -> [f64; 3] {
        let (start, h) = (self.at[i], self.at[i + 1] - self.at[i]);
        let [m0, m1] = self.second[i];
        let rate = self.piece(i, start).rate;
        // solve rate + m0 x + (m1 - m0) x^2/(2 h) = 0 without cancellation
        let (a, b) = ((m1 - m0) / (2.0 * h), m0);
        let q = -0.5 * (b + (b * b - 4.0 * a * rate).sqrt().copysign(b));
        [start + q / a, start + rate / q, start - m0 * h / (m1 - m0)]
    }

    /// Overshoot of the curve beyond its points, relative to the range of their values; 0 if these are equal.
    pub fn overshoot(&self) -> f64 {
        let bounds = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
                [low.min(y), high.max(y)]
            })
        };
        let [low, high] = bounds(&mut self.values.iter().copied());
        let smooth = (0..self.second.len()).filter(|i| self.at[*i] < self.at[i + 1]);
        let [least, most] = bounds(&mut smooth.flat_map(|i| {
            let within = move |x: &f64| (self.at[i]..=self.at[i + 1]).contains(x);
            let turns = self.extremes(i).into_iter().filter(within);
            turns.map(move |x| self.piece(i, x).value)
        }));
        let beyond = (low - least).max(most - high).max(0.0);
        if high > low { beyond / (high - low) } else { 0.0 }
    }

    /// Largest magnitude of the points' values.
    pub fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |most, value| value.abs().max(most))
    }

    /// Smallest and largest rate between the points.
    pub fn rates(&self) -> [f64; 2] {
        let within = |i: usize| self.extremes(i)[2].clamp(self.at[i], self.at[i + 1]);
        let places = |i: usize| [self.at[i], within(i), self.at[i + 1]];
        let rates = (0..self.second.len()).flat_map(|i| places(i).map(|x| self.piece(i, x).rate));
        rates.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], rate| {
            [low.min(rate), high.max(rate)]
        })
    }

    /// Smallest nonzero distance between two points.
    pub fn smallest_spacing(&self) -> Option<f64> {
        let spacings = self.at.windows(2).map(|w| w[1] - w[0]);
        spacings.filter(|spacing| *spacing > 0.0).reduce(f64::min)
    }

    /// True if all values are equal.
    pub fn is_constant(&self) -> bool {
        self.values.windows(2).all(|w| w[0] == w[1])
    }
}

/// Second derivatives at both ends of each piece, for a curve without jumps.
fn second_derivatives(at: &[f64], values: &[f64], interpolation: Interpolation) -> Vec<[f64; 2]> {
    match interpolation {
        Interpolation::Linear => vec![[0.0; 2]; at.len() - 1],
        Interpolation::Monotone => monotone_second_derivatives(at, values),
        Interpolation::Cubic => {
            let second = natural_second_derivatives(at, values);
            second.windows(2).map(|m| [m[0], m[1]]).collect()
        }
    }
}

/// Second derivatives at both ends of each piece, for a curve with jumps; zero for the jumps, pieces of zero length.
fn second_between_jumps(at: &[f64], values: &[f64], interpolation: Interpolation) -> Vec<[f64; 2]> {
    let mut second = Vec::with_capacity(at.len());
    let mut begin = 0;
    for stretch in at.chunk_by(|a, b| a < b) {
        let end = begin + stretch.len();
        second.extend(second_derivatives(stretch, &values[begin..end], interpolation));
        if end < at.len() {
            second.push([0.0; 2]);
        }
        begin = end;
    }
    second
}

/// Second derivatives of the natural cubic spline: zero at both ends, tridiagonal in between (Thomas' algorithm).
fn natural_second_derivatives(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let mut second = vec![0.0; n];
    if n < 3 {
        return second;
    }
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let (h0, h1) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        let right = 6.0 * ((y[i + 1] - y[i]) / h1 - (y[i] - y[i - 1]) / h0);
        let pivot = 2.0 * (h0 + h1) - h0 * upper[i - 1];
        upper[i] = h1 / pivot;
        second[i] = (right - h0 * second[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        second[i] -= upper[i] * second[i + 1];
    }
    second
}

/// Second derivatives at both ends of each piece of monotone cubics (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5,
/// 300, 1984). The slope at a point is a weighted harmonic mean of its neighbors' slopes, 0 if these differ in sign.
fn monotone_second_derivatives(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    let pieces = x.windows(2).zip(y.windows(2));
    let pieces: Vec<[f64; 2]> = pieces
        .map(|(x, y)| [x[1] - x[0], (y[1] - y[0]) / (x[1] - x[0])])
        .collect();
    let mut slopes = vec![];
    for k in 0..x.len() {
        let before = k.checked_sub(1).and_then(|k| pieces.get(k));
        slopes.push(match (before, pieces.get(k)) {
            (Some([h0, s0]), Some([h1, s1])) if s0 * s1 > 0.0 => {
                let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
                (w0 + w1) / (w0 / s0 + w1 / s1)
            }
            (Some(_), Some(_)) => 0.0,
            (None, Some(first)) => end_slope(first, pieces.get(1)),
            (Some(last), None) => end_slope(last, k.checked_sub(2).and_then(|k| pieces.get(k))),
            (None, None) => 0.0,
        });
    }
    let second = |([h, s], d): (&[f64; 2], &[f64])| {
        [
            (6.0 * s - 4.0 * d[0] - 2.0 * d[1]) / h,
            (2.0 * d[0] + 4.0 * d[1] - 6.0 * s) / h,
        ]
    };
    pieces.iter().zip(slopes.windows(2)).map(second).collect()
}

/// Slope at an end: that of the parabola through the end piece and the next, limited to keep the curve monotone.
fn end_slope(own: &[f64; 2], next: Option<&[f64; 2]>) -> f64 {
    let ([h0, s0], Some([h1, s1])) = (*own, next) else {
        return own[1];
    };
    let slope = ((2.0 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if slope * s0 <= 0.0 {
        0.0
    } else if s0 * s1 < 0.0 && slope.abs() > 3.0 * s0.abs() {
        3.0 * s0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: scipy.interpolate.PchipInterpolator([0, 1, 3, 4, 6], [0, 1, 1.5, 4, 3]) and its derivative at 0.5, 2,
    /// 3.5, 5.
    #[test]
    fn monotone_cubics_are_those_of_pchip() {
        let (x, y) = ([0.0, 1.0, 3.0, 4.0, 6.0], [0.0, 1.0, 1.5, 4.0, 3.0]);
        let curve = PiecewiseCurve::through(&x, &y, Interpolation::Monotone).expect("a curve");
        for [x, value, rate] in [
            [0.5, 135.0 / 224.0, 121.0 / 112.0],
            [2.0, 69.0 / 56.0, 1.0 / 7.0],
            [3.5, 2.8125, 3.625],
            [5.0, 3.875, -0.375],
        ] {
            let jet = curve.at(x);
            assert!(
                (jet.value - value).abs() < 1e-14 && (jet.rate - rate).abs() < 1e-14,
                "{x}: {jet:?}"
            );
        }
        for (k, x) in x.iter().enumerate().take(4).skip(1) {
            let (left, right) = (curve.piece(k - 1, *x), curve.piece(k, *x));
            assert!((left.rate - right.rate).abs() < 1e-13 && left.value == right.value);
        }
    }

    /// Goal: monotone cubics stay within the values of their points; a natural spline through a jump overshoots.
    #[test]
    fn only_a_spline_swings_beyond_its_points() {
        let (x, y) = ([0.0, 1.0, 1.1, 2.0, 5.0], [0.0, 0.0, 1.0, 1.0, 0.9]);
        let overshoot = |interpolation| {
            PiecewiseCurve::through(&x, &y, interpolation)
                .expect("a curve")
                .overshoot()
        };
        assert_eq!(overshoot(Interpolation::Linear), 0.0);
        assert!(overshoot(Interpolation::Monotone) < 1e-15);
        assert!(overshoot(Interpolation::Cubic) > 0.1);
    }
}
