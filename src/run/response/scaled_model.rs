//! A state-space model whose input changes, as a system that an integrator solves.

use super::self_test::{STEPS, TOLERANCE, failed, options, reached};
use super::state_space::StateSpace;
use crate::dae::{Dae, EvaluationError, Seeds};
use crate::functions::signals::{Ramp, Signal, SmoothTime};
use crate::integrate::AbsoluteTolerances;
use crate::onestep::OneStep;
use crate::sparse::Pattern;

/// Sampled instants: equally spaced ones over some durations of the change, then with growing distances.
pub(super) const EARLY: usize = 80;
const DURATIONS: f64 = 4.0;
const MOST: usize = 300;
const GROWTH: f64 = 1.03;
/// Distance from the final value, over the largest change, within which an output is settled.
const SETTLED: f64 = 0.02;

/// Instants of samples [s]. The end of the change is one of them.
fn instants(ramp_s: f64) -> Vec<f64> {
    let early = (1..=EARLY).map(|k| DURATIONS * ramp_s * k as f64 / EARLY as f64);
    let late = (1..=MOST - EARLY).map(|k| DURATIONS * ramp_s * GROWTH.powi(k as i32));
    early.chain(late).collect()
}

/// A state-space model whose input changes smoothly, with each state over its size: `x' = A x + B w`.
pub(super) struct ScaledModel<'a> {
    model: &'a StateSpace,
    change: Ramp,
    /// Size of each state during the change.
    sizes: Vec<f64>,
    pattern: Pattern,
    /// Entries of A in the order of the pattern.
    a: Vec<f64>,
    differential: Vec<bool>,
}

impl<'a> ScaledModel<'a> {
    /// `sizes` are those of the states in front of the input and its rates.
    pub(super) fn new(model: &'a StateSpace, change: Ramp, mut sizes: Vec<f64>) -> Self {
        let n = model.b.len();
        let step = (change.to - change.from).abs();
        sizes.truncate(n - model.input_rate);
        sizes.extend((0..model.input_rate).map(|rate| step / change.duration_s.powi(rate as i32)));
        let rows = |j: usize| (0..n).filter(move |&i| i == j || model.a[i][j] != 0.0);
        let pattern = Pattern::from_columns(&(0..n).map(|j| rows(j).collect()).collect::<Vec<_>>());
        let entries = (0..n).flat_map(|j| rows(j).map(move |i| (i, j)));
        Self {
            a: entries.map(|(i, j)| model.a[i][j] * sizes[j] / sizes[i]).collect(),
            model,
            change,
            sizes,
            pattern,
            differential: vec![true; n],
        }
    }

    /// Input of the model at a time [s].
    fn input(&self, t: f64) -> f64 {
        let within = if t < self.change.duration_s { 0.5 } else { 2.0 } * self.change.duration_s;
        let jet = Signal::Ramp(self.change.clone()).jet(SmoothTime { t, within });
        match self.model.input_rate {
            0 => jet.value - self.change.from,
            1 => jet.rate,
            _ => jet.acceleration,
        }
    }

    /// Changes of the outputs at instants [s] until all have settled at their static gain.
    pub(super) fn simulated(self, gain: Vec<Option<f64>>) -> std::result::Result<Vec<(f64, Vec<f64>)>, String> {
        let step = self.change.to - self.change.from;
        let ramp_s = self.change.duration_s;
        let zeros = vec![0.0; self.sizes.len()];
        let options = options(AbsoluteTolerances::Same(0.1 * TOLERANCE));
        let mut solver = OneStep::new(self, 0.0, &zeros, &zeros, &options).map_err(|fault| failed(&fault))?;
        let mut rows: Vec<(f64, Vec<f64>)> = vec![];
        let mut largest = vec![0.0_f64; gain.len()];
        let mut unsettled = 0.0;
        for t in instants(ramp_s) {
            if !reached(&mut solver, t)? {
                break;
            }
            let (linear, y) = (solver.dae(), solver.y());
            let input = linear.input(t);
            let all = linear.model.c.iter().zip(&linear.model.d);
            let values = all.map(|(c, d)| {
                let states = c.iter().zip(y).zip(&linear.sizes);
                states.map(|((c, y), size)| c * y * size).sum::<f64>() + d * input
            });
            let values: Vec<f64> = values.collect();
            for ((value, gain), largest) in values.iter().zip(&gain).zip(&mut largest) {
                *largest = largest.max(value.abs());
                if gain.is_some_and(|gain| (value - gain * step).abs() > SETTLED * *largest) {
                    unsettled = t;
                }
            }
            rows.push((t, values));
            if t >= 2.0 * DURATIONS * ramp_s && t > 1.2 * unsettled {
                break;
            }
        }
        match rows.len() {
            short if short < EARLY => Err(format!(
                "{STEPS} steps of the model end before {} s",
                DURATIONS * ramp_s
            )),
            _ => Ok(rows),
        }
    }
}

impl Dae for ScaledModel<'_> {
    fn len(&self) -> usize {
        self.sizes.len()
    }

    fn differential(&self) -> &[bool] {
        &self.differential
    }

    fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        residual: &mut [f64],
    ) -> std::result::Result<(), EvaluationError> {
        let input = self.input(t);
        for (i, residual) in residual.iter_mut().enumerate() {
            *residual = yp[i] - self.model.b[i] * input / self.sizes[i];
        }
        for (j, y) in y.iter().enumerate() {
            for entry in self.pattern.column(j) {
                residual[self.pattern.rows[entry] as usize] -= self.a[entry] * y;
            }
        }
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        seeds: Seeds<'_>,
        values: &mut [f64],
    ) -> std::result::Result<(), EvaluationError> {
        for j in 0..self.sizes.len() {
            let (y, yp) = match seeds {
                Seeds::Step { cj } => (1.0, cj),
                Seeds::Columns { y, yp } => (y[j], yp[j]),
            };
            for entry in self.pattern.column(j) {
                let diagonal = if self.pattern.rows[entry] as usize == j {
                    yp
                } else {
                    0.0
                };
                values[entry] = diagonal - y * self.a[entry];
            }
        }
        Ok(())
    }

    fn name(&self, unknown: usize) -> String {
        self.model.states[unknown].clone()
    }
}
