//! Equations with a slightly changed parameter, and derivatives by that parameter.

use super::BeamDae;
use crate::case::parameter::STEPS;
use crate::discrete::{System, TimeData, Workspace};

/// Change of an unknown, relative to 1 + |unknown|, for differences of quantities of a state: small compared with the width of smoothed
/// kinks, large compared with rounding errors.
const NUDGE: f64 = 1e-5;

/// Equations at p (1 ± ε) and p (1 ± 2ε), in the order of [`STEPS`]; unknowns and equations are scaled as those at p.
#[derive(Clone, Debug)]
pub struct PerturbedSystems {
    beams: Box<[BeamDae; 4]>,
    /// ε.
    change: f64,
    out: Vec<f64>,
}

impl PerturbedSystems {
    /// Creates the perturbed equations of `of`, with the relative change ε of the parameter. The systems have the same unknowns and scales.
    pub fn new(of: &BeamDae, systems: [System; 4], change: f64) -> Self {
        Self {
            beams: Box::new(systems.map(|system| of.with_system(system))),
            change,
            out: vec![],
        }
    }

    /// Relative change ε of the parameter.
    pub fn change(&self) -> f64 {
        self.change
    }

    /// The equations in the order of [`STEPS`].
    pub fn beams_mut(&mut self) -> &mut [BeamDae; 4] {
        &mut self.beams
    }

    /// `[E40]` Writes the derivative by the relative change σ of a parameter p. `value` evaluates the function for each of the equations;
    /// its first argument is the index in [`STEPS`]:
    ///
    /// ```text
    /// ∂f/∂σ = (8 (f(p(1+ε)) - f(p(1-ε))) - (f(p(1+2ε)) - f(p(1-2ε)))) / 12ε        ε = 1e-3, with contacts 1e-3 d/L if that is less
    /// ```
    ///
    /// The error is `ε⁴ f⁽⁵⁾/30`: 4e-12 of f if f is proportional to 1/p, only rounding errors (3e-13 of the largest term) if f is a
    /// polynomial of p of degree four or less.
    pub fn derivative<E>(
        &mut self,
        out: &mut [f64],
        mut value: impl FnMut(usize, &mut BeamDae, &mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        self.out.resize(out.len(), 0.0);
        let mut first = self.out.clone();
        // differences of pairs first: they are exactly zero for quantities independent of the parameter
        for pair in [2, 0] {
            value(pair, &mut self.beams[pair], &mut first)?;
            value(pair + 1, &mut self.beams[pair + 1], &mut self.out)?;
            for ((out, f), g) in out.iter_mut().zip(&first).zip(&self.out) {
                let part = STEPS[pair].1 * (f - g) / self.change;
                *out = if pair == 2 { part } else { *out + part };
            }
        }
        Ok(())
    }
}

impl BeamDae {
    /// Writes the derivative of the quantities that `read` computes from an evaluated state, along the sensitivity `along = [s, s']` to
    /// parameter k. Derivatives by the state are fourth-order differences over a small change, those by the parameter are from
    /// [`PerturbedSystems::derivative`].
    ///
    /// `read` receives rates in SI units and a workspace after [`crate::discrete::residual::evaluate`].
    pub fn read_slope(
        &mut self,
        k: usize,
        t: f64,
        [y, yp]: [&[f64]; 2],
        [s, sp]: [&[f64]; 2],
        out: &mut [f64],
        mut read: impl FnMut(&System, &TimeData, &[f64], &mut Workspace<f64>, &mut [f64]),
    ) {
        let largest = s
            .iter()
            .zip(y)
            .fold(0.0_f64, |m, (s, y)| m.max(s.abs() / (1.0 + y.abs())));
        let h = if largest > 0.0 { NUDGE / largest } else { 1.0 };
        let mut values = STEPS.map(|_| vec![0.0; out.len()]);
        for ((step, _), values) in STEPS.iter().zip(&mut values) {
            let go = |y: &[f64], s: &[f64]| -> Vec<f64> { y.iter().zip(s).map(|(y, s)| y + step * h * s).collect() };
            self.visit(t, &go(y, s), &go(yp, sp), |system, now, rates, w| {
                read(system, now, rates, w, values)
            });
        }
        let by_parameter = self.perturbed_mut()[k].derivative(out, |_, beam, out| {
            beam.visit(t, y, yp, |system, now, rates, w| read(system, now, rates, w, out));
            Ok::<(), std::convert::Infallible>(())
        });
        debug_assert!(by_parameter.is_ok());
        for (i, out) in out.iter_mut().enumerate() {
            for pair in [2, 0] {
                *out += STEPS[pair].1 * (values[pair][i] - values[pair + 1][i]) / h;
            }
        }
    }
}
