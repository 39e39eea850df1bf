//! Kinds of modes.

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use super::shape::ModeShape;
use crate::spectral::EigenPair;

/// Behavior of a mode in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeBehavior {
    /// Oscillates without growth.
    Oscillation,
    /// Decays without oscillation.
    Decay,
    /// Oscillates and grows.
    Flutter,
    /// Grows without oscillation.
    Divergence,
    /// Rigid motion without a restoring force.
    Rigid,
    /// Constant volume of fluid in a closed network, with the pressure and deflection that it causes.
    Volume,
}

impl TimeBehavior {
    /// Name of the kind.
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

    /// True if the mode grows.
    pub fn grows(self) -> bool {
        matches!(self, Self::Flutter | Self::Divergence)
    }

    /// True if the mode oscillates.
    pub fn swings(self) -> bool {
        matches!(self, Self::Oscillation | Self::Flutter)
    }

    /// True if the mode is constant in time: s = 0.
    pub fn stays(self) -> bool {
        matches!(self, Self::Rigid | Self::Volume)
    }
}

/// Multiple of its error bound above which a part of s counts; the bound is valid to first order.
const BEYOND: f64 = 10.0;
/// Fraction of |s| below which a part of it does not count: damping ratios of this size cannot be measured.
const SHARE: f64 = 1e-9;
/// Fraction of the beam's own frequency below which |s| does not count.
const STILL: f64 = 1e-12;

/// Kind of a pair, and `s` without the parts that are round-off. `frequency` [1/s] is that of the beam.
pub fn judge(pair: &EigenPair, shape: &ModeShape, frequency: f64, length: f64) -> (TimeBehavior, Complex<f64>) {
    let still = BEYOND * pair.error + STILL * frequency;
    if pair.s.norm() <= still {
        let kind = if shape.without_pressure(length) {
            TimeBehavior::Rigid
        } else {
            TimeBehavior::Volume
        };
        return (kind, Complex::default());
    }
    let least = (BEYOND * pair.error).max(SHARE * pair.s.norm());
    let part = |x: f64| if x.abs() > least { x } else { 0.0 };
    let s = Complex::new(part(pair.s.re), part(pair.s.im));
    let kind = match (s.re > 0.0, s.im != 0.0) {
        (false, true) => TimeBehavior::Oscillation,
        (false, false) => TimeBehavior::Decay,
        (true, true) => TimeBehavior::Flutter,
        (true, false) => TimeBehavior::Divergence,
    };
    (kind, s)
}
