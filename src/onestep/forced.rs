//! Response of a march to a change of its equations: derivative of the period map by a parameter.

use super::stages::{add, values};
use super::step_map::{StepError, StepMap};
use crate::dae::Dae;

/// Writes `∂F/∂σ` at a time [s], along a step of the given c_j [1/s], with values and rates.
pub type ForcingDerivative<'a> = dyn FnMut([f64; 2], [&[f64]; 2], &mut [f64]) -> Result<(), String> + 'a;

impl<D: Dae> StepMap<D> {
    /// `[E75]` Propagates a disturbance `d` of the differential unknowns to the last time, like [`StepMap::propagate`], along the last
    /// march. It began at `y` with the rates `yp`; the equations change as well:
    ///
    /// ```text
    /// (∂F/∂y + 1/(hγ) ∂F/∂y') hγ δKᵢ = -∂F/∂y (δyₙ + h Σ_{j<i} aᵢⱼ δKⱼ) - ∂F/∂σ
    /// ```
    ///
    /// If d is the derivative of the initial values by σ, it becomes the derivative of the final values, exact for the
    /// steps taken.
    ///
    /// # Errors
    /// If the source cannot be evaluated.
    pub fn respond_along(
        &mut self,
        [y, yp]: [&[f64]; 2],
        d: &mut [f64],
        source: &mut ForcingDerivative<'_>,
    ) -> Result<(), StepError> {
        let (n, s) = (y.len(), self.tableau.stages);
        let mask = self.mask.clone();
        let keep = |v: &mut [f64]| v.iter_mut().zip(&mask).for_each(|(v, m)| *v *= m);
        let (mut now, mut rates) = (y.to_vec(), yp.to_vec());
        let mut x: Vec<Vec<f64>> = vec![vec![0.0; n]; s];
        for (i, x) in x[0].iter_mut().enumerate() {
            *x = if mask[i] > 0.0 { yp[i] } else { y[i] };
        }
        keep(d);
        let mut k: Vec<Vec<f64>> = vec![vec![0.0; n]; s];
        let mut forced = |t: f64, cj: f64, state: [&[f64]; 2], out: &mut [f64]| {
            source([t, cj], state, out).map_err(|what| StepError::new(t, what))?;
            out.iter_mut().for_each(|out| *out = -*out);
            Ok(())
        };
        // the start is evaluated with the cj of its step, for the source and for the matrix
        let cj = 1.0 / (self.tableau.gamma() * (self.times[1] - self.times[0]));
        self.equations.dae.approach(cj);
        self.linearise_start(self.times[0], y, yp)?;
        forced(self.times[0], cj, [&now, &rates], &mut k[0])?;
        self.answer(0, d, &mut k[0]);
        keep(&mut k[0]);
        for step in 0..self.times.len() - 1 {
            let (t, h) = (self.times[step], self.times[step + 1] - self.times[step]);
            let scale = h * self.tableau.gamma();
            let begin = now.clone();
            let mut base_d = vec![0.0; n];
            for i in 1..s {
                let mut base = begin.clone();
                base_d.copy_from_slice(d);
                for j in 0..i {
                    add(&mut base, h * self.tableau.a[i][j], &x[j]);
                    add(&mut base_d, h * self.tableau.a[i][j], &k[j]);
                }
                let slot = 1 + step * (s - 1) + i - 1;
                x[i].copy_from_slice(&self.slots[slot].x);
                values(&x[i], &base, &mask, scale, [&mut now, &mut rates]);
                forced(t + self.tableau.c[i] * h, 1.0 / scale, [&now, &rates], &mut k[i])?;
                self.answer(slot, &base_d, &mut k[i]);
                keep(&mut k[i]);
                k[i].iter_mut().for_each(|k| *k /= scale);
            }
            d.copy_from_slice(&base_d);
            add(d, scale, &k[s - 1]);
            x.swap(0, s - 1);
            k.swap(0, s - 1);
        }
        self.work.disturbances += 1;
        Ok(())
    }
}
