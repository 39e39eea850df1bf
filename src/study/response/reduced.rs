//! Reduced state-space models: few poles that reproduce a response over a band.

use nalgebra::{Complex, DMatrix, DVector};

use super::approximation::ApproximatedResponse;
use super::{BESIDE, Poles};
use crate::error::Result;
use crate::error::numbers::{error_percent, significant};
use crate::numerics::rational::{AxisSamples, RationalFit, relative_error};
use crate::run::response::LinearResponse;
use crate::run::response::state_space::{ModelReduction, StateSpace};

type C = Complex<f64>;

/// Error of the approximation that stands for the response, over the permitted error of the model; its smallest value.
const REFERENCE: f64 = 0.05;
const LEAST: f64 = 1e-7;
/// Errors of the fits whose poles are tried, over the permitted error of the model.
const TRIED: [f64; 4] = [0.5, 0.2, 0.08, 0.03];
/// Distance of a pole from a mode up to which it is that mode, over the growth rate of the mode, and over its frequency.
const SAME: [f64; 2] = [0.2, 1e-6];
/// Modulus of a pole, over the last frequency of the band, above which it is part of the direct transmission.
const FAST: f64 = 50.0;
/// Smallest damping ratio of a pole that no growing mode confirms.
const STABLE: f64 = 1e-7;
/// Relative distances from a mode without damping, and ratio of responses there from which on an output shows its infinite peak.
const CLOSE: f64 = 1e-7;
const BESIDE_PEAK: f64 = 1e-2;
const INFINITE: f64 = 1e3;
/// Samples of the band at which models are compared.
const DENSE: usize = 300;

/// `[E95]` Partial fractions with the poles p of the model, in real blocks, and the static gain H(0) if there is one:
///
/// ```text
/// H(s) ≈ H(0) + Σ r [φ(s) - φ(0)] + Σ e_k s^k        q' = p q + |p| u        φ = |p|/(s - p)        k ≤ highest rate of u
/// ```
struct PartialFractions {
    /// Poles; of a conjugate pair the one with positive imaginary part.
    poles: Vec<C>,
    /// Coefficients of each output: two of each pair, one of each real pole, then those of `s^k` from k = 0.
    coefficients: Vec<Vec<f64>>,
    error: f64,
}

/// Reduces a response to a model whose error over a band [Hz] is at most `asked`. `found` are the modes of the case; those that the
/// outputs show are added.
///
/// # Errors
/// Outputs show a mode in the band that has no damping; no model has this error; those of [`ApproximatedResponse::new`].
pub fn reduce(response: &LinearResponse, band: [f64; 2], found: &mut Poles, asked: f64) -> Result<StateSpace> {
    let modes: Vec<C> = found.poles.iter().map(|pole| pole.s).collect();
    for mode in modes.iter().filter(|mode| mode.re == 0.0) {
        let hz = mode.im / std::f64::consts::TAU;
        let mut solver = response.solver()?;
        let [near, beside] = [CLOSE, BESIDE_PEAK].map(|by| solver.at(hz * (1.0 + by)));
        let infinite = |(near, beside): (&C, &C)| near.norm() > INFINITE * beside.norm();
        if near?.iter().zip(&beside?).any(infinite) {
            return Err(response.no_model(&format!(
                "the mode at {} Hz has no damping, so that its peak is infinite. Use damping (/beam/damping) or a band without it (--from, --to)",
                significant(hz, 5)
            )));
        }
    }
    let reference = ApproximatedResponse::new(response, band, &modes, (REFERENCE * asked).max(LEAST))?;
    found.complete(response, &reference, band);
    if reference.medians.iter().all(|median| *median == 0.0) {
        return Err(response.no_model("the outputs do not respond to the input"));
    }
    let modes: Vec<C> = found.poles.iter().map(|pole| pole.s).collect();
    let data = dense(&reference, band, &modes);
    let permitted = asked - reference.error;
    let mut least = f64::INFINITY;
    let known: Vec<C> = modes.iter().chain(&found.growing).copied().collect();
    let last = std::f64::consts::TAU * band[1];
    let rates = response.input_rate();
    for part in TRIED {
        let fit = RationalFit::new(&reference.samples, &reference.medians, part * asked);
        let poles = fit
            .poles()
            .into_iter()
            .filter(|p| p.im >= 0.0 && p.norm() < FAST * last);
        let mut poles: Vec<C> = poles.collect();
        settle(&mut poles, &known);
        let whole = PartialFractions::new(poles, &data, &reference.medians, rates);
        least = least.min(whole.error + reference.error);
        if whole.error > permitted {
            continue;
        }
        let fractions = whole.pruned(&data, &reference.medians, rates, permitted);
        let kept = modes.iter().filter(|mode| fractions.poles.contains(mode)).count();
        let reduction = ModelReduction {
            band,
            error: fractions.error + reference.error,
            static_gain: data.omega[0] == 0.0,
            modes: [modes.len(), kept],
            solved: reference.samples.omega.len(),
        };
        return Ok(fractions.model(response, reduction));
    }
    Err(response.no_model(&format!(
        "the smallest error over the band is {}, above --error. Use a larger --error or a narrower band (--from, --to)",
        error_percent(least)
    )))
}

/// Values of a response on a dense grid, at its samples and near its modes.
fn dense(reference: &ApproximatedResponse, band: [f64; 2], modes: &[C]) -> AxisSamples {
    let [from, to] = band.map(|hz| std::f64::consts::TAU * hz);
    let grid = (0..=DENSE).map(|k| from * (to / from).powf(k as f64 / DENSE as f64));
    let mut omega: Vec<f64> = reference.samples.omega.iter().copied().chain(grid).collect();
    for mode in modes {
        omega.extend(BESIDE.map(|by| mode.im + by * mode.re.abs()));
    }
    omega.retain(|omega| *omega == 0.0 || (from..=to).contains(omega));
    omega.sort_by(f64::total_cmp);
    omega.dedup();
    AxisSamples {
        values: omega.iter().map(|omega| reference.fit.at(*omega)).collect(),
        omega,
    }
}

/// Replaces poles by the modes that they approximate; reflects the other growing ones.
fn settle(poles: &mut [C], modes: &[C]) {
    let mut free: Vec<usize> = (0..poles.len()).collect();
    for mode in modes {
        let far = |k: usize| (poles[k] - mode).norm();
        let nearest = free
            .iter()
            .copied()
            .enumerate()
            .min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
        if let Some((place, k)) = nearest.filter(|(_, k)| far(*k) <= SAME[0] * mode.re.abs() + SAME[1] * mode.norm()) {
            poles[k] = *mode;
            free.swap_remove(place);
        }
    }
    for k in free {
        poles[k].re = -poles[k].re.abs().max(STABLE * poles[k].im);
    }
}

impl PartialFractions {
    /// Values of the functions at s, two of each conjugate pair: those of the states of its block for a unit input.
    fn functions(poles: &[C], s: C) -> Vec<C> {
        let mut all = vec![];
        for p in poles {
            let size = if p.norm() > 0.0 { p.norm() } else { 1.0 };
            if p.im == 0.0 {
                all.push(size / (s - p.re));
            } else {
                let below = (s - p) * (s - p.conj());
                all.extend([size * (s - p.re) / below, -size * p.im / below]);
            }
        }
        all
    }

    /// Least squares over samples, with the gain at 0 if it is among them.
    fn new(poles: Vec<C>, data: &AxisSamples, medians: &[f64], rates: usize) -> Self {
        let gain = data
            .omega
            .first()
            .filter(|omega| **omega == 0.0)
            .map(|_| &data.values[0]);
        let at_rest = gain.map(|_| Self::functions(&poles, C::default()));
        let last = data.omega.last().copied().unwrap_or(1.0);
        let row = |s: C| -> Vec<C> {
            let mut row = Self::functions(&poles, s);
            if let Some(at_rest) = &at_rest {
                row.iter_mut().zip(at_rest).for_each(|(own, rest)| *own -= rest);
            } else {
                row.push(C::from(1.0));
            }
            row.extend((1..=rates).map(|k| (s / last).powi(k as i32)));
            row
        };
        let rows: Vec<Vec<C>> = data.omega.iter().map(|omega| row(C::new(0.0, *omega))).collect();
        let columns = rows.first().map_or(0, Vec::len);
        let mut coefficients = vec![];
        let mut values = vec![vec![C::default(); medians.len()]; rows.len()];
        for (p, median) in medians.iter().enumerate() {
            let rest = gain.map_or(C::default(), |gain| gain[p]);
            // an output that does not respond has no weight
            let weight = |k: usize| match data.values[k][p].norm().max(*median) {
                0.0 => 0.0,
                size => 1.0 / size,
            };
            let part = |i: usize, x: C| if i.is_multiple_of(2) { x.re } else { x.im };
            let mut matrix = DMatrix::from_fn(2 * rows.len(), columns, |i, j| weight(i / 2) * part(i, rows[i / 2][j]));
            let scales: Vec<f64> = matrix
                .column_iter()
                .map(|column| column.norm().max(f64::MIN_POSITIVE))
                .collect();
            for (mut column, scale) in matrix.column_iter_mut().zip(&scales) {
                column /= *scale;
            }
            let mut right = DVector::from_fn(2 * rows.len(), |i, _| {
                weight(i / 2) * part(i, data.values[i / 2][p] - rest)
            });
            let solved = (columns > 0).then(|| {
                let qr = matrix.qr();
                qr.q_tr_mul(&mut right);
                qr.r().svd(true, true).solve(&right.rows(0, columns), 1e-13).ok()
            });
            let scaled = solved
                .flatten()
                .unwrap_or_else(|| DVector::from_element(columns, f64::NAN));
            let own: Vec<f64> = scaled.iter().zip(&scales).map(|(x, scale)| x / scale).collect();
            for (row, values) in rows.iter().zip(&mut values) {
                values[p] = rest + row.iter().zip(&own).map(|(f, x)| f * *x).sum::<C>();
            }
            coefficients.push(own);
        }
        let errors = values.iter().zip(&data.values);
        let error = errors
            .map(|(found, exact)| relative_error(found, exact, medians))
            .fold(0.0, f64::max);
        for (p, own) in coefficients.iter_mut().enumerate() {
            let higher = own.split_off(columns - rates);
            if let (Some(gain), Some(at_rest)) = (gain, &at_rest) {
                own.push(gain[p].re - own.iter().zip(at_rest).map(|(x, rest)| x * rest.re).sum::<f64>());
            }
            own.extend(higher.iter().zip(1..).map(|(x, k)| x / last.powi(k)));
        }
        Self {
            poles,
            coefficients,
            error,
        }
    }

    /// Removes poles, the least visible first, while the error is permitted.
    fn pruned(self, data: &AxisSamples, medians: &[f64], rates: usize, permitted: f64) -> Self {
        let mut best = self;
        loop {
            let fewer = (0..best.poles.len()).map(|k| {
                let mut poles = best.poles.clone();
                poles.remove(k);
                Self::new(poles, data, medians, rates)
            });
            match fewer.min_by(|a, b| a.error.total_cmp(&b.error)) {
                Some(smaller) if smaller.error <= permitted => best = smaller,
                _ => return best,
            }
        }
    }

    fn model(self, response: &LinearResponse, reduction: ModelReduction) -> StateSpace {
        let input_rate = response.input_rate();
        let blocks = self.poles.iter().map(|p| if p.im == 0.0 { 1 } else { 2 });
        let n: usize = blocks.sum();
        let mut model = StateSpace {
            a: vec![vec![0.0; n + input_rate]; n],
            b: vec![0.0; n],
            c: self.coefficients,
            d: vec![],
            states: vec![],
            input_rate,
            x0: vec![0.0; n],
            u0: response.u0,
            z0: response.z0.clone(),
            reduction: Some(reduction),
        };
        for (k, p) in self.poles.iter().enumerate() {
            let at = model.states.len();
            let size = if p.norm() > 0.0 { p.norm() } else { 1.0 };
            model.a[at][at] = p.re;
            // the input is a state if the model has one of its rates as input
            if input_rate > 0 {
                model.a[at][n] = size;
            } else {
                model.b[at] = size;
            }
            if p.im == 0.0 {
                model.states.push(format!("mode {}", k + 1));
            } else {
                model.a[at][at + 1] = p.im;
                model.a[at + 1][at] = -p.im;
                model.a[at + 1][at + 1] = p.re;
                model
                    .states
                    .extend(["re", "im"].map(|part| format!("mode {} {part}", k + 1)));
            }
        }
        model.d = model.c.iter_mut().filter_map(Vec::pop).collect();
        model.append_input(&response.input);
        model
    }
}
