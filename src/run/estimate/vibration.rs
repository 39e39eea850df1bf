//! One mode followed along a run: how much of its free vibration there is, and what mesh and steps do to its phase.

use serde::{Deserialize, Serialize};

use crate::onestep::{Method, Tableau};
use crate::sundials::Step;

/// Periods over which a vibration is looked at.
const PERIODS: f64 = 2.0;
/// How far below the drained and above the sealed beam's frequency a vibration may be: rotations and tension change it.
const BELOW: f64 = 0.75;
const ABOVE: f64 = 1.35;

/// Up to this from one block to the next a vibration is steady.
const STEADY: f64 = 1.05;
/// More than this from one block to the next is no growth of a vibration, but a new one.
const STRUCK: f64 = 2.0;

/// Where a vibration is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Displacement of the tip.
    Tip,
    /// Slope of the tip [1/m].
    Slope,
    /// Largest displacement anywhere.
    Anywhere,
    /// Displacement in the middle.
    Middle,
    /// Pressure in sealed bladders where it is largest [Pa/m].
    Pressure,
}

impl Place {
    /// How many there are.
    pub const COUNT: usize = 5;
}

/// Angular frequencies [1/s] between which a vibration is looked for, of the drained and of the sealed beam.
pub fn band([low, high]: [f64; 2]) -> [f64; 2] {
    [BELOW * low, ABOVE * high]
}

/// A mode of the straight beam, and what became of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Vibration {
    /// First unknown of displacement, of velocity.
    first: [usize; 2],
    /// What each unknown adds to the coordinate; a velocity's unknowns count this times `rate`.
    weights: Vec<f64>,
    rate: f64,
    /// Angular frequencies between which its vibration is looked for [1/s].
    band: [f64; 2],
    /// Relative error of the frequency that the mesh makes.
    mesh: f64,
    /// Rate at which drag and material take it away [1/s].
    damping: f64,
    /// What a unit of the coordinate is at every [`Place`].
    pub places: [f64; Place::COUNT],
    /// Whether something drives it within its band: it is no free vibration, and a shift of its frequency changes how far it swings.
    pub driven: bool,
    /// Present guess of its frequency [1/s].
    frequency: f64,
    block: Block,
    /// How fast it swung at the end of the step before [m/s].
    #[serde(default)]
    swing: f64,
    amplitude: Option<f64>,
    largest: f64,
    lost: f64,
    off_time: [f64; 2],
    off_space: f64,
    /// Phase that steps and mesh have shifted so far [rad], and what it turned [rad].
    pub turned: [f64; 3],
}

/// Moments of the coordinate over a few periods, and what the steps did in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Block {
    time: f64,
    mean: f64,
    squares: [f64; 3],
    /// What steps take and turn, times how fast it swings at them [m/s], and the most of that.
    lost: f64,
    turned: f64,
    #[serde(default)]
    swing: f64,
}

/// What is known of a mode when it is made.
pub struct Known {
    /// First unknown of displacement, of velocity.
    pub first: [usize; 2],
    /// What each unknown of displacement adds to the coordinate [m].
    pub weights: Vec<f64>,
    /// Size of an unknown of velocity over that of one of displacement [1/s].
    pub rate: f64,
    /// Angular frequency of the drained and of the sealed beam [1/s].
    pub frequencies: [f64; 2],
    /// Relative error of the frequency that the mesh makes.
    pub mesh: f64,
    /// Rate at which drag and material take it away [1/s].
    pub damping: f64,
    /// What a unit of the coordinate is at every [`Place`].
    pub places: [f64; Place::COUNT],
    /// Whether something drives it within its band: it is no free vibration, and a shift of its frequency changes how far it swings.
    pub driven: bool,
}

/// Factor by which a step multiplies a vibration beside the exact one, as logarithm of its modulus, and angle [rad], θ the angle
/// that the vibration turns in the step.
///
/// ```text
/// R(iθ) e^(-iθ)  of a one-step method        1 + (iθ)^(k+1)/(k+1)  of BDF of order k, to first order
/// ```
pub fn factor(tableau: Option<&Tableau>, order: u8, theta: f64) -> [f64; 2] {
    if let Some(tableau) = tableau {
        let (re, im) = tableau.stability((0.0, theta));
        let (c, s) = (theta.cos(), theta.sin());
        let (re, im) = (re * c + im * s, im * c - re * s);
        return [re.hypot(im).max(f64::MIN_POSITIVE).ln(), im.atan2(re)];
    }
    if theta >= 1.0 {
        return [-theta, 0.0];
    }
    let size = theta.powi(i32::from(order) + 1) / (f64::from(order) + 1.0);
    // i^(k+1)
    match (order + 1) % 4 {
        0 => [size, 0.0],
        1 => [0.0, size],
        2 => [-size, 0.0],
        _ => [0.0, -size],
    }
}

impl Vibration {
    /// A mode at rest.
    pub fn new(known: Known) -> Self {
        let [low, high] = known.frequencies;
        Self {
            first: known.first,
            weights: known.weights,
            rate: known.rate,
            band: band(known.frequencies),
            mesh: known.mesh,
            damping: known.damping,
            places: known.places,
            driven: known.driven,
            frequency: (low * high).sqrt(),
            ..Self::default()
        }
    }

    /// Relative error of its frequency that the mesh makes.
    pub fn mesh(&self) -> f64 {
        self.mesh
    }

    /// Takes an accepted step, with the unknowns and their rates at its end.
    pub fn step(&mut self, tableau: Option<&Tableau>, step: &Step, [y, yp]: [&[f64]; 2]) {
        let sum = |values: &[f64]| -> f64 { self.weights.iter().zip(values).map(|(w, x)| w * x).sum() };
        let [u, v] = self.first;
        let values = [sum(&y[u..]), self.rate * sum(&y[v..]), self.rate * sum(&yp[v..])];
        let [lost, turned] = factor(tableau, step.order, self.frequency * step.size);
        // `v² + (a/ω)²` is that of a vibration all along and nothing at rest, where steps are long and nothing is lost
        let swing = values[1].hypot(values[2] / self.frequency);
        let swings = swing.min(self.swing);
        self.swing = swing;
        let block = &mut self.block;
        block.swing = block.swing.max(swing);
        block.time += step.size;
        block.mean += step.size * values[0];
        for (square, value) in block.squares.iter_mut().zip(values) {
            *square += step.size * value * value;
        }
        block.lost += swings * lost;
        block.turned += swings * turned;
        if block.time * self.band[0] > PERIODS * std::f64::consts::TAU {
            self.conclude();
        }
    }

    /// Ends a block: what of it is free vibration, and what that adds to the errors.
    fn conclude(&mut self) {
        let mut block = std::mem::take(&mut self.block);
        if block.swing > 0.0 {
            block.lost /= block.swing;
            block.turned /= block.swing;
        }
        let (mean_square, square) = block.free(self.band);
        let amplitude = (2.0 * mean_square).sqrt();
        // What decays, and not by the steps alone, takes its error along, and so does what grows; what was struck anew does not.
        let grown = match self.amplitude.filter(|a| *a > 0.0).map(|before| amplitude / before) {
            Some(ratio) if ratio > STRUCK => 1.0,
            Some(ratio) if ratio > 1.0 => ratio,
            Some(ratio) => (ratio * (-block.lost).exp()).min(1.0),
            None => 1.0,
        };
        let decay = if grown < STEADY {
            grown.min((-self.damping * block.time).exp())
        } else {
            grown
        };
        self.off_time = self.off_time.map(|x| x * decay);
        self.off_space *= decay;
        self.frequency = square.sqrt();
        let turned = self.frequency * block.time;
        let shifted = self.mesh * turned;
        self.off_time[0] += amplitude * block.lost.clamp(-2.0, 2.0);
        self.off_time[1] += amplitude * block.turned.clamp(-2.0, 2.0);
        self.off_space += amplitude * shifted;
        self.amplitude = Some(amplitude);
        self.largest = self.largest.max(amplitude);
        self.lost += block.lost.min(0.0);
        for (sum, more) in self.turned.iter_mut().zip([block.turned, shifted, turned]) {
            *sum += more;
        }
    }

    /// The mode at the end of the run, its last block however short.
    pub fn ended(&self) -> Self {
        let mut end = self.clone();
        if end.amplitude.is_none() || end.block.time * end.band[0] > std::f64::consts::TAU {
            end.conclude();
        }
        end
    }

    /// How far it swings at last [m].
    pub fn amplitude(&self) -> f64 {
        self.amplitude.unwrap_or(0.0)
    }

    /// Errors of the coordinate by steps and by the mesh: at most twice the vibration that there is, or would be if the steps had not
    /// taken it away.
    pub fn off(&self) -> [f64; 2] {
        let left = self.amplitude();
        let without_loss = left * (-self.lost).min(30.0).exp();
        let most = 2.0 * without_loss.clamp(left, self.largest.max(left));
        [
            self.off_time[0].hypot(self.off_time[1]).min(most),
            self.off_space.abs().min(most),
        ]
    }
}

impl Block {
    /// Largest mean square that a vibration in the band can have, and the square of its frequency [1/s^2].
    ///
    /// With the mean squares μ0, μ1, μ2 of the coordinate about its mean, its rate and its acceleration, which are moments of a
    /// distribution over squares of frequencies, no more than
    ///
    /// ```text
    /// (1/μ0 + μ0 (x - μ1/μ0)²/(μ0 μ2 - μ1²))⁻¹
    /// ```
    ///
    /// of μ0 can be at x (Chebyshev, Markov): a motion that follows a slow drive has nothing there.
    fn free(&self, [low, high]: [f64; 2]) -> (f64, f64) {
        let time = self.time.max(f64::MIN_POSITIVE);
        let mean = self.mean / time;
        let [m0, m1, m2] = self.squares.map(|s| s / time);
        let m0 = m0 - mean * mean;
        if m0 <= 0.0 || m1 <= 0.0 {
            return (0.0, low * high);
        }
        let own = m1 / m0;
        let x = own.clamp(low * low, high * high);
        let spread = m0 * m2 - m1 * m1;
        let share = match x == own {
            true => m0,
            false if spread <= 0.0 => 0.0,
            false => 1.0 / (1.0 / m0 + m0 * (x - own).powi(2) / spread),
        };
        (share, x)
    }
}

/// The coefficients of a method, `None` for BDF.
pub fn tableau(method: Option<Method>) -> Option<Tableau> {
    method.map(Method::tableau)
}
