//! Interpolation within a time step: a cubic through values and rates at both ends, or through values at four positions.

use serde::{Deserialize, Serialize};

use crate::discrete::extrema::Moving;

/// Cubic over a step, as a function of the relative position from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cubic {
    /// Coefficients of the powers of the position, from the constant up.
    c: [f64; 4],
}

/// Nodes and weights of the four-point Gauss rule on 0 to 1; exact for the square of a cubic.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

impl Cubic {
    /// Hermite interpolant through values and rates at both ends of a step of length `h` [s].
    pub fn new([a, ra]: Moving, [b, rb]: Moving, h: f64) -> Self {
        let (rise, ra, rb) = (b - a, h * ra, h * rb);
        Self {
            c: [a, ra, 3.0 * rise - 2.0 * ra - rb, ra + rb - 2.0 * rise],
        }
    }

    /// Lagrange interpolant through values at 0, 1/3, 2/3 and 1. Its error is at most `h^4/1944` times the fourth derivative.
    pub fn through([a, b, c, d]: [f64; 4]) -> Self {
        // differences to the first value avoid cancellation if the value changes little
        let [b, c, d] = [b - a, c - a, d - a];
        Self {
            c: [
                a,
                9.0 * b - 4.5 * c + d,
                -22.5 * b + 18.0 * c - 4.5 * d,
                13.5 * (b - c) + 4.5 * d,
            ],
        }
    }

    /// Returns the cubic times `sign` (1 or -1).
    pub fn signed(self, sign: f64) -> Self {
        Self {
            c: self.c.map(|c| sign * c),
        }
    }

    /// Value at a position.
    pub fn at(&self, x: f64) -> f64 {
        let [a, b, c, d] = self.c;
        a + x * (b + x * (c + x * d))
    }

    /// Positions between 0 and 1 at which the cubic has an extremum.
    pub fn turns(&self) -> impl Iterator<Item = f64> + use<> {
        let [_, b, c, d] = self.c;
        let (p, q) = (2.0 * c, 3.0 * d);
        // q x² + p x + b = 0, without cancellation
        let root = (p * p - 4.0 * q * b).sqrt();
        let s = -0.5 * (p + root.copysign(p));
        [s / q, b / s].into_iter().filter(|x| *x > 0.0 && *x < 1.0)
    }

    /// Position at which the cubic crosses `limit` upwards. It must not exceed `limit` at 0, and must exceed it at `upto`.
    pub fn crosses(&self, limit: f64, upto: f64) -> f64 {
        self.between([0.0, upto], limit)
    }

    /// Bisects for the position at which the cubic crosses `limit`, between one at which it is not above and one at which it is.
    /// Returns the side above the limit.
    pub fn between(&self, [mut below, mut above]: [f64; 2], limit: f64) -> f64 {
        for _ in 0..40 {
            let middle = 0.5 * (below + above);
            if self.at(middle) > limit {
                above = middle;
            } else {
                below = middle;
            }
        }
        above
    }
}

/// `∫ f dx` from a position to 1; exact if f is a polynomial of degree seven or less.
pub fn integral(from: f64, f: impl Fn(f64) -> f64) -> f64 {
    let width = 1.0 - from;
    GAUSS.iter().map(|(x, w)| width * w * f(from + width * x)).sum()
}
