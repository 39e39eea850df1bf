//! The least value of a smooth function between bounds, under inequalities: sequential quadratic programming.
//!
//! ```text
//! min f(x),  0 <= x <= 1,  c(x) <= 0
//! min g·d + d·B d/2 + ρ Σ max(0, c + a·d)        g, a the slopes of f and c; the step d, its multipliers λ <= ρ
//! φ = f + ρ Σ max(0, c)                          falls along x + t d, t = 1, 1/2, .., or at x + d with d by c(x + d) - a·d in place of c
//! B                                              of the Lagrangian f + λ·c, by Powell's damped form of BFGS (1978)
//! ```
//!
//! Nocedal & Wright, Numerical Optimization, chapter 18. Written here since the crates that there are know neither a place that cannot be
//! evaluated, at which a step has to be shortened, nor the error of a simulated value, below which its fall says nothing, and keep the
//! multipliers to themselves. Numbers are few: the step is found by Hildreth's ascent over the multipliers, one after the other.

use nalgebra::{DMatrix, DVector};

/// What there is at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The value that is to be least, of size 1 or so.
    pub value: f64,
    /// Its slopes.
    pub slope: DVector<f64>,
    /// What must not be above 0, likewise.
    pub inequalities: DVector<f64>,
    /// Their slopes, a row each.
    pub slopes: DMatrix<f64>,
}

impl Point {
    /// How far inequalities are from being held, together.
    pub fn violation(&self) -> f64 {
        self.inequalities.iter().map(|c| c.max(0.0)).sum()
    }
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// At a least value under the inequalities.
    Found,
    /// Where no step lowers the value further, though its slopes say so: they are not those of the value to all digits.
    Stuck,
    /// Where no step brings the inequalities nearer to being held.
    Apart,
    /// After as many steps as were allowed.
    Unfinished,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Where.
    pub x: Vec<f64>,
    /// What is there.
    pub at: Point,
    /// By how much the value would fall for each unit by which an inequality were let go.
    pub multipliers: Vec<f64>,
    /// The same of the bounds: above 0 at the upper, below 0 at the lower, 0 between them.
    pub at_bounds: Vec<f64>,
    /// How the search ended.
    pub ended: Ended,
    /// Steps that were taken.
    pub steps: usize,
}

/// How a search goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Steps at most.
    pub steps: usize,
    /// A step that is shorter ends the search.
    pub close: f64,
    /// Error of the values: a fall by less says nothing.
    pub noise: f64,
}

/// Inequalities may be off by this.
pub const HELD: f64 = 1e-6;
/// A place that is nearer to a bound lies at it.
const AT: f64 = 1e-9;
/// Share of a step that ends a search which ends one that has still to come within its inequalities.
const NOTHING: f64 = 1e-3;
/// First step at most, and every step.
const FIRST: f64 = 0.15;
const LONGEST: f64 = 0.5;
/// Share of the foretold fall that a step must bring.
const WORTH: f64 = 1e-4;
/// A shortened step, and how often.
const SHORTER: f64 = 0.5;
const FAILED: f64 = 0.25;
/// What is tried beyond the last step, times its length.
const LONGER: f64 = 2.0;
const CUTS: usize = 10;
/// Price of what is not held: at first, and at most.
const PRICE: [f64; 2] = [10.0, 1e7];
/// Share of the curvature that an update keeps at least.
const KEPT: f64 = 0.2;
/// Rounds over the multipliers at most, and a change of the step that ends them.
const ROUNDS: usize = 20_000;
const SETTLED: f64 = 1e-14;

/// What is asked for a place; nothing where there is nothing to be had.
pub type Evaluate<'a> = dyn FnMut(&[f64]) -> Option<Point> + 'a;

/// Searches from a start; nothing where there is nothing to be had there.
pub fn minimise(start: &[f64], options: &Options, evaluate: &mut Evaluate<'_>) -> Option<Minimum> {
    let mut x: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
    let mut at = evaluate(&x)?;
    let n = x.len();
    let mut b = DMatrix::identity(n, n) * (at.slope.amax() / FIRST).max(f64::MIN_POSITIVE.sqrt());
    let (mut fresh, mut steps, mut price, mut reach) = (true, 0, PRICE[0], LONGEST);
    loop {
        let step = Step::of(&x, &at, &b, &mut price, reach);
        let end = |ended| {
            Some(Minimum {
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
                true => Ended::Apart,
                false => Ended::Found,
            });
        }
        if steps >= options.steps {
            return end(Ended::Unfinished);
        }
        let merit = |at: &Point| at.value + price * at.violation();
        let moved = |d: &DVector<f64>, part: f64| -> Vec<f64> {
            let to = x.iter().zip(d.iter()).map(|(x, d)| snapped(x + part * d));
            to.collect()
        };
        let falls = |there: &Point, part| merit(there) <= merit(&at) - WORTH * part * fall + options.noise;
        let (mut part, mut next) = (1.0, None);
        for _ in 0..CUTS {
            let to = moved(&step.d, part);
            match evaluate(&to) {
                None => part *= FAILED,
                Some(there) if falls(&there, part) => {
                    next = Some((to, there));
                    break;
                }
                // along a curved limit the whole step leads beyond it, the nearer to the least value the surer (Maratos)
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
                (_, true) => Ended::Apart,
                (true, false) => Ended::Found,
                (false, false) => Ended::Stuck,
            });
        };
        // where a part of a step was all that could be gone, the next one need not be tried much longer
        reach = match part < 1.0 {
            true => (LONGER * part * length).max(LONGER * options.close),
            false => reach.max(LONGER * length).min(LONGEST),
        };
        let s = DVector::from_iterator(n, to.iter().zip(&x).map(|(to, x)| to - x));
        let lambda = DVector::from_column_slice(&step.multipliers);
        let of = |at: &Point| &at.slope + at.slopes.tr_mul(&lambda);
        update(&mut b, &s, of(&there) - of(&at), fresh);
        (x, at, fresh) = (to, there, false);
        steps += 1;
    }
}

/// A place within the bounds; at one where it is as near to it as steps are found.
fn snapped(x: f64) -> f64 {
    match x {
        x if x <= AT => 0.0,
        x if x >= 1.0 - AT => 1.0,
        x => x,
    }
}

/// Takes a change of slopes `y` over a step `s` into the curvature.
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

/// A step with its multipliers.
struct Step {
    d: DVector<f64>,
    multipliers: Vec<f64>,
    at_bounds: Vec<f64>,
    /// What inequalities would be violated by after it, as far as slopes tell.
    left: f64,
}

impl Step {
    /// The best where `b` is the curvature. The price goes up until inequalities are held by the step, as far as they can be, and above
    /// every multiplier.
    fn of(x: &[f64], at: &Point, b: &DMatrix<f64>, price: &mut f64, reach: f64) -> Self {
        loop {
            let step = Self::at_price(x, at, b, [*price, reach]);
            let short = step.left > HELD && step.multipliers.iter().any(|l| *l >= *price * (1.0 - 1e-9));
            if !short || *price >= PRICE[1] {
                return step;
            }
            *price *= 10.0;
        }
    }

    fn at_price(x: &[f64], at: &Point, b: &DMatrix<f64>, [price, reach]: [f64; 2]) -> Self {
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
        // what holds a step back that is as long as any may be is no bound
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

    /// The step anew, with what inequalities are where this one leads to: the correction of second order (Nocedal & Wright, 18.3).
    fn bent(&self, x: &[f64], at: &Point, there: &Point, b: &DMatrix<f64>, limits: [f64; 2]) -> DVector<f64> {
        let bent = Point {
            inequalities: &there.inequalities - &at.slopes * &self.d,
            ..at.clone()
        };
        Self::at_price(x, &bent, b, limits).d
    }

    /// How much the priced value falls along it, to first order.
    fn fall(&self, at: &Point, price: f64) -> f64 {
        -at.slope.dot(&self.d) + price * (at.violation() - self.left)
    }
}

#[cfg(test)]
mod tests;
