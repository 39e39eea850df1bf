//! A curve through given points: straight lines or a natural cubic spline, constant beyond its ends.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::jet::Jet;

/// What happens between the points of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Natural cubic spline: twice continuously differentiable; it swings beyond the values of points that jump.
    #[default]
    Cubic,
}

/// Points with the second derivatives of the curve through them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    at: Vec<f64>,
    values: Vec<f64>,
    second: Vec<f64>,
}

impl Curve {
    /// Curve through `(at, values)`; none unless `at` ascends strictly and both have the same length of at least 1.
    pub fn through(at: &[f64], values: &[f64], interpolation: Interpolation) -> Option<Self> {
        let ascending = at.windows(2).all(|w| w[0] < w[1]);
        let finite = at.iter().chain(values).all(|v| v.is_finite());
        if at.is_empty() || at.len() != values.len() || !ascending || !finite {
            return None;
        }
        let second = match interpolation {
            Interpolation::Linear => vec![0.0; at.len()],
            Interpolation::Cubic => natural_second_derivatives(at, values),
        };
        Some(Self {
            at: at.to_vec(),
            values: values.to_vec(),
            second,
        })
    }

    /// Value and derivatives at `x`, on the branch (before, along, after) that holds at `within`.
    pub fn jet(&self, x: f64, within: f64, interpolation: Interpolation) -> Jet {
        let (Some(&first), Some(&last)) = (self.at.first(), self.at.last()) else {
            return Jet::default();
        };
        if within <= first || self.at.len() == 1 {
            return Jet::constant(self.values[0]);
        }
        if within >= last {
            return Jet::constant(self.values[self.at.len() - 1]);
        }
        // Every knot of a linear table ends a smooth interval; a spline is C2 across its inner knots.
        let place = if interpolation == Interpolation::Linear {
            within
        } else {
            x
        };
        self.piece(self.piece_of(place), x)
    }

    /// Value and derivatives at `x`; at the ends those of the curve, not of the constant beyond.
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
        let (m0, m1) = (self.second[i], self.second[i + 1]);
        let h = x1 - x0;
        let (a, b) = ((x1 - x) / h, (x - x0) / h);
        Jet {
            value: a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0,
            rate: (y1 - y0) / h + ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) * h / 6.0,
            acceleration: a * m0 + b * m1,
            jerk: (m1 - m0) / h,
        }
    }

    /// Where the points are.
    pub(super) fn knots(&self) -> &[f64] {
        &self.at
    }

    /// The pieces that `[from, to]` has more than an end of.
    pub(super) fn pieces(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let last = self.at.len().saturating_sub(1);
        let first = self.at.partition_point(|&knot| knot <= from).saturating_sub(1);
        let stop = self.at.partition_point(|&knot| knot < to).min(last);
        first..stop.max(first)
    }

    /// Where value or rate of the cubic of piece `i` may be extreme; some places lie outside, some are no numbers.
    pub(super) fn extremes(&self, i: usize) -> [f64; 3] {
        let (start, h) = (self.at[i], self.at[i + 1] - self.at[i]);
        let (m0, m1) = (self.second[i], self.second[i + 1]);
        let rate = self.piece(i, start).rate;
        // rate + m0 x + (m1 - m0) x^2/(2 h) = 0, without cancellation
        let (a, b) = ((m1 - m0) / (2.0 * h), m0);
        let q = -0.5 * (b + (b * b - 4.0 * a * rate).sqrt().copysign(b));
        [start + q / a, start + rate / q, start - m0 * h / (m1 - m0)]
    }

    /// Smallest distance between two points.
    pub fn smallest_spacing(&self) -> Option<f64> {
        self.at.windows(2).map(|w| w[1] - w[0]).reduce(f64::min)
    }

    /// All values equal.
    pub fn is_constant(&self) -> bool {
        self.values.windows(2).all(|w| w[0] == w[1])
    }
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
