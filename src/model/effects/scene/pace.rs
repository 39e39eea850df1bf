//! How fast a signal asks for what it asks.

use std::f64::consts::PI;

use crate::case::{Clock, Signal};
use crate::model::scales::largest;

/// Sizes of a signal over the run, sampled once.
pub struct Pace {
    size: f64,
    acceleration: f64,
    /// Largest jumps of value, rate and acceleration, from rest at the start and between smooth branches.
    jumps: [f64; 3],
    /// Shortest time scale [s].
    period: f64,
}

impl Pace {
    /// Of a signal until `end` [s], with the value that the beam is at rest with before; none where it is zero all along.
    pub fn of(signal: &Signal, end: f64, held: f64) -> Option<Self> {
        let (size, _, acceleration) = largest(signal, end);
        let size = size.max(held.abs());
        if size == 0.0 {
            return None;
        }
        let mut jumps = [0.0_f64; 3];
        let mut before = [held, 0.0, 0.0];
        for (from, to) in signal.smooth_intervals(end) {
            let within = 0.5 * (from + to);
            let [a, b] = [from, to].map(|t| {
                let jet = signal.jet(Clock { t, within });
                [jet.value, jet.rate, jet.acceleration]
            });
            for k in 0..3 {
                jumps[k] = jumps[k].max((a[k] - before[k]).abs());
            }
            before = b;
        }
        Some(Self {
            size,
            acceleration,
            jumps,
            period: signal.fastest_period_s().unwrap_or(f64::INFINITY),
        })
    }

    /// How much of its motion something of the angular frequency `ω` [1/s] owes to inertia when this acts on it: `s''/(ω² s)` of a
    /// smooth signal, `Δs'/(ω s)` and `Δs/s` where it jumps, as it does at the start.
    pub fn haste(&self, omega: f64) -> f64 {
        let smooth = self.acceleration / (omega * omega * self.size);
        smooth
            .max(self.jumps[0] / self.size)
            .max(self.jumps[1] / (omega * self.size))
    }

    /// Waves of the angular frequency `ω` [1/s] that a motion of this pace excites by its acceleration, relative to what the
    /// acceleration does without them.
    pub fn waves(&self, omega: f64) -> f64 {
        if self.acceleration == 0.0 {
            return 0.0;
        }
        let sudden = (self.jumps[1] * omega).max(self.jumps[2]) / self.acceleration;
        sudden.max((2.0 * PI / (self.period * omega)).powi(2))
    }
}
