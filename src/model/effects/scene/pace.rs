//! How fast a signal asks for what it asks.

use crate::functions::Signal;
use crate::functions::bounds::Excitation;

/// How a signal excites vibrations over the run, relative to its size.
pub struct Pace {
    /// Lower bounds of the largest value and of the largest acceleration: they stand in denominators.
    size: f64,
    acceleration: f64,
    excitation: Excitation,
}

impl Pace {
    /// Of a signal until `end` [s], with the value that the beam is at rest with before; none where it is zero all along.
    pub fn of(signal: &Signal, end: f64, held: f64) -> Option<Self> {
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

    /// How far something of an angular frequency `ω` [1/s] or more departs, at most, from what this does to it at rest, relative to
    /// the most that this does.
    pub fn inertia_ratio(&self, omega: f64) -> f64 {
        self.excitation.above(omega) / self.size
    }

    /// Waves of the angular frequency `ω` [1/s] or more that a motion of this pace excites by its acceleration, at most, relative to
    /// what the acceleration does without them.
    pub fn waves(&self, omega: f64) -> f64 {
        match self.excitation.waves_above(omega) {
            0.0 => 0.0,
            waves => waves / self.acceleration,
        }
    }

    /// Whether a sine in it may be in resonance with an angular frequency of `ω` [1/s] or more.
    pub fn resonates(&self, omega: f64) -> bool {
        self.excitation.resonates(omega)
    }
}
