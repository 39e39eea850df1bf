//! Pace of a signal: its excitation of vibrations relative to its size.

use crate::functions::Signal;
use crate::functions::bounds::Excitation;

/// Excitation of vibrations by a signal over the run, relative to its size.
pub struct SignalExcitation {
    /// Lower bounds of the largest value and the largest acceleration, for use in denominators.
    size: f64,
    acceleration: f64,
    excitation: Excitation,
}

impl SignalExcitation {
    /// Pace of a signal until `end` [s]; `held` is its value while the beam is at rest before the run. None for a
    /// signal that is always zero.
    pub fn from_signal(signal: &Signal, end: f64, held: f64) -> Option<Self> {
        let reached = signal.reaches(end);
        let size = reached.value.max(held.abs());
        if size == 0.0 {
            return None;
        }
        Some(Self {
            size,
            acceleration: reached.acceleration,
            excitation: signal.excitation(end, held),
        })
    }

    /// Upper bound of the deviation from the static response for vibrations of angular frequency `ω` [1/s] or more,
    /// relative to the largest static response.
    pub fn inertia_ratio(&self, omega: f64) -> f64 {
        self.excitation.above(omega) / self.size
    }

    /// Upper bound of the waves of angular frequency `ω` [1/s] or more excited by the acceleration of a motion,
    /// relative to the quasi-static effect of the acceleration.
    pub fn waves(&self, omega: f64) -> f64 {
        match self.excitation.waves_above(omega) {
            0.0 => 0.0,
            waves => waves / self.acceleration,
        }
    }

    /// True if a sine in the signal may be in resonance with an angular frequency of `ω` [1/s] or more.
    pub fn resonates(&self, omega: f64) -> bool {
        self.excitation.resonates(omega)
    }
}
