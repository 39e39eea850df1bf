//! Motion of the beam and pressures of the bladders in a response.

use super::LinearResponse;
use crate::dae::{BeamDae, Dae as _};
use crate::error::Result;
use crate::functions::Signal;
use crate::run::modes::{ModeShape, Shapes};

/// Difference of an input over its size, for a motion that is linear in it.
const DIFFERENCE: f64 = 1e-3;

impl LinearResponse {
    /// Shapes at frequencies [Hz], per unit of the input: u1 and u3 of each node, mean pressure of each bladder. None at a pole.
    ///
    /// # Errors
    /// The computation was interrupted; the equations cannot be factored.
    pub fn shapes(&self, frequencies: &[f64]) -> Result<Vec<Option<ModeShape>>> {
        let mut shapes = Shapes::new(&self.about);
        let direct = self.direct_motion();
        let mut solver = self.solver()?;
        let mut one = |hz: &f64| {
            let (_, x) = solver.state(*hz).ok()?;
            let mut shape = shapes.along(&x);
            let parts = [&mut shape.u1, &mut shape.u3, &mut shape.pressure];
            for (part, direct) in parts.into_iter().zip(&direct) {
                part.iter_mut().zip(direct).for_each(|(x, direct)| *x += direct);
            }
            let all = shape.u1.iter().chain(&shape.u3).chain(&shape.pressure);
            all.clone()
                .all(|x| x.re.is_finite() && x.im.is_finite())
                .then_some(shape)
        };
        Ok(frequencies.iter().map(&mut one).collect())
    }

    /// Derivatives of displacements and pressures by the input, with fixed unknowns: displacements are relative to a moved end.
    fn direct_motion(&self) -> [Vec<f64>; 3] {
        let mut dae = self.about.dae.clone();
        let step = DIFFERENCE * self.u0.abs().max(1.0);
        let towards = if self.u0 > 0.5 { -step } else { step };
        let [before, after] = [0.0, towards].map(|by| self.motion(&mut dae, self.u0 + by));
        let quotient = |k: usize| -> Vec<f64> {
            let both = before[k].iter().zip(&after[k]);
            both.map(|(before, after)| (after - before) / towards).collect()
        };
        [0, 1, 2].map(quotient)
    }

    /// Displacements and pressures at a value of the input.
    fn motion(&self, dae: &mut BeamDae, value: f64) -> [Vec<f64>; 3] {
        dae.put_signal(&self.places, &Signal::Constant(value));
        let at_rest = vec![0.0; dae.len()];
        let (system, _, state) = dae.evaluate(self.about.at, &self.about.y, &at_rest);
        let u = &state.motion.u;
        [
            u.iter().map(|u| u.x).collect(),
            u.iter().map(|u| u.z).collect(),
            system.pressures_of_fluid(&state).collect(),
        ]
    }
}
