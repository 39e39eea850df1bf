//! Solution of the stages by a simplified Newton iteration, and the error estimate.
//!
//! A stage's own unknowns are `x`: the rate `K` if differential, the value if algebraic. `base` is the part of `Y` given by the previous
//! stages: `Y = base + s x`, `s = h γ` or 1. A correction `δ` of `Y` is the correction `δ/s` of `x`, so that rates are never differences
//! of values.

use super::equations::StageError;
use super::integrator::OneStep;
use super::polynomial;
use super::tableau;
use crate::dae::Dae;
use crate::numerics::kernels::{self, TILE, weighted_square};
use crate::numerics::threads::{LARGE, both};
use crate::numerics::wide;

/// Maximum number of iterations in one stage.
const ITERATIONS: usize = 7;
/// Ratio to the last step below which a step is short.
const SHORT: f64 = 0.1;
/// Maximum number of matrix renewals during an iteration.
const RENEWALS: usize = 2;
/// Contraction rate above which an iteration is abandoned.
const DIVERGING: f64 = 0.9;
/// Number of nodes of the polynomial that predicts a stage.
const PREDICTOR_NODES: usize = 3;

/// Maximum number of vectors in one sum.
const TERMS: usize = tableau::STAGES + 1;

/// Factors and vectors of a sum.
type Terms<'a> = [(f64, &'a [f64]); TERMS];

/// Stages of one step.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// Time at the beginning of the step [s].
    pub t: f64,
    /// Size of the step [s]; 0 before the first.
    pub h: f64,
    /// Rates of differential, values of algebraic unknowns, at every stage.
    pub x: Vec<Vec<f64>>,
    /// Values of all unknowns at every stage.
    pub y: Vec<Vec<f64>>,
}

impl Stages {
    pub fn new(stages: usize, n: usize) -> Self {
        let zeros = vec![vec![0.0; n]; stages];
        Self {
            t: 0.0,
            h: 0.0,
            x: zeros.clone(),
            y: zeros,
        }
    }
}

/// Work vectors.
#[derive(Clone, Debug)]
pub(super) struct Work {
    /// Part of a stage's values that is given by the previous stages, for differential unknowns.
    pub base: Vec<f64>,
    /// Rates, 0 for algebraic unknowns.
    pub yp: Vec<f64>,
    /// Residual, then correction; after a step, its estimated error.
    pub r: Vec<f64>,
    /// Weights of the error norm.
    pub weights: Vec<f64>,
}

impl Work {
    pub fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Self {
            base: zeros(),
            yp: zeros(),
            r: zeros(),
            weights: zeros(),
        }
    }
}

/// `out += factor v`.
pub(super) fn add(out: &mut [f64], factor: f64, v: &[f64]) {
    for (out, v) in out.iter_mut().zip(v) {
        *out += factor * v;
    }
}

/// Weighted root mean square of the entries.
fn norm(v: &[f64], weights: &[f64]) -> f64 {
    (weighted_square(v, weights) / v.len() as f64).sqrt()
}

/// `f` for a differential unknown, 1 for an algebraic one; `mask` is 1 or 0.
#[inline(always)]
fn or_one(mask: f64, f: f64) -> f64 {
    mask * f + (1.0 - mask)
}

/// Arrays that a correction reads or changes, or parts of them.
struct Corrected<'a> {
    x: &'a mut [f64],
    y: &'a mut [f64],
    yp: &'a mut [f64],
    r: &'a mut [f64],
    base: &'a [f64],
    mask: &'a [f64],
    weights: &'a [f64],
}

impl<'a> Corrected<'a> {
    /// Splits the arrays at entry `k`.
    fn split_at(self, k: usize) -> [Self; 2] {
        let (x, y) = (self.x.split_at_mut(k), self.y.split_at_mut(k));
        let (yp, r) = (self.yp.split_at_mut(k), self.r.split_at_mut(k));
        let (base, mask) = (self.base.split_at(k), self.mask.split_at(k));
        let weights = self.weights.split_at(k);
        let part = |x, y, yp, r, [base, mask, weights]: [&'a [f64]; 3]| Self {
            x,
            y,
            yp,
            r,
            base,
            mask,
            weights,
        };
        [
            part(x.0, y.0, yp.0, r.0, [base.0, mask.0, weights.0]),
            part(x.1, y.1, yp.1, r.1, [base.1, mask.1, weights.1]),
        ]
    }

    /// Corrects unknowns, values and rates; returns the weighted square of the correction.
    fn by(self, factors: [f64; 2], step: f64) -> f64 {
        let n = self.r.len();
        if n < LARGE {
            return self.tile_by_tile(factors, step);
        }
        let [left, right] = self.split_at(kernels::halfway(n));
        let (left, right) = both(
            || left.tile_by_tile(factors, step),
            || right.tile_by_tile(factors, step),
        );
        left + right
    }

    /// Processes tiles: written data stay in the first-level cache until they are read again.
    fn tile_by_tile(mut self, factors: [f64; 2], step: f64) -> f64 {
        let mut square = 0.0;
        while !self.r.is_empty() {
            let [tile, rest] = {
                let k = self.r.len().min(TILE);
                self.split_at(k)
            };
            wide!(correct(tile.x, tile.r, tile.mask, factors));
            values(tile.x, tile.base, tile.mask, step, [tile.y, tile.yp]);
            square += weighted_square(tile.r, tile.weights);
            self = rest;
        }
        square
    }
}

/// Scales `r` to the correction of the values, and adds the corresponding correction to `x`: `∂x/∂Y` is `cj` or 1.
#[inline(always)] // three slices that the compiler knows to be apart
fn correct(x: &mut [f64], r: &mut [f64], mask: &[f64], [factor, cj]: [f64; 2]) {
    for ((x, r), mask) in x.iter_mut().zip(r).zip(mask) {
        *r *= factor;
        *x += or_one(*mask, cj) * *r;
    }
}

/// `Y = base + s x` with `s = h γ` for differential and `Y = x` for algebraic unknowns; rates of differential unknowns,
/// 0 for algebraic ones.
#[inline(always)]
fn values_of(x: &[f64], base: &[f64], mask: &[f64], step: f64, [y, yp]: [&mut [f64]; 2]) {
    for (((y, yp), (x, base)), mask) in y.iter_mut().zip(yp).zip(x.iter().zip(base)).zip(mask) {
        *y = mask * base + or_one(*mask, step) * x;
        *yp = mask * x;
    }
}

/// Like `values_of`, but in wide vectors, and shared by two threads if the vectors are long.
pub(super) fn values(x: &[f64], base: &[f64], mask: &[f64], step: f64, [y, yp]: [&mut [f64]; 2]) {
    if x.len() < LARGE {
        return wide!(values_of(x, base, mask, step, [y, yp]));
    }
    let half = kernels::halfway(x.len());
    let ((left_y, right_y), (left_yp, right_yp)) = (y.split_at_mut(half), yp.split_at_mut(half));
    both(
        || values(&x[..half], &base[..half], &mask[..half], step, [left_y, left_yp]),
        || values(&x[half..], &base[half..], &mask[half..], step, [right_y, right_yp]),
    );
}

impl<D: Dae> OneStep<D> {
    /// Attempts a step of size `h` that ends at `t1` [s]; returns its error relative to the tolerance.
    pub(super) fn attempt(&mut self, h: f64, t1: f64) -> Result<f64, StageError> {
        let cj = 1.0 / (h * self.tableau.gamma());
        self.matrix.begin(cj);
        (self.now.t, self.now.h) = (self.time, h);
        self.equations.dae.approach(cj);
        for i in 1..self.tableau.stages {
            let last = self.tableau.c[i] == 1.0;
            let t = if last { t1 } else { self.time + self.tableau.c[i] * h };
            self.lay_base(i);
            self.predict(i);
            match self.newton(i, t, cj) {
                // a failure with old factors is repeated with new ones
                Err(StageError::Newton | StageError::Recoverable(_)) if !self.matrix.fresh => {
                    self.matrix.stale = true;
                    self.predict(i);
                    self.newton(i, t, cj)?;
                }
                other => other?,
            }
        }
        self.estimate(t1, cj)
    }

    /// Computes `yₙ + h Σ_{j<i} aᵢⱼ Kⱼ`.
    fn lay_base(&mut self, i: usize) {
        let now = &self.now;
        let mut terms: Terms = [(1.0, &now.y[0]); TERMS];
        let mut count = 1;
        for j in (0..i).filter(|&j| self.tableau.a[i][j] != 0.0) {
            terms[count] = (now.h * self.tableau.a[i][j], &now.x[j]);
            count += 1;
        }
        kernels::combine(&mut self.work.base, &terms[..count]);
    }

    /// Predicts stage `i` by the polynomial through previous stages, including those of the last step.
    fn predict(&mut self, i: usize) {
        let (tableau, last) = (&self.tableau, &self.last);
        let mut nodes = [0.0; polynomial::NODES];
        let mut sources: [(bool, usize); polynomial::NODES] = [(false, 0); polynomial::NODES];
        let mut count = 0;
        let mut push = |node: f64, source: (bool, usize)| {
            if count < PREDICTOR_NODES {
                (nodes[count], sources[count]) = (node, source);
                count += 1;
            }
        };
        for j in (0..i).rev() {
            push(tableau.c[j], (false, j));
        }
        if last.h > 0.0 {
            let ratio = last.h / self.now.h;
            // the last stage of the last step is the first of this one
            for &j in tableau.nodes.iter().rev().skip(1) {
                push((tableau.c[j] - 1.0) * ratio, (true, j));
            }
        }
        let weights = polynomial::value(&nodes[..count], tableau.c[i]);
        let (before, rest) = self.now.x.split_at_mut(i);
        let mut terms: Terms = [(0.0, &[]); TERMS];
        for ((term, weight), (of_last, j)) in terms.iter_mut().zip(weights).zip(sources) {
            *term = (weight, if of_last { &last.x[j] } else { &before[j] });
        }
        kernels::combine(&mut rest[0], &terms[..count]);
    }

    /// Solves stage `i` at time `t` [s] from its prediction. If the iteration does not converge despite a short step and a new matrix,
    /// e.g. because a valve opens, it continues from its last iterate with a matrix computed there.
    fn newton(&mut self, i: usize, t: f64, cj: f64) -> Result<(), StageError> {
        let short = self.now.h < SHORT * self.last.h;
        for _ in 0..RENEWALS {
            match self.iterate(i, t, cj) {
                Err(StageError::Newton) if short && self.matrix.fresh => self.matrix.stale = true,
                ended => return ended,
            }
        }
        self.iterate(i, t, cj)
    }

    fn iterate(&mut self, i: usize, t: f64, cj: f64) -> Result<(), StageError> {
        self.take_up(i);
        let state = (t, self.now.y[i].as_slice(), self.work.yp.as_slice());
        self.matrix
            .prepare(&mut self.equations, state, cj, self.options.matrix_band)?;
        let [mut tolerance, accepted] = self.newton_tolerance;
        let mut before: Option<f64> = None;
        let mut enough = false;
        for iteration in 0..ITERATIONS {
            self.newton_iterations += 1;
            self.equations
                .residual(t, &self.now.y[i], &self.work.yp, &mut self.work.r)?;
            if iteration == 0 {
                self.matrix.corotation.look(&self.equations.dae);
                self.matrix.has_turned |= self.matrix.corotation.turned();
                if self.matrix.has_turned {
                    // a rotated matrix contracts too slowly for a stricter tolerance
                    tolerance = accepted;
                }
            }
            let factor = -self.matrix.solve(&mut self.work.r, cj);
            let size = self.correct(i, [factor, cj]);
            if !size.is_finite() {
                return Err(StageError::Newton);
            }
            if let Some(before) = before {
                let rate = size / before;
                // at the level of rounding errors there is no further contraction
                self.matrix.measured(rate, size <= 0.1 * accepted);
                if size <= 0.1 * tolerance {
                    return Ok(());
                }
                let left = (ITERATIONS - 1 - iteration) as i32;
                if rate > DIVERGING || rate.powi(left) * size * rate / (1.0 - rate) > accepted {
                    // if the contraction stops, the remaining error accepted before suffices
                    return if enough && rate < 1.0 {
                        Ok(())
                    } else {
                        Err(StageError::Newton)
                    };
                }
            }
            let rate = self.matrix.rate_of(before.is_some());
            let left = rate / (1.0 - rate) * size;
            enough = left <= accepted;
            if left <= tolerance {
                if before.is_none() {
                    self.matrix.trust_less();
                }
                return Ok(());
            }
            before = Some(size);
        }
        if enough { Ok(()) } else { Err(StageError::Newton) }
    }

    /// Computes values and rates of stage `i` from its own unknowns.
    fn take_up(&mut self, i: usize) {
        let (Stages { x, y, h, .. }, w) = (&mut self.now, &mut self.work);
        let step = *h * self.tableau.gamma();
        values(&x[i], &w.base, &self.mask, step, [&mut y[i], &mut w.yp]);
    }

    /// Corrects stage `i` by a solution times a factor; returns the norm of the correction.
    fn correct(&mut self, i: usize, factors: [f64; 2]) -> f64 {
        let (Stages { x, y, h, .. }, w) = (&mut self.now, &mut self.work);
        let n = w.r.len() as f64;
        let corrected = Corrected {
            x: &mut x[i],
            y: &mut y[i],
            yp: &mut w.yp,
            r: &mut w.r,
            base: &w.base,
            mask: &self.mask,
            weights: &w.weights,
        };
        (corrected.by(factors, *h * self.tableau.gamma()) / n).sqrt()
    }

    /// Error of the step, relative to the tolerance.
    ///
    /// The embedded method gives `e = h Σ (bᵢ - b̂ᵢ) Kᵢ`, which grows with the stiffness of stiff components. Another solution,
    /// `(∂F/∂y + cj ∂F/∂y') err = cj ∂F/∂y' e`, filters it like the method filters a disturbance `e` (Shampine; Hairer & Wanner IV.8):
    /// `(1 - h γ λ)⁻¹ e`. The right-hand side is a residual with the rates changed by `cj e`. Algebraic unknowns have the error caused by
    /// the differential ones, and contribute to the norm.
    fn estimate(&mut self, t1: f64, cj: f64) -> Result<f64, StageError> {
        let s = self.tableau.stages;
        let (b, gamma) = (self.tableau.b(), self.tableau.gamma());
        let yp = &mut self.work.yp;
        let mut terms: Terms = [(1.0, &self.now.x[s - 1]); TERMS];
        for (j, (term, x)) in terms[1..].iter_mut().zip(&self.now.x[..s]).enumerate() {
            *term = ((b[j] - self.tableau.embedded[j]) / gamma, x);
        }
        kernels::combine(yp, &terms[..=s]);
        for (yp, mask) in yp.iter_mut().zip(&self.mask) {
            *yp *= mask;
        }
        self.equations
            .residual(t1, &self.now.y[s - 1], &self.work.yp, &mut self.work.r)?;
        let factor = self.matrix.solve(&mut self.work.r, cj);
        let error = factor * norm(&self.work.r, &self.work.weights);
        self.work.r.iter_mut().for_each(|r| *r *= factor);
        if error.is_finite() {
            Ok(error)
        } else {
            Err(StageError::Newton)
        }
    }
}
