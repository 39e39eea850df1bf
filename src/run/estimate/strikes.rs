//! Errors of a motion that strikes walls.
//!
//! Steps that pass a strike leave an error of its energy, which the balance shows. The body then swings a little too far or too short, and
//! reaches the next strike too late or too early. From one turning point to the next, with ΔK what the balance opens and K the largest
//! kinetic energy between the two,
//!
//! ```text
//! g = (1 + (K'/K)^(1/2))^n      ε ← g ε + ΔK/(2 K)      Φ ← g Φ + π ε      |error| ≤ a min(|ε| + max |Φ|, 2)
//! ```
//!
//! ε is the relative error of the velocity, Φ that of the phase if the time between strikes is proportional to the velocity, as in free
//! flight, and a the last amplitude.
//!
//! A body that vibrates arrives at a wall in a phase of its vibrations, and the next strike depends on that. Each of the n strikes of a swing so
//! multiplies errors of any origin. K' is the kinetic energy at the turning point without that of the center of mass, which is that of the vibrations. The
//! law of g is empirical. Beside differences of pairs of runs over 5 to 30 strikes, which grow by up to 1e6, it is right within a factor of 3, but
//! up to 50 times too large at walls that damp.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::discrete::ledger::EnergyBalance;
use crate::discrete::{State, System};

/// Swings below this part of the widest one are vibrations between strikes.
const SMALL: f64 = 0.1;
/// Largest error of a motion, in amplitudes.
const MOST: f64 = 2.0;
/// Part of the largest energy of walls above which the beam touches one.
const TOUCHES: f64 = 1e-5;
/// Factor from which on strikes are told to multiply errors.
const TOLD: f64 = 2.0;
/// Largest factor by which strikes are taken to multiply errors: beyond it nothing of the motion is left to tell.
const LARGEST_GAIN: f64 = 1e12;

/// How strikes multiply errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Struck {
    /// Strikes.
    pub strikes: u32,
    /// Factor by which they multiply an error of the motion.
    pub gain: f64,
}

/// A swing across of the center of mass of everything.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Swing {
    /// Place where it begins [m].
    from: f64,
    /// Energy that the balance left open there [J].
    open: f64,
    /// Largest kinetic energy since [J].
    kinetic: f64,
    /// Strikes since.
    #[serde(default)]
    strikes: u32,
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
    /// Largest energy of walls [J], and whether the beam touches one.
    #[serde(default)]
    pressed: f64,
    #[serde(default)]
    touches: bool,
    /// Strikes, and the logarithm of the factor by which they multiply errors.
    #[serde(default)]
    strikes: u32,
    #[serde(default)]
    growth: f64,
    /// Largest share of vibrations in the velocity.
    #[serde(default)]
    irregular: f64,
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
        let vibrating = (kinetic - 0.5 * mass * mean(&|i| w.motion.v[i].z).powi(2)).max(0.0);
        self.reach = self.reach.max(place.abs());
        let begin = Swing {
            from: place,
            open: balance.residual,
            kinetic,
            strikes: 0,
        };
        self.pressed = self.pressed.max(balance.stored.contacts);
        let touches = balance.stored.contacts > TOUCHES * self.pressed;
        let struck = u32::from(touches && !self.touches);
        (self.touches, self.strikes) = (touches, self.strikes + struck);
        let swing = self.swing.get_or_insert(begin);
        swing.kinetic = swing.kinetic.max(kinetic);
        swing.strikes += struck;
        let wide = 0.5 * (place - swing.from).abs();
        let turns = self.rate * rate < 0.0 && wide > SMALL * self.amplitude[1];
        self.rate = if rate == 0.0 { self.rate } else { rate };
        if turns && swing.kinetic > 0.0 {
            let irregular = if swing.strikes > 0 {
                (vibrating / swing.kinetic).sqrt()
            } else {
                0.0
            };
            let growth = f64::from(swing.strikes) * irregular.ln_1p();
            let gain = growth.exp().min(LARGEST_GAIN);
            (self.growth, self.irregular) = (self.growth + growth, self.irregular.max(irregular));
            let opened = 0.5 * (balance.residual - swing.open) / swing.kinetic;
            self.velocity = (gain * self.velocity + opened).clamp(-MOST, MOST);
            self.phase[0] = (gain * self.phase[0] + PI * self.velocity).clamp(-MOST, MOST);
            self.phase[1] = self.phase[1].max(self.phase[0].abs());
            self.amplitude = [wide, self.amplitude[1].max(wide)];
            self.swing = Some(begin);
        }
    }

    /// Error of a displacement, relative to its largest value.
    pub fn off(&self) -> f64 {
        (self.swings() * (self.velocity.abs() + self.phase[1]).min(MOST)).min(1.0)
    }

    /// What becomes of an error of a displacement, relative to its largest value: it grows no further than vibrations change the motion.
    pub fn multiplied(&self, error: f64) -> f64 {
        let most = (self.swings() * self.irregular).min(1.0);
        (self.gain() * error).min(most).max(error)
    }

    /// How strikes multiply errors; none where they do not.
    pub fn struck(&self) -> Option<Struck> {
        (self.gain() >= TOLD).then(|| Struck {
            strikes: self.strikes,
            gain: self.gain(),
        })
    }

    fn gain(&self) -> f64 {
        self.growth.exp().min(LARGEST_GAIN)
    }

    /// The last amplitude over the largest displacement.
    fn swings(&self) -> f64 {
        self.amplitude[0] / self.reach.max(f64::MIN_POSITIVE)
    }
}
