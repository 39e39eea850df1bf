//! What a mode does.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::shape::Shape;
use crate::spectral::Pair;

/// What becomes of a mode once it is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Swings, and does not grow.
    Oscillation,
    /// Dies away without swinging.
    Decay,
    /// Swings and grows.
    Flutter,
    /// Grows without swinging.
    Divergence,
    /// A motion that nothing holds.
    Rigid,
    /// Fluid that a closed network keeps, and the pressure and deflection that go with it.
    Volume,
}

impl Kind {
    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Oscillation => "oscillation",
            Self::Decay => "decay",
            Self::Flutter => "flutter",
            Self::Divergence => "divergence",
            Self::Rigid => "rigid motion",
            Self::Volume => "kept volume",
        }
    }

    /// Whether the mode grows.
    pub fn grows(self) -> bool {
        matches!(self, Self::Flutter | Self::Divergence)
    }

    /// Whether the mode swings.
    pub fn swings(self) -> bool {
        matches!(self, Self::Oscillation | Self::Flutter)
    }

    /// Whether the mode stays what it is: s = 0.
    pub fn stays(self) -> bool {
        matches!(self, Self::Rigid | Self::Volume)
    }
}

/// Times the bound of its error that a part of s must have to count: the bound is one to first order.
const BEYOND: f64 = 10.0;
/// Share of |s| below which a part of it does not count: no one measures a damping ratio of this size.
const SHARE: f64 = 1e-9;
/// Share of the beam's own frequency below which |s| does not count.
const STILL: f64 = 1e-12;

/// The kind of a pair, and `s` without the parts that are round-off. `frequency` [1/s] is the beam's.
pub fn judge(pair: &Pair, shape: &Shape, frequency: f64, length: f64) -> (Kind, Complex<f64>) {
    let still = BEYOND * pair.error + STILL * frequency;
    if pair.s.norm() <= still {
        let kind = if shape.without_pressure(length) {
            Kind::Rigid
        } else {
            Kind::Volume
        };
        return (kind, Complex::default());
    }
    let least = (BEYOND * pair.error).max(SHARE * pair.s.norm());
    let part = |x: f64| if x.abs() > least { x } else { 0.0 };
    let s = Complex::new(part(pair.s.re), part(pair.s.im));
    let kind = match (s.re > 0.0, s.im != 0.0) {
        (false, true) => Kind::Oscillation,
        (false, false) => Kind::Decay,
        (true, true) => Kind::Flutter,
        (true, false) => Kind::Divergence,
    };
    (kind, s)
}
