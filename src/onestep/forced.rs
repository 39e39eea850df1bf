//! Response of a march to a forcing: derivatives by a parameter of its equations, and motions forced harmonically.

use nalgebra::Complex;

use super::stages::{add, values};
use super::step_map::{StepError, StepMap};
use crate::dae::Dae;

/// Writes `∂F/∂σ` at a time [s], along a step of the given c_j [1/s], with values and rates.
pub type ForcingDerivative<'a> = dyn FnMut([f64; 2], [&[f64]; 2], &mut [f64]) -> Result<(), String> + 'a;

/// Receives a stage with its values and rates.
pub type StageReader<'a> = dyn FnMut(MarchStage, [&[f64]; 2]) -> Result<(), StepError> + 'a;

/// Adds the forcing of a stage, given by its index, to a complex vector.
pub type StageForcing<'a> = &'a mut dyn FnMut(usize, &mut [Complex<f64>]);

/// Receives the index of a stage, and complex disturbances of unknowns and of rates there.
pub type ForcedStage<'a> = &'a mut dyn FnMut(usize, [&[Complex<f64>]; 2]);

/// A stage of a march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarchStage {
    /// Time [s].
    pub time: f64,
    /// c_j of its step [1/s].
    pub cj: f64,
    /// Weight of its values in integrals over the march [s], of the order of the method.
    pub weight: f64,
}

impl<D: Dae> StepMap<D> {
    /// Visits the start and all implicit stages of the last march in order of their indices. It began at `y` with the rates `yp`.
    ///
    /// # Errors
    /// Those of `read`, and a start that cannot be linearized.
    pub fn each_stage(&mut self, [y, yp]: [&[f64]; 2], read: &mut StageReader<'_>) -> Result<(), StepError> {
        let (n, s) = (y.len(), self.tableau.stages);
        let b = self.tableau.b();
        let mask = self.mask.clone();
        let steps = self.times.len() - 1;
        let lengths: Vec<f64> = self.times.windows(2).map(|t| t[1] - t[0]).collect();
        let (mut now, mut rates) = (y.to_vec(), yp.to_vec());
        let mut x: Vec<Vec<f64>> = vec![vec![0.0; n]; s];
        for (i, x) in x[0].iter_mut().enumerate() {
            *x = if mask[i] > 0.0 { yp[i] } else { y[i] };
        }
        // the start is evaluated with the cj of its step, for the forcing and for the matrix
        let cj = 1.0 / (self.tableau.gamma() * lengths[0]);
        self.equations.dae.approach(cj);
        self.linearise_start(self.times[0], y, yp)?;
        let weight = lengths[0] * b[0];
        let time = self.times[0];
        read(MarchStage { time, cj, weight }, [&now, &rates])?;
        for step in 0..steps {
            let h = lengths[step];
            let scale = h * self.tableau.gamma();
            let begin = now.clone();
            for i in 1..s {
                let mut base = begin.clone();
                for (j, x) in x.iter().enumerate().take(i) {
                    add(&mut base, h * self.tableau.a[i][j], x);
                }
                x[i].copy_from_slice(&self.slots[1 + step * (s - 1) + i - 1].x);
                values(&x[i], &base, &mask, scale, [&mut now, &mut rates]);
                let mut weight = h * b[i];
                if i == s - 1 {
                    // the last stage is the first one of the next step
                    weight += lengths.get(step + 1).map_or(0.0, |next| next * b[0]);
                }
                let time = self.times[step] + self.tableau.c[i] * h;
                let cj = 1.0 / scale;
                read(MarchStage { time, cj, weight }, [&now, &rates])?;
            }
            x.swap(0, s - 1);
        }
        Ok(())
    }

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
        state: [&[f64]; 2],
        d: &mut [f64],
        source: &mut ForcingDerivative<'_>,
    ) -> Result<(), StepError> {
        let mut forcing: Vec<Vec<f64>> = vec![];
        self.each_stage(state, &mut |stage, state| {
            let mut out = vec![0.0; state[0].len()];
            source([stage.time, stage.cj], state, &mut out).map_err(|what| StepError::new(stage.time, what))?;
            forcing.push(out);
            Ok(())
        })?;
        let mut force =
            |slot: usize, out: &mut [f64]| out.iter_mut().zip(&forcing[slot]).for_each(|(out, f)| *out = -f);
        self.carry(d, &mut force, &mut |_| {}, &mut |_, _| {});
        self.work.disturbances += 1;
        Ok(())
    }

    /// Propagates a complex disturbance `d` like [`StepMap::respond_along`], with a forcing `∂F/∂σ` that `force` adds to zero for every
    /// stage; `look` receives the disturbance at the stages.
    pub fn force_along(&mut self, d: &mut [Complex<f64>], force: StageForcing<'_>, look: ForcedStage<'_>) {
        let n = d.len();
        let mut block: Vec<f64> = d.iter().map(|d| d.re).chain(d.iter().map(|d| d.im)).collect();
        let mut forcing = vec![Complex::new(0.0, 0.0); n];
        let mut put = |slot: usize, out: &mut [f64]| {
            forcing.fill(Complex::new(0.0, 0.0));
            force(slot, &mut forcing);
            for (i, f) in forcing.iter().enumerate() {
                (out[i], out[n + i]) = (-f.re, -f.im);
            }
        };
        let (mut value, mut rate) = (d.to_vec(), d.to_vec());
        let mut read = |slot: usize, both: [&[f64]; 2]| {
            for (joined, parts) in [&mut value, &mut rate].into_iter().zip(both) {
                join(parts, joined);
            }
            look(slot, [&value, &rate]);
        };
        self.carry(&mut block, &mut put, &mut |_| {}, &mut read);
        self.work.disturbances += 2;
        join(&block, d);
    }
}

/// Joins real and imaginary parts, one after the other.
fn join(parts: &[f64], out: &mut [Complex<f64>]) {
    let (re, im) = parts.split_at(out.len());
    for (out, (re, im)) in out.iter_mut().zip(re.iter().zip(im)) {
        *out = Complex::new(*re, *im);
    }
}
