//! Errors of a motion that strikes walls.
//!
//! Steps that pass a strike leave an error of its energy, which the balance shows. The body then swings a little too far or too short, and
//! reaches the next strike too late or too early. From one turning point to the next, with ΔK what the balance opens and K the largest
//! kinetic energy between the two,
//!
//! ```text
//! ε ← ε + ΔK/(2 K)      Φ ← Φ + π ε      |error| ≤ a min(|ε| + max |Φ|, 2)
//! ```
//!
//! ε is the relative error of the velocity, Φ that of the phase if the time between strikes is proportional to the velocity, as in free
//! flight, and a the last amplitude.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::discrete::ledger::EnergyBalance;
use crate::discrete::{State, System};

/// Swings below this part of the widest one are vibrations between strikes.
const SMALL: f64 = 0.1;
/// Largest error of a motion, in amplitudes.
const MOST: f64 = 2.0;

/// A swing across of the center of mass of everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Swing {
    /// Place where it begins [m].
    from: f64,
    /// Energy that the balance left open there [J].
    open: f64,
    /// Largest kinetic energy since [J].
    kinetic: f64,
}

/// Follows the swings of a beam that may strike walls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Strikes {
    swing: Option<Swing>,
    /// Velocity at the last step [m/s].
    rate: f64,
    /// Relative error of the velocity.
    velocity: f64,
    /// Error of the phase, and the largest [rad].
    phase: [f64; 2],
    /// Amplitude of the last swing and of the widest [m].
    amplitude: [f64; 2],
    /// Largest displacement of the center of mass [m].
    reach: f64,
}

impl Strikes {
    /// Of a beam with walls.
    pub fn of(system: &System) -> Option<Self> {
        let moves = system.layout.lines[0].v.is_some();
        (moves && !system.model.contacts.is_empty()).then(Self::default)
    }

    /// Takes the state at the end of a step, with the balance of energy.
    pub fn see(&mut self, system: &System, w: State, balance: &EnergyBalance) {
        let mass: f64 = system.masses.iter().sum();
        let mean = |of: &dyn Fn(usize) -> f64| {
            let parts = system.masses.iter().enumerate().map(|(i, m)| m * of(i));
            parts.sum::<f64>() / mass
        };
        let (place, rate) = (mean(&|i| w.motion.u[i].x), mean(&|i| w.motion.v[i].x));
        let kinetic = balance.stored.kinetic;
        self.reach = self.reach.max(place.abs());
        let begin = Swing {
            from: place,
            open: balance.residual,
            kinetic,
        };
        let swing = self.swing.get_or_insert(begin);
        swing.kinetic = swing.kinetic.max(kinetic);
        let wide = 0.5 * (place - swing.from).abs();
        let turns = self.rate * rate < 0.0 && wide > SMALL * self.amplitude[1];
        self.rate = if rate == 0.0 { self.rate } else { rate };
        if turns && swing.kinetic > 0.0 {
            self.velocity += 0.5 * (balance.residual - swing.open) / swing.kinetic;
            self.phase[0] += PI * self.velocity;
            self.phase[1] = self.phase[1].max(self.phase[0].abs());
            self.amplitude = [wide, self.amplitude[1].max(wide)];
            self.swing = Some(begin);
        }
    }

    /// Error of a displacement, relative to its largest value.
    pub fn off(&self) -> f64 {
        let amplitude = self.amplitude[0] / self.reach.max(f64::MIN_POSITIVE);
        (amplitude * (self.velocity.abs() + self.phase[1]).min(MOST)).min(1.0)
    }
}
