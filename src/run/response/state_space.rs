//! State-space models of small motions: the linear equations of [`Response`](super::response::Response), solved for rates.
//!
//! `[E82]` Unknowns d are those whose rates appear; the others, a, are algebraic (index one):
//!
//! ```text
//! A y + B y' + f_0 u + f_1 u' + f_2 u'' = 0        [B_d  A_a] [d'; a] = -(A_d d + f_0 u + f_1 u' + f_2 u'')
//! d' = M d + N u        z = C d + D u
//! ```
//!
//! If rates of an input appear, as for a moved end or a volume, the input of the model is the highest of them. The lower ones are
//! further states.

use serde::{Deserialize, Serialize};

use super::LinearResponse;
use crate::error::Result;
use crate::sparse::Lu;
use crate::spectral::Pencil;

/// Fraction of the largest entry of an output's row below which an entry is rounding error.
const NOTHING: f64 = 1e-9;

/// `x' = A x + B w`, `z = C x + D w` about a state: matrices in rows, SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StateSpace {
    /// `A`, one row for each state.
    pub a: Vec<Vec<f64>>,
    /// `B`.
    pub b: Vec<f64>,
    /// `C`, one row for each output.
    pub c: Vec<Vec<f64>>,
    /// `D`.
    pub d: Vec<f64>,
    /// Names of the states, with units.
    pub states: Vec<String>,
    /// Rate of the signal that is the input: 0 its value, 1 or 2.
    pub input_rate: usize,
    /// States at the operating point.
    pub x0: Vec<f64>,
    /// Value of the signal at the operating point.
    pub u0: f64,
    /// Outputs at the operating point.
    pub z0: Vec<f64>,
    /// Accuracy of a reduced model; none if the model has all states.
    pub reduction: Option<ModelReduction>,
}

/// Accuracy of a model with fewer states than the equations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelReduction {
    /// First and last frequency [Hz].
    pub band: [f64; 2],
    /// Largest error over the band, relative to the amplitude or, if it is larger, to the median amplitude over the band.
    pub error: f64,
    /// True if the gain at s = 0 is that of the response; false if the response has none.
    pub static_gain: bool,
    /// Modes in the band, and those of them that are poles of the model.
    pub modes: [usize; 2],
    /// Number of frequencies at which the equations were solved.
    pub solved: usize,
}

impl StateSpace {
    /// State-space model of a linear response.
    ///
    /// # Errors
    /// The equations cannot be solved for rates, or an output is the rate of an unknown without inertia.
    pub fn new(response: &LinearResponse) -> Result<Self> {
        let about = &response.about;
        let pencil = about.pencil();
        let n = about.y.len();
        let dynamic = dynamic(&pencil);
        let mut values = vec![0.0; pencil.a.len()];
        for (column, dynamic) in dynamic.iter().enumerate() {
            let from = if *dynamic { &pencil.b } else { &pencil.a };
            for entry in pencil.pattern.column(column) {
                values[entry] = from[entry];
            }
        }
        let fault = |what: &str| response.no_model(what);
        let mut lu = Lu::sparse(pencil.pattern).map_err(|_| fault("the equations cannot be analysed"))?;
        lu.factor(&values)
            .map_err(|_| fault("the equations cannot be solved for rates"))?;
        // rates of dynamic unknowns and values of the others, for each state and for the input and its rates
        let mut solved = |rhs: &mut Vec<f64>| {
            rhs.iter_mut().for_each(|x| *x = -*x);
            lu.solve(rhs);
        };
        let places: Vec<usize> = (0..n).filter(|k| dynamic[*k]).collect();
        let mut by_state = vec![];
        for &column in &places {
            let mut rhs = vec![0.0; n];
            for entry in pencil.pattern.column(column) {
                rhs[pencil.pattern.rows[entry] as usize] += pencil.a[entry];
            }
            solved(&mut rhs);
            by_state.push(rhs);
        }
        let mut by_input = response.forcing.clone();
        by_input.iter_mut().for_each(&mut solved);
        let scales = &about.system().layout.scales;
        let own = |k: usize| scales[places[k]];
        let mut a: Vec<Vec<f64>> = (0..places.len())
            .map(|row| {
                (0..places.len())
                    .map(|column| own(row) * by_state[column][places[row]] / own(column))
                    .collect()
            })
            .collect();
        let of_input = |k: usize| -> Vec<f64> { places.iter().map(|&row| scales[row] * by_input[k][row]).collect() };
        let mut rates = [of_input(0), of_input(1), of_input(2)];
        let mut c = vec![];
        let mut direct = vec![];
        for ([of_state, of_rate], direct_) in response.of_state.iter().zip(&response.direct) {
            let largest = of_rate.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            if (0..n).any(|k| !dynamic[k] && of_rate[k].abs() > NOTHING * largest) {
                return Err(fault("an output is the rate of an algebraic unknown"));
            }
            // z = C_d d + C_a a + D_d d'
            let part = |by: &[f64]| -> f64 {
                let all = (0..n).map(|k| by[k] * if dynamic[k] { of_rate[k] } else { of_state[k] });
                all.sum()
            };
            let row = |k: usize| (of_state[places[k]] + part(&by_state[k])) / own(k);
            c.push((0..places.len()).map(row).collect::<Vec<f64>>());
            direct.push([0, 1, 2].map(|k: usize| direct_[k] + part(&by_input[k])));
        }
        let states: Vec<String> = places.iter().map(|&k| about.system().layout.name(k)).collect();
        let x0: Vec<f64> = places.iter().map(|&k| about.y[k] * scales[k]).collect();
        let input_rate = response.input_rate();
        // lower rates of the input are appended to the states
        let b = std::mem::take(&mut rates[input_rate]);
        for (k, row) in a.iter_mut().enumerate() {
            row.extend(rates[..input_rate].iter().map(|rate| rate[k]));
        }
        c.iter_mut()
            .zip(&direct)
            .for_each(|(row, d)| row.extend(&d[..input_rate]));
        let mut model = Self {
            a,
            b,
            c,
            d: direct.iter().map(|d| d[input_rate]).collect(),
            states,
            input_rate,
            x0,
            u0: response.u0,
            z0: response.z0.clone(),
            reduction: None,
        };
        model.append_input(&response.input);
        Ok(model)
    }

    /// Completes a model whose rows of A have a column for each lower rate of the input: appends these rates to the states.
    pub fn append_input(&mut self, input: &str) {
        let (rates, own) = (self.input_rate, self.a.len());
        for rate in 0..rates {
            let mut row = vec![0.0; own + rates];
            if rate + 1 < rates {
                row[own + rate + 1] = 1.0;
            }
            self.a.push(row);
            self.b.push(if rate + 1 == rates { 1.0 } else { 0.0 });
            self.states.push(match rate {
                0 => input.to_owned(),
                _ => format!("rate of {input}"),
            });
            self.x0.push(if rate == 0 { self.u0 } else { 0.0 });
        }
    }
}

/// True for each unknown whose rate appears: those of the states, in their order.
pub(super) fn dynamic(pencil: &Pencil) -> Vec<bool> {
    let appears = |column: usize| pencil.pattern.column(column).any(|entry| pencil.b[entry] != 0.0);
    (0..pencil.pattern.columns()).map(appears).collect()
}
