//! A piece of an outline: a straight line or an arc of an axis-aligned ellipse.

use crate::input::Point;

/// A curve over t in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Curve {
    /// From one point to another.
    Line {
        /// Point at t = 0.
        from: Point,
        /// Point at t = 1.
        to: Point,
    },
    /// center + (radii_0 cos a, radii_1 sin a), a from `from` to `to`.
    Arc {
        /// Center.
        center: Point,
        /// Semi-axes along and high.
        radii: [f64; 2],
        /// Angle at t = 0 [rad].
        from: f64,
        /// Angle at t = 1 [rad].
        to: f64,
    },
}

impl Curve {
    /// Point at t.
    pub fn at(&self, t: f64) -> Point {
        match *self {
            // Exact at both ends: adjacent curves must share them bit for bit.
            Curve::Line { from, to } => [from[0] * (1.0 - t) + to[0] * t, from[1] * (1.0 - t) + to[1] * t],
            Curve::Arc {
                center,
                radii,
                from,
                to,
            } => {
                let a = from * (1.0 - t) + to * t;
                [center[0] + radii[0] * a.cos(), center[1] + radii[1] * a.sin()]
            }
        }
    }

    /// Derivative with respect to t.
    pub fn slope(&self, t: f64) -> Point {
        match *self {
            Curve::Line { from, to } => [to[0] - from[0], to[1] - from[1]],
            Curve::Arc { radii, from, to, .. } => {
                let a = from * (1.0 - t) + to * t;
                [-radii[0] * a.sin() * (to - from), radii[1] * a.cos() * (to - from)]
            }
        }
    }

    /// Mirror image about the mid-plane, with the same t.
    pub fn mirrored(&self) -> Self {
        match *self {
            Curve::Line { from, to } => Curve::Line {
                from: [from[0], -from[1]],
                to: [to[0], -to[1]],
            },
            Curve::Arc {
                center,
                radii,
                from,
                to,
            } => Curve::Arc {
                center: [center[0], -center[1]],
                radii,
                from: -from,
                to: -to,
            },
        }
    }

    /// Number of chords that approximate the curve well enough for inside-outside tests.
    pub fn chords(&self) -> usize {
        match *self {
            Curve::Line { .. } => 1,
            Curve::Arc { from, to, .. } => ((to - from).abs() / 0.1).ceil() as usize,
        }
    }
}
