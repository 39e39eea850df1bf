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

use super::LinearResponse;
use crate::error::{Code, Error, Result, SolverError, StopPoint};
use crate::sparse::Lu;

/// Fraction of the largest entry of an output's row below which an entry is rounding error.
const NOTHING: f64 = 1e-9;

/// `x' = A x + B w`, `z = C x + D w` about a state: matrices in rows, SI units.
#[derive(Clone, Debug, PartialEq)]
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
        let dynamic: Vec<bool> = (0..n)
            .map(|column| pencil.pattern.column(column).any(|e| pencil.b[e] != 0.0))
            .collect();
        let mut values = vec![0.0; pencil.a.len()];
        for (column, dynamic) in dynamic.iter().enumerate() {
            let from = if *dynamic { &pencil.b } else { &pencil.a };
            for entry in pencil.pattern.column(column) {
                values[entry] = from[entry];
            }
        }
        let fault = |what: &str| {
            Error::Solver(Box::new(SolverError {
                code: Code::NoModes,
                at: StopPoint::Time(about.at),
                what: format!("no state-space model: {what}"),
                unknown: None,
                cause: None,
                hint: None,
            }))
        };
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
        let mut states: Vec<String> = places.iter().map(|&k| about.system().layout.name(k)).collect();
        let mut x0: Vec<f64> = places.iter().map(|&k| about.y[k] * scales[k]).collect();
        let used = |k: &usize| direct.iter().any(|d| d[*k] != 0.0) || rates[*k].iter().any(|x| *x != 0.0);
        let input_rate = [2, 1].into_iter().find(used).unwrap_or(0);
        // lower rates of the input are appended to the states
        let mut b = std::mem::take(&mut rates[input_rate]);
        for (k, row) in a.iter_mut().enumerate() {
            row.extend(rates[..input_rate].iter().map(|rate| rate[k]));
        }
        c.iter_mut()
            .zip(&direct)
            .for_each(|(row, d)| row.extend(&d[..input_rate]));
        let len = places.len() + input_rate;
        for rate in 0..input_rate {
            let mut row = vec![0.0; len];
            if rate + 1 < input_rate {
                row[places.len() + rate + 1] = 1.0;
            }
            a.push(row);
            b.push(if rate + 1 == input_rate { 1.0 } else { 0.0 });
            states.push(match rate {
                0 => response.input.clone(),
                _ => format!("rate of {}", response.input),
            });
            x0.push(if rate == 0 { response.u0 } else { 0.0 });
        }
        let d = direct.iter().map(|d| d[input_rate]).collect();
        Ok(Self {
            a,
            b,
            c,
            d,
            states,
            input_rate,
            x0,
            u0: response.u0,
            z0: response.z0.clone(),
        })
    }
}
