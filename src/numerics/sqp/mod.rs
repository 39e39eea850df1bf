//! Minimization of a smooth function with bounds and inequalities: sequential quadratic programming.
//!
//! ```text
//! min f(x),  0 <= x <= 1,  c(x) <= 0
//! min g·d + d·B d/2 + ρ Σ max(0, c + a·d)        g, a the slopes of f and c; the step d, its multipliers λ <= ρ
//! φ = f + ρ Σ max(0, c)                          falls along x + t d, t = 1, 1/2, .., or at x + d with d by c(x + d) - a·d in place of c
//! B                                              of the Lagrangian f + λ·c, by Powell's damped form of BFGS (1978)
//! ```
//!
//! Nocedal & Wright, Numerical Optimization, chapter 18. Available crates do not shorten steps to points that cannot be
//! evaluated, ignore the error of simulated values, and do not return multipliers. There are few variables: Hildreth's
//! method finds the step by coordinate ascent over the multipliers.

use nalgebra::{DMatrix, DVector};

/// Function values and gradients at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct SqpPoint {
    /// Objective, scaled to the order of 1.
    pub value: f64,
    /// Gradient of the objective.
    pub slope: DVector<f64>,
    /// Values of the inequalities, which must not exceed 0, scaled to the order of 1.
    pub inequalities: DVector<f64>,
    /// Gradients of the inequalities, one per row.
    pub slopes: DMatrix<f64>,
}

impl SqpPoint {
    /// Sum of the violations of all inequalities.
    pub fn violation(&self) -> f64 {
        self.inequalities.iter().map(|c| c.max(0.0)).sum()
    }
}

/// Outcome of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SqpStatus {
    /// Converged to a minimum under the inequalities.
    Found,
    /// No step lowers the objective, although its gradient predicts it: the gradient is inaccurate.
    Stuck,
    /// Inequalities are violated, and no step reduces the violation.
    Apart,
    /// Reached the limit of steps.
    Unfinished,
}

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct SqpMinimum {
    /// Variables.
    pub x: Vec<f64>,
    /// Values and gradients there.
    pub at: SqpPoint,
    /// Lagrange multipliers: decrease of the objective per unit of relaxation of each inequality.
    pub multipliers: Vec<f64>,
    /// Multipliers of the bounds: positive at the upper bound, negative at the lower bound, 0 between them.
    pub at_bounds: Vec<f64>,
    /// Outcome of the search.
    pub ended: SqpStatus,
    /// Number of steps.
    pub steps: usize,
}

/// Options of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SqpOptions {
    /// Largest number of steps.
    pub steps: usize,
    /// Step size below which the search ends.
    pub close: f64,
    /// Error of the values; smaller decreases are not significant.
    pub noise: f64,
}

/// Tolerance of the inequalities.
pub const HELD: f64 = 1e-6;
/// Distance from a bound below which a variable is at the bound.
const AT: f64 = 1e-9;
/// Factor on the final step size while inequalities are violated.
const NOTHING: f64 = 1e-3;
/// Largest first step, and largest step.
const FIRST: f64 = 0.15;
const LONGEST: f64 = 0.5;
/// Smallest accepted ratio of actual to predicted decrease.
const WORTH: f64 = 1e-4;
/// Reduction of a rejected step, and of a step to a point that cannot be evaluated.
const SHORTER: f64 = 0.5;
const FAILED: f64 = 0.25;
/// Largest step relative to the previous one, and the largest number of reductions.
const LONGER: f64 = 2.0;
const CUTS: usize = 10;
/// Penalty of violations: initial and largest value.
const PRICE: [f64; 2] = [10.0, 1e7];
/// Smallest share of the curvature kept by an update.
const KEPT: f64 = 0.2;
/// Largest number of rounds over the multipliers, and the change of the step that ends them.
const ROUNDS: usize = 20_000;
const SETTLED: f64 = 1e-14;

/// Function that evaluates a point; none if it cannot be evaluated.
pub type EvaluateFunctions<'a> = dyn FnMut(&[f64]) -> Option<SqpPoint> + 'a;

/// Searches from a start; none if the start cannot be evaluated.
pub fn minimise(start: &[f64], options: &SqpOptions, evaluate: &mut EvaluateFunctions<'_>) -> Option<SqpMinimum> {
    let mut x: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
    let mut at = evaluate(&x)?;
    let n = x.len();
    let mut b = DMatrix::identity(n, n) * (at.slope.amax() / FIRST).max(f64::MIN_POSITIVE.sqrt());
    let (mut fresh, mut steps, mut price, mut reach) = (true, 0, PRICE[0], LONGEST);
    loop {
        let step = Step::solve(&x, &at, &b, &mut price, reach);
        let end = |ended| {
            Some(SqpMinimum {
                x: x.clone(),
                at: at.clone(),
                multipliers: step.multipliers.clone(),
                at_bounds: step.at_bounds.clone(),
                ended,
                steps,
            })
        };
        let length = step.d.amax();
        let fall = step.fall(&at, price);
        let beyond = at.violation() > HELD;
        let least = if beyond { NOTHING * options.close } else { options.close };
        if length <= least || fall <= 0.0 {
            return end(match beyond {
                true => SqpStatus::Apart,
                false => SqpStatus::Found,
            });
        }
        if steps >= options.steps {
            return end(SqpStatus::Unfinished);
        }
        let merit = |at: &SqpPoint| at.value + price * at.violation();
        let moved = |d: &DVector<f64>, part: f64| -> Vec<f64> {
            let to = x.iter().zip(d.iter()).map(|(x, d)| snapped(x + part * d));
            to.collect()
        };
        let falls = |there: &SqpPoint, part| merit(there) <= merit(&at) - WORTH * part * fall + options.noise;
        let (mut part, mut next) = (1.0, None);
        for _ in 0..CUTS {
            let to = moved(&step.d, part);
            match evaluate(&to) {
                None => part *= FAILED,
                Some(there) if falls(&there, part) => {
                    next = Some((to, there));
                    break;
                }
                // along a curved limit the full step violates it, above all near the minimum (Maratos)
                Some(there) if part == 1.0 && there.violation() > step.left + HELD => {
                    let to = moved(&step.bent(&x, &at, &there, &b, [price, reach]), 1.0);
                    next = evaluate(&to).filter(|there| falls(there, 1.0)).map(|there| (to, there));
                    if next.is_some() {
                        break;
                    }
                    part *= SHORTER;
                }
                Some(_) => part *= SHORTER,
            }
            if part * length <= least {
                break;
            }
        }
        let Some((to, there)) = next else {
            return end(match (fall <= 10.0 * options.noise.max(1e-9), beyond) {
                (_, true) => SqpStatus::Apart,
                (true, false) => SqpStatus::Found,
                (false, false) => SqpStatus::Stuck,
            });
        };
        // after a shortened step, limit the next one to a small multiple of its length
        reach = match part < 1.0 {
            true => (LONGER * part * length).max(LONGER * options.close),
            false => reach.max(LONGER * length).min(LONGEST),
        };
        let s = DVector::from_iterator(n, to.iter().zip(&x).map(|(to, x)| to - x));
        let lambda = DVector::from_column_slice(&step.multipliers);
        let of = |at: &SqpPoint| &at.slope + at.slopes.tr_mul(&lambda);
        update(&mut b, &s, of(&there) - of(&at), fresh);
        (x, at, fresh) = (to, there, false);
        steps += 1;
    }
}

/// Moves a variable at or near a bound onto it.
fn snapped(x: f64) -> f64 {
    match x {
        x if x <= AT => 0.0,
        x if x >= 1.0 - AT => 1.0,
        x => x,
    }
}

/// Updates the curvature `b` with the change `y` of the gradient over a step `s` (damped BFGS).
fn update(b: &mut DMatrix<f64>, s: &DVector<f64>, y: DVector<f64>, fresh: bool) {
    let (along, square) = (s.dot(&y), s.norm_squared());
    if square == 0.0 {
        return;
    }
    if fresh && along > 0.0 {
        *b = DMatrix::identity(s.len(), s.len()) * (y.norm_squared() / along);
    }
    let bs = &*b * s;
    let own = s.dot(&bs);
    let part = match along >= KEPT * own {
        true => 1.0,
        false => (1.0 - KEPT) * own / (own - along),
    };
    let y = y * part + &bs * (1.0 - part);
    *b += &y * y.transpose() / s.dot(&y) - &bs * bs.transpose() / own;
}

/// A step with multipliers.
struct Step {
    d: DVector<f64>,
    multipliers: Vec<f64>,
    at_bounds: Vec<f64>,
    /// Sum of the violations after the step, to first order.
    left: f64,
}

impl Step {
    /// Best step for the curvature `b`. Raises the penalty until the step satisfies the inequalities as far as
    /// possible, and the penalty exceeds all multipliers.
    fn solve(x: &[f64], at: &SqpPoint, b: &DMatrix<f64>, price: &mut f64, reach: f64) -> Self {
        loop {
            let step = Self::at_price(x, at, b, [*price, reach]);
            let short = step.left > HELD && step.multipliers.iter().any(|l| *l >= *price * (1.0 - 1e-9));
            if !short || *price >= PRICE[1] {
                return step;
            }
            *price *= 10.0;
        }
    }

    fn at_price(x: &[f64], at: &SqpPoint, b: &DMatrix<f64>, [price, reach]: [f64; 2]) -> Self {
        let (n, m) = (x.len(), at.inequalities.len());
        let inverse = b.clone().try_inverse().unwrap_or_else(|| DMatrix::identity(n, n));
        let row = |i: usize| match i.checked_sub(m) {
            None => at.slopes.row(i).transpose(),
            Some(k) => {
                let mut unit = DVector::zeros(n);
                unit[k / 2] = if k % 2 == 0 { 1.0 } else { -1.0 };
                unit
            }
        };
        let room = |i: usize| match i.checked_sub(m) {
            None => -at.inequalities[i],
            Some(k) if k % 2 == 0 => (1.0 - x[k / 2]).min(reach),
            Some(k) => x[k / 2].min(reach),
        };
        let rows: Vec<DVector<f64>> = (0..m + 2 * n).map(row).collect();
        let moved: Vec<DVector<f64>> = rows.iter().map(|row| &inverse * row).collect();
        let mut lambda = vec![0.0; rows.len()];
        let mut d = -(&inverse * &at.slope);
        for _ in 0..ROUNDS {
            let mut change = 0.0_f64;
            for (i, row) in rows.iter().enumerate() {
                let stiff = row.dot(&moved[i]);
                if stiff <= 0.0 {
                    continue;
                }
                let most = if i < m { price } else { f64::INFINITY };
                let next = (lambda[i] + (row.dot(&d) - room(i)) / stiff).clamp(0.0, most);
                let more = next - lambda[i];
                lambda[i] = next;
                d.axpy(-more, &moved[i], 1.0);
                change = change.max(more * moved[i].amax()).max(-more * moved[i].amax());
            }
            if change <= SETTLED {
                break;
            }
        }
        for k in 0..n {
            d[k] = d[k].clamp(-x[k], 1.0 - x[k]);
        }
        // a variable limited by the step length has no bound multiplier
        let between = |k: usize| f64::from(u8::from(d[k].abs() < reach));
        let at_bounds = (0..n).map(|k| between(k) * (lambda[m + 2 * k] - lambda[m + 2 * k + 1]));
        let left = (&at.inequalities + &at.slopes * &d).iter().map(|c| c.max(0.0)).sum();
        Self {
            at_bounds: at_bounds.collect(),
            multipliers: lambda[..m].to_vec(),
            left,
            d,
        }
    }

    /// Second-order correction: the step with the inequalities at the end of this step (Nocedal & Wright, 18.3).
    fn bent(&self, x: &[f64], at: &SqpPoint, there: &SqpPoint, b: &DMatrix<f64>, limits: [f64; 2]) -> DVector<f64> {
        let bent = SqpPoint {
            inequalities: &there.inequalities - &at.slopes * &self.d,
            ..at.clone()
        };
        Self::at_price(x, &bent, b, limits).d
    }

    /// Predicted decrease of the penalized objective, to first order.
    fn fall(&self, at: &SqpPoint, price: f64) -> f64 {
        -at.slope.dot(&self.d) + price * (at.violation() - self.left)
    }
}

#[cfg(test)]
mod tests;
