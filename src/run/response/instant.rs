//! Derivatives of residual and outputs at one instant by the input, its rates and the state.

use std::ops::Range;

use super::motion;
use crate::dae::{BeamDae, Dae as _};
use crate::discrete::ledger;
use crate::discrete::quantities::{Extremes, ObservableRow, StateView, probes, stations};
use crate::functions::signals::Polynomial;
use crate::functions::{Signal, SmoothTime};
use crate::integrate::halt;
use crate::run::modes::Linearised;

/// Changes of the scaled residual from which the steps of an input follow.
const OF_INPUT: [f64; 8] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];
/// Steps of an opening, which lies between 0 and 1.
const OF_OPENING: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
/// Steps of a scaled unknown for the derivatives of outputs.
const OF_STATE: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
/// Largest change of the scaled residual by a valve that opens fully, that counts as rounding error.
const ROUNDING: f64 = 1e-10;
/// Irrational number whose multiples give different steps in a range of unknowns.
const GOLDEN: f64 = 0.618_033_988_749_895;
/// Ratio of successive steps.
const SHORTER: f64 = 10.0;

/// Limits of difference quotients over decreasing steps: for each component the extrapolated value that agrees best with its neighbor,
/// or 0 if it does not exceed their difference. Extrapolation removes the first-order error of a kink in a law, as of a check valve.
pub fn limits(quotients: &[Vec<f64>]) -> Vec<f64> {
    let extrapolated = |i: usize, k: usize| {
        let (long, short) = (quotients[k][i], quotients[k + 1][i]);
        (SHORTER * short - long) / (SHORTER - 1.0)
    };
    let of = |i: usize| {
        let all = (0..quotients.len() - 2).map(|k| {
            let value = extrapolated(i, k + 1);
            ((value - extrapolated(i, k)).abs(), value)
        });
        let finite = all.filter(|(apart, _)| apart.is_finite());
        match finite.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((apart, value)) if value.abs() > apart => value,
            Some(_) => 0.0,
            None => f64::NAN,
        }
    };
    (0..quotients[0].len()).map(of).collect()
}

/// A state at an instant, with an input that can be varied about its signal.
pub struct Instant<'a> {
    dae: &'a mut BeamDae,
    /// Time [s]. At 0 a polynomial of the input has its value without rounding.
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    places: Vec<usize>,
    signal: Signal,
    /// Value of the input. `opens` is true if it is an opening, which is limited to 0 to 1.
    value: f64,
    opens: bool,
    rows: [ObservableRow; 2],
    integrals: Vec<f64>,
    /// Unknowns, and rates, on which the outputs of [`Instant::rows`] depend.
    known: [Vec<usize>; 2],
}

impl<'a> Instant<'a> {
    /// A linearized state at rest; all signals are constant.
    pub fn at_rest(about: &'a mut Linearised, places: Vec<usize>, value: f64, opens: bool) -> Self {
        about.dae.enter_smooth_interval(0.0);
        let mut instant = Self::new(&mut about.dae, places, Signal::Constant(value), opens);
        instant.enter(0.0, [&about.y, &vec![0.0; about.y.len()]]);
        instant
    }

    pub fn new(dae: &'a mut BeamDae, places: Vec<usize>, signal: Signal, opens: bool) -> Self {
        let system = dae.system();
        let probed = probes::columns(system).count();
        let rows = [
            ObservableRow::new(motion(system), [stations::columns(system, true).len(), probed]),
            ObservableRow::new(vec![], [stations::columns(system, false).len(), 0]),
        ];
        Self {
            t: 0.0,
            y: vec![],
            yp: vec![],
            integrals: vec![0.0; dae.integrals()],
            dae,
            places,
            value: signal.value(0.0),
            signal,
            opens,
            rows,
            known: [vec![], vec![]],
        }
    }

    /// Sets `c_j` of the steps [1/s], which the equations are formulated for.
    pub fn approach(&mut self, cj: f64) {
        self.dae.approach(cj);
    }

    /// Moves to a state with its rates at a time [s].
    pub fn enter(&mut self, t: f64, [y, yp]: [&[f64]; 2]) {
        (self.t, self.y, self.yp) = (t, y.to_vec(), yp.to_vec());
        self.value = self
            .signal
            .jet(SmoothTime {
                t,
                within: self.dae.within(),
            })
            .value;
    }

    /// Adds `x (τ - t)^k/k!` to the input at times τ.
    fn put(&mut self, k: usize, x: f64) {
        let t = self.t;
        let coefficients = match k {
            0 => vec![x],
            1 => vec![-x * t, x],
            _ => vec![0.5 * x * t * t, -x * t, 0.5 * x],
        };
        let added = Signal::Polynomial(Polynomial { coefficients });
        self.dae
            .put_signal(&self.places, &Signal::Sum(vec![self.signal.clone(), added]));
    }

    fn residual(&mut self) -> Vec<f64> {
        let mut values = vec![0.0; self.y.len()];
        // if the residual cannot be evaluated, the derivative and the solution are not finite
        if self.dae.residual(self.t, &self.y, &self.yp, &mut values).is_err() {
            values.fill(f64::NAN);
        }
        values
    }

    pub fn outputs(&mut self) -> Vec<f64> {
        let (system, now, state) = self.dae.evaluate(self.t, &self.y, &self.yp);
        let look = StateView {
            system,
            now,
            w: state,
            stored: ledger::energies(system, now, state),
            at: Extremes::new(system, now, &state),
        };
        let [first, second] = &mut self.rows;
        first.take(self.t, &look, &[], 0.0);
        second.take(self.t, &look, &self.integrals, 0.0);
        first.values().iter().chain(second.values()).copied().collect()
    }

    /// Derivatives of `read` by the input and its first two rates.
    fn derivatives(&mut self, read: fn(&mut Self) -> Vec<f64>) -> [Vec<f64>; 3] {
        [0, 1, 2].map(|k| {
            let found = match self.opens {
                true => self.one_sided(k, read),
                false => self.central(k, read),
            };
            self.put(0, 0.0);
            found
        })
    }

    /// One-sided derivatives towards the middle of the range of an opening, to second order.
    fn one_sided(&mut self, k: usize, read: fn(&mut Self) -> Vec<f64>) -> Vec<f64> {
        let towards = if self.value > 0.5 { -1.0 } else { 1.0 };
        let quotients = OF_OPENING.map(|size| {
            let step = towards * size;
            let [none, one, two] = [0.0, step, 2.0 * step].map(|x| {
                self.put(k, x);
                read(self)
            });
            let all = none.iter().zip(&one).zip(&two);
            // differences first: without influence they are exactly zero
            all.map(|((none, one), two)| (4.0 * (one - none) - (two - none)) / (2.0 * step))
                .collect()
        });
        limits(&quotients)
    }

    fn central(&mut self, k: usize, read: fn(&mut Self) -> Vec<f64>) -> Vec<f64> {
        let change = self.change(k);
        let unit = if change == 0.0 { 1.0 } else { 1.0 / change };
        let largest = OF_INPUT[0] * unit;
        let [before, after] = [-largest, largest].map(|x| {
            self.put(k, x);
            read(self)
        });
        if before == after {
            return vec![0.0; before.len()];
        }
        let quotients = OF_INPUT.map(|size| {
            let step = size * unit;
            let [before, after] = [-step, step].map(|x| {
                self.put(k, x);
                read(self)
            });
            quotient(&before, &after, step)
        });
        limits(&quotients)
    }

    /// Largest change of the scaled residual by a unit of the input, or of one of its rates.
    fn change(&mut self, k: usize) -> f64 {
        let [none, one] = [0.0, 1.0].map(|x| {
            self.put(k, x);
            self.residual()
        });
        none.iter().zip(&one).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
    }

    pub fn derivatives_of_residual(&mut self) -> [Vec<f64>; 3] {
        let mut found = self.derivatives(Self::residual);
        let largest = found.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        if self.opens && largest <= ROUNDING {
            found.iter_mut().for_each(|rate| rate.fill(0.0));
        }
        found
    }

    pub fn derivatives_of_outputs(&mut self, chosen: &[usize]) -> Vec<[f64; 3]> {
        let all = self.derivatives(Self::outputs);
        chosen
            .iter()
            .map(|&place| [0, 1, 2].map(|k: usize| all[k][place]))
            .collect()
    }

    /// Rows of C and D.
    pub fn rows(&mut self, chosen: &[usize]) -> Vec<[Vec<f64>; 2]> {
        let n = self.y.len();
        let mut rows = vec![[vec![0.0; n], vec![0.0; n]]; chosen.len()];
        for rate in [false, true] {
            let mut known = std::mem::take(&mut self.known[usize::from(rate)]);
            // most outputs depend on few unknowns: ranges without influence are omitted, others halved
            let mut ranges: Vec<Range<usize>> = std::iter::once(0..n).collect();
            // the first solution reports an interrupted response
            while let Some(range) = ranges.pop().filter(|_| !halt::asked()) {
                let first = self.over(&range, rate, OF_STATE[0], chosen, &known);
                if first.iter().all(|x| *x == 0.0) {
                    continue;
                }
                if range.len() > 1 {
                    let middle = range.start + range.len() / 2;
                    ranges.extend([range.start..middle, middle..range.end]);
                    continue;
                }
                known.push(range.start);
            }
            for &unknown in &known {
                let quotients = OF_STATE.map(|step| self.over(&(unknown..unknown + 1), rate, step, chosen, &[]));
                for (row, limit) in rows.iter_mut().zip(limits(&quotients)) {
                    row[usize::from(rate)][unknown] = limit;
                }
            }
            self.known[usize::from(rate)] = known;
        }
        rows
    }

    /// Difference quotients of the chosen outputs over a range of unknowns, or of their rates. In a longer range the steps differ, so
    /// that no influences cancel. Some unknowns may be left out.
    fn over(&mut self, range: &Range<usize>, rate: bool, step: f64, chosen: &[usize], without: &[usize]) -> Vec<f64> {
        let [before, after] = [-step, step].map(|x| {
            let state = if rate { &mut self.yp } else { &mut self.y };
            let own = state[range.clone()].to_vec();
            for (k, value) in state[range.clone()].iter_mut().enumerate() {
                if !without.contains(&(range.start + k)) {
                    *value += x / (1.0 + (GOLDEN * k as f64).fract());
                }
            }
            let values = self.outputs();
            let state = if rate { &mut self.yp } else { &mut self.y };
            state[range.clone()].copy_from_slice(&own);
            chosen.iter().map(|&place| values[place]).collect::<Vec<_>>()
        });
        quotient(&before, &after, step)
    }
}

fn quotient(before: &[f64], after: &[f64], step: f64) -> Vec<f64> {
    let all = before.iter().zip(after);
    all.map(|(before, after)| (after - before) / (2.0 * step)).collect()
}
