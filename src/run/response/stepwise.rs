//! A state-space model step by step, exact for an input that is constant during each step.
//!
//! The deviations x of the states, with the input w of a step as further states, satisfy `X' = M X`. Its solution after a step h is
//! `exp(M h) X`. If the input of the model is a rate, the signal reaches its value at the end of the step: by a straight line for a first
//! rate, for a second rate by the cubic of a [`Simulator`](crate::run::dynamics::simulator::Simulator).

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::state_space::StateSpace;

/// A state-space model at a time.
#[derive(Clone, Debug)]
pub struct LinearSimulator {
    model: StateSpace,
    c: DMatrix<f64>,
    /// Step size, and `exp(M h)` for it.
    step: Option<(f64, DMatrix<f64>)>,
    state: LinearState,
}

/// State of a [`LinearSimulator`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LinearState {
    /// Time [s].
    pub t: f64,
    /// Deviations of the states.
    x: Vec<f64>,
    /// Input of the model at the end of the last step.
    w: f64,
}

impl LinearSimulator {
    /// Model at its operating point, at time 0.
    pub fn new(model: StateSpace) -> Self {
        let n = model.b.len();
        Self {
            c: DMatrix::from_fn(model.d.len(), n, |row, column| model.c[row][column]),
            step: None,
            state: LinearState {
                t: 0.0,
                x: vec![0.0; n],
                w: 0.0,
            },
            model,
        }
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.state.t
    }

    /// Outputs.
    pub fn outputs(&self) -> impl Iterator<Item = f64> + '_ {
        let by_states = &self.c * DVector::from_column_slice(&self.state.x);
        let direct = self.model.z0.iter().zip(&self.model.d);
        direct
            .enumerate()
            .map(move |(k, (z0, d))| z0 + by_states[k] + d * self.state.w)
    }

    /// Simulates until a time [s], with a value of the signal.
    pub fn step(&mut self, until: f64, value: f64) {
        let h = until - self.state.t;
        let n = self.state.x.len();
        let u = value - self.model.u0;
        // input at the start of the step, and its rate
        let [w, rate] = match self.model.input_rate {
            0 => [u, 0.0],
            1 => [(u - self.state.x[n - 1]) / h, 0.0],
            _ => {
                let bend = (u - self.state.x[n - 2] - h * self.state.x[n - 1]) / (h * h);
                [4.0 * bend, -6.0 * bend / h]
            }
        };
        if self.step.as_ref().is_none_or(|(size, _)| *size != h) {
            self.step = Some((h, self.exponential(h)));
        }
        let whole = DVector::from_iterator(n + 2, self.state.x.iter().copied().chain([w, rate]));
        if let Some((_, exponential)) = &self.step {
            let end = exponential * whole;
            self.state.x.copy_from_slice(&end.as_slice()[..n]);
        }
        if let Some(place) = n
            .checked_sub(self.model.input_rate)
            .filter(|_| self.model.input_rate > 0)
        {
            self.state.x[place] = u;
        }
        self.state.w = w + h * rate;
        self.state.t = until;
    }

    /// `exp(M h)`, with the input in units that balance the norms of its column and of A.
    fn exponential(&self, h: f64) -> DMatrix<f64> {
        let n = self.state.x.len();
        let mut whole = DMatrix::zeros(n + 2, n + 2);
        for (row, values) in self.model.a.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                whole[(row, column)] = h * value;
            }
            whole[(row, n)] = h * self.model.b[row];
        }
        whole[(n, n + 1)] = h;
        let scales = balance(&mut whole);
        let mut exponential = whole.exp();
        for row in 0..n + 2 {
            for column in 0..n + 2 {
                exponential[(row, column)] *= scales[row] / scales[column];
            }
        }
        exponential
    }

    /// The state.
    pub fn save(&self) -> LinearState {
        self.state.clone()
    }

    /// Returns to a state; false if it belongs to another model.
    #[must_use]
    pub fn restore(&mut self, state: &LinearState) -> bool {
        let same = state.x.len() == self.state.x.len();
        if same {
            self.state.clone_from(state);
        }
        same
    }
}

/// Scales rows and columns by powers of two, `D^-1 M D`, until the norms of each pair are alike; returns D. Source: Parlett and Reinsch,
/// Numer. Math. 13 (1969).
fn balance(matrix: &mut DMatrix<f64>) -> Vec<f64> {
    let n = matrix.nrows();
    let mut scales = vec![1.0; n];
    let mut again = true;
    while again {
        again = false;
        for k in 0..n {
            let others = || (0..n).filter(|j| *j != k);
            let column: f64 = others().map(|j| matrix[(j, k)].abs()).sum();
            let row: f64 = others().map(|j| matrix[(k, j)].abs()).sum();
            if column == 0.0 || row == 0.0 {
                continue;
            }
            let factor = (0.5 * (row / column).log2()).round().exp2();
            if (column * factor + row / factor) < 0.95 * (column + row) {
                again = true;
                scales[k] *= factor;
                matrix.column_mut(k).scale_mut(factor);
                matrix.row_mut(k).scale_mut(1.0 / factor);
            }
        }
    }
    scales
}

#[cfg(test)]
mod tests {
    use super::{LinearSimulator, StateSpace};

    /// A damped oscillator of mass 1 kg in very different units of its states.
    fn oscillator(omega: f64, decay: f64, unit: f64) -> StateSpace {
        StateSpace {
            a: vec![vec![0.0, unit], vec![-omega * omega / unit, -2.0 * decay]],
            b: vec![0.0, 1.0 / unit],
            c: vec![vec![1.0, 0.0]],
            d: vec![0.0],
            states: vec![],
            input_rate: 0,
            x0: vec![0.0; 2],
            u0: 2.0,
            z0: vec![0.5],
            reduction: None,
        }
    }

    /// Source: step response of a damped oscillator. Goal: the solution is exact for any step size. Tolerance: rounding errors.
    #[test]
    fn steps_of_any_size_are_exact() {
        let (omega, decay) = (100.0_f64, 3.0_f64);
        let damped = (omega * omega - decay * decay).sqrt();
        let exact = |t: f64| {
            let (sin, cos) = (damped * t).sin_cos();
            0.5 + 7.0 / (omega * omega) * (1.0 - (-decay * t).exp() * (cos + decay / damped * sin))
        };
        for unit in [1.0, 1e6, 1e-7] {
            for h in [1e-4, 0.003, 0.5] {
                let mut model = LinearSimulator::new(oscillator(omega, decay, unit));
                for k in 1..=4 {
                    model.step(h * f64::from(k), 9.0);
                    let z = model.outputs().next().unwrap();
                    assert!((z - exact(h * f64::from(k))).abs() < 1e-12, "{unit} {h} {k}: {z}");
                }
            }
        }
    }

    /// Goal: a signal whose rates are the input reaches its value in each step, with continuous rate for a second rate.
    #[test]
    fn a_signal_reaches_its_value_in_a_step() {
        for rates in [1, 2] {
            let mut model = StateSpace {
                a: vec![],
                b: vec![],
                c: vec![vec![1.0; 1], vec![0.0; 1]],
                d: vec![0.0, 1.0],
                states: vec![],
                input_rate: rates,
                x0: vec![],
                u0: 1.0,
                z0: vec![1.0, 0.0],
                reduction: None,
            };
            model.append_input("u");
            let n = rates;
            model.c = vec![vec![0.0; n], vec![0.0; n]];
            model.c[0][0] = 1.0;
            model.a = (0..n)
                .map(|row| (0..n).map(|column| f64::from(u8::from(column == row + 1))).collect())
                .collect();
            let mut model = LinearSimulator::new(model);
            for (k, value) in [3.0, 2.5, 2.5, 2.5].into_iter().enumerate() {
                model.step(0.1 * (k + 1) as f64, value);
                assert!((model.outputs().next().unwrap() - value).abs() < 1e-14);
            }
            // at rest, the rate is zero
            model.step(0.5, 2.5);
            assert!(model.save().w.abs() < 1e-9, "{}", model.save().w);
            let stored = model.save();
            model.step(0.6, 0.0);
            assert!(model.restore(&stored) && model.time() == 0.5);
        }
    }
}
