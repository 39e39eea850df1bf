//! Mean powers of small forced motions, from the energy balance of the equations.

use nalgebra::Complex;

use super::LinearResponse;
use super::instant::limits;
use crate::dae::{BeamDae, Dae as _};
use crate::discrete::ledger::{ENERGY_RATES, EnergyRate};
use crate::functions::Signal;
use crate::functions::signals::Polynomial;

/// Time of evaluation [s]: at 0 a polynomial of the input has its value without rounding.
const NOW: f64 = 0.0;
/// Largest scaled amplitudes at which powers are evaluated, each a tenth of the one before.
const AMPLITUDES: [f64; 7] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// Power of the state itself, over that of a motion of the largest amplitude, above which energy flows there already.
const FLOWS: f64 = 1e-2;

/// Mean powers over a cycle for an input of unit amplitude [W over the squared unit of the input].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanPowers([f64; ENERGY_RATES.len()]);

impl MeanPowers {
    /// Power of one kind.
    pub fn power(&self, rate: EnergyRate) -> f64 {
        self.0[rate as usize]
    }

    /// Power put in by loads, ends and ports.
    pub fn input(&self) -> f64 {
        [EnergyRate::Loads, EnergyRate::Ends, EnergyRate::Ports]
            .map(|rate| self.power(rate))
            .iter()
            .sum()
    }

    /// Input and additions less all losses: zero but for rounding errors.
    pub fn residual(&self) -> f64 {
        ENERGY_RATES
            .iter()
            .map(|rate| rate.energy_sign() * self.power(*rate))
            .sum()
    }
}

/// Evaluates mean powers about the state of a response.
pub struct PowerMeter<'a> {
    of: &'a LinearResponse,
    dae: BeamDae,
    /// Powers of the state itself.
    at_rest: Vec<f64>,
}

impl<'a> PowerMeter<'a> {
    /// Meter about the state of a response; `None` if powers cannot be evaluated there.
    pub fn new(of: &'a LinearResponse) -> Option<Self> {
        let mut dae = BeamDae::new(of.about.system().clone());
        dae.enter_smooth_interval(NOW);
        let mut meter = Self {
            of,
            at_rest: vec![],
            dae,
        };
        let none = Complex::new(0.0, 0.0);
        meter.at_rest = meter.powers(&vec![none; of.about.y.len()], none, 0.0, 0.0)?;
        Some(meter)
    }

    /// Mean powers of the motion `Re(x exp(s t))`, s imaginary, of the scaled unknowns, whose input has the amplitude one. `None` if energy
    /// flows at the state itself, so that they are not quadratic in the motion.
    ///
    /// `[E101]` A power P is quadratic in small motions; with the phases θ of four quarters its mean is
    ///
    /// ```text
    /// P̄ = lim Σ (P(ε Re(x exp(iθ))) - P(0))/(4 ε²)        θ = 0, π/2, π, 3π/2        ε → 0
    /// ```
    ///
    /// The limit is that of decreasing ε, as for the derivatives of a response: drag is of higher order, and check valves have kinks.
    pub fn mean(&mut self, x: &[Complex<f64>], s: Complex<f64>) -> Option<MeanPowers> {
        let largest = x.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let unit = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        let mut quotients = vec![];
        for amplitude in AMPLITUDES {
            let size = amplitude * unit;
            let mut mean = vec![0.0; ENERGY_RATES.len()];
            for quarter in 0..4 {
                let angle = f64::from(quarter) * std::f64::consts::FRAC_PI_2;
                let powers = self.powers(x, s, size, angle)?;
                for ((mean, power), at_rest) in mean.iter_mut().zip(powers).zip(&self.at_rest) {
                    *mean += 0.25 * (power - at_rest) / (size * size);
                }
            }
            quotients.push(mean);
        }
        let first = AMPLITUDES[0] * unit;
        let largest = |powers: &[f64]| {
            let energies = powers.iter().take(EnergyRate::ImpulseX as usize);
            energies.fold(0.0_f64, |m, power| m.max(power.abs()))
        };
        let moving = largest(&quotients[0]) * first * first;
        let mean: [f64; ENERGY_RATES.len()] = limits(&quotients).try_into().ok()?;
        (largest(&self.at_rest) <= FLOWS * moving).then_some(MeanPowers(mean))
    }

    /// Powers at an instant of the motion of an amplitude.
    fn powers(&mut self, x: &[Complex<f64>], s: Complex<f64>, size: f64, angle: f64) -> Option<Vec<f64>> {
        let turn = Complex::from_polar(size, angle);
        let of = self.of;
        let [u, rate, second] = [turn, s * turn, s * s * turn].map(|u| u.re);
        let coefficients = vec![of.u0 + u, rate, 0.5 * second];
        self.dae
            .put_signal(&of.places, &Signal::Polynomial(Polynomial { coefficients }));
        let y: Vec<f64> = of.about.y.iter().zip(x).map(|(y, x)| y + (x * turn).re).collect();
        let yp: Vec<f64> = x.iter().map(|x| (s * x * turn).re).collect();
        let mut powers = vec![0.0; self.dae.integrals()];
        self.dae.integrands(NOW, &y, &yp, &mut powers).ok()?;
        Some(powers)
    }
}
