//! Dense output: values, rates and integrals within the last step.
//!
//! Differential unknowns: cubic Hermite polynomial through values and rates at both ends. Algebraic unknowns: polynomial through the
//! stages [`super::Tableau::nodes`]. Integrals: `h Σ bᵢ g(tᵢ, Yᵢ, Kᵢ)` from step to step, cubic Hermite polynomial inside.

use super::equations::StageError;
use super::integrator::OneStep;
use super::polynomial;
use super::stages::{Stages, add};
use crate::dae::Dae;
use crate::integrate::IntegrationError;

/// Integrals at both ends of the last step, with their integrands.
#[derive(Clone, Debug)]
pub(super) struct StepIntegrals {
    total: [Vec<f64>; 2],
    rate: [Vec<f64>; 2],
    /// True if the integrands at the present time have been evaluated.
    known: bool,
    sum: Vec<f64>,
    stage: Vec<f64>,
}

impl StepIntegrals {
    pub fn new(count: usize) -> Self {
        let zeros = || vec![0.0; count];
        Self {
            total: [zeros(), zeros()],
            rate: [zeros(), zeros()],
            known: false,
            sum: zeros(),
            stage: zeros(),
        }
    }

    /// Resets the integrals to zero.
    pub fn restart(&mut self) {
        self.known = false;
        self.total[1].fill(0.0);
    }
}

/// Hermite weights of values and scaled slopes at both ends, or the derivatives of these weights by x.
fn hermite(x: f64, derivative: bool) -> [f64; 4] {
    if derivative {
        let bell = 6.0 * x * (1.0 - x);
        [-bell, bell, (1.0 - x) * (1.0 - 3.0 * x), x * (3.0 * x - 2.0)]
    } else {
        let rise = x * x * (3.0 - 2.0 * x);
        [1.0 - rise, rise, x * (1.0 - x) * (1.0 - x), x * x * (x - 1.0)]
    }
}

impl<D: Dae> OneStep<D> {
    /// Derivative of order `k`, 0 or 1, of the unknowns at a time [s] within the last step.
    ///
    /// Panics if `out` and the unknowns differ in length.
    pub fn interpolate(&mut self, time: f64, k: u8, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        let x = self.place(time)?;
        if k > 1 {
            let message = format!("derivative {k} of the unknowns is not available");
            return Err(IntegrationError::request(message, self.time));
        }
        assert_eq!(out.len(), self.mask.len(), "values of another system");
        let Stages { h, x: stages, y, .. } = &self.last;
        let end = self.tableau.stages - 1;
        let [v0, v1, s0, s1] = hermite(x, k == 1);
        let per = if k == 1 { 1.0 / h } else { 1.0 };
        let ends = (y[0].iter().zip(&y[end])).zip(stages[0].iter().zip(&stages[end]));
        let [w0, w1, r0, r1] = [per * v0, per * v1, per * h * s0, per * h * s1];
        for (out, ((y0, y1), (x0, x1))) in out.iter_mut().zip(ends) {
            *out = w0 * y0 + w1 * y1 + r0 * x0 + r1 * x1;
        }
        self.algebraic(&self.last, x, k == 1, out);
        Ok(())
    }

    /// Integrals `∫ g dt` since the last restart, at the present time or at a time [s] within the last step. `out` has length
    /// `dae.integrals()`.
    pub fn integrals(&mut self, time: Option<f64>, out: &mut [f64]) -> Result<(), Box<IntegrationError>> {
        let StepIntegrals { total, rate, .. } = &self.integrals;
        match time {
            Some(time) if self.last.h > 0.0 => {
                let x = self.place(time)?;
                let (h, [v0, v1, s0, s1]) = (self.last.h, hermite(x, false));
                for (i, out) in out.iter_mut().enumerate() {
                    let values = v0 * total[0][i] + v1 * total[1][i];
                    *out = values + h * (s0 * rate[0][i] + s1 * rate[1][i]);
                }
            }
            _ => out.copy_from_slice(&total[1]),
        }
        Ok(())
    }

    /// Relative position of a time within the last step, 0 to 1.
    fn place(&self, time: f64) -> Result<f64, Box<IntegrationError>> {
        let Stages { t, h, .. } = self.last;
        let x = (time - t) / h;
        let round_off = 100.0 * f64::EPSILON * (time.abs() + self.time.abs()) / h;
        if h > 0.0 && (-round_off..=1.0 + round_off).contains(&x) {
            return Ok(x.clamp(0.0, 1.0));
        }
        let message = if h > 0.0 {
            format!("the time {time:e} s is outside the last step")
        } else {
            "nothing can be interpolated before the first step".to_owned()
        };
        Err(IntegrationError::request(message, self.time))
    }

    /// Writes the values of algebraic unknowns at a relative position in a step, or their rates [1/s].
    pub(super) fn algebraic(&self, step: &Stages, x: f64, rates: bool, out: &mut [f64]) {
        let chosen = self.tableau.nodes;
        let mut nodes = [0.0; polynomial::NODES];
        for (node, &j) in nodes.iter_mut().zip(chosen) {
            *node = self.tableau.c[j];
        }
        let nodes = &nodes[..chosen.len()];
        let weights = if rates {
            polynomial::slope(nodes, x).map(|w| w / step.h)
        } else {
            polynomial::value(nodes, x)
        };
        for &i in &self.algebraic {
            out[i] = chosen.iter().zip(weights).map(|(&j, w)| w * step.x[j][i]).sum();
        }
    }

    /// Rates of all unknowns at stage `i` of the present step.
    pub(super) fn rates(&self, i: usize, out: &mut [f64]) {
        for ((out, x), mask) in out.iter_mut().zip(&self.now.x[i]).zip(&self.mask) {
            *out = mask * x;
        }
        self.algebraic(&self.now, self.tableau.c[i], true, out);
    }

    /// Advances the integrals over the present step, which ends at `t1` [s].
    pub(super) fn integrate(&mut self, t1: f64) -> Result<(), StageError> {
        if self.integrals.sum.is_empty() {
            return Ok(());
        }
        let (h, b, s) = (self.now.h, self.tableau.b(), self.tableau.stages);
        let mut yp = std::mem::take(&mut self.work.yp);
        let done: Result<(), StageError> = (0..s).filter(|&i| b[i] != 0.0).try_for_each(|i| {
            let g = &mut self.integrals;
            if i == 0 && g.known {
                g.sum.fill(0.0);
                add(&mut g.sum, b[0], &g.rate[1]);
                return Ok(());
            }
            self.rates(i, &mut yp);
            let t = if i == s - 1 {
                t1
            } else {
                self.now.t + self.tableau.c[i] * h
            };
            let g = &mut self.integrals;
            self.equations.integrands(t, &self.now.y[i], &yp, &mut g.stage)?;
            if i == 0 {
                g.rate[1].copy_from_slice(&g.stage);
                g.sum.fill(0.0);
                g.known = true;
            }
            add(&mut g.sum, b[i], &g.stage);
            Ok(())
        });
        self.work.yp = yp;
        done?;
        let StepIntegrals {
            total,
            rate,
            sum,
            stage,
            ..
        } = &mut self.integrals;
        total.swap(0, 1);
        rate.swap(0, 1);
        let (before, after) = total.split_at_mut(1);
        after[0].copy_from_slice(&before[0]);
        add(&mut after[0], h, sum);
        rate[1].copy_from_slice(stage);
        Ok(())
    }
}
