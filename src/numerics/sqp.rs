//! The least value of a smooth function between bounds, under inequalities: sequential quadratic programming.
//!
//! ```text
//! min f(x),  0 <= x <= 1,  c(x) <= 0
//! min g·d + d·B d/2 + ρ Σ max(0, c + a·d)        g, a the slopes of f and c; the step d, its multipliers λ <= ρ
//! φ = f + ρ Σ max(0, c)                          falls along x + t d, t = 1, 1/2, ..
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
    let (mut fresh, mut steps, mut price) = (true, 0, PRICE[0]);
    loop {
        let step = Step::of(&x, &at, &b, &mut price);
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
        let (mut part, mut next) = (1.0, None);
        for _ in 0..CUTS {
            let moved = x.iter().zip(step.d.iter()).map(|(x, d)| snapped(x + part * d));
            let to: Vec<f64> = moved.collect();
            match evaluate(&to) {
                None => part *= FAILED,
                Some(there) if merit(&there) <= merit(&at) - WORTH * part * fall + options.noise => {
                    next = Some((to, there));
                    break;
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
    fn of(x: &[f64], at: &Point, b: &DMatrix<f64>, price: &mut f64) -> Self {
        loop {
            let step = Self::at_price(x, at, b, *price);
            let short = step.left > HELD && step.multipliers.iter().any(|l| *l >= *price * (1.0 - 1e-9));
            if !short || *price >= PRICE[1] {
                return step;
            }
            *price *= 10.0;
        }
    }

    fn at_price(x: &[f64], at: &Point, b: &DMatrix<f64>, price: f64) -> Self {
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
            Some(k) if k % 2 == 0 => (1.0 - x[k / 2]).min(LONGEST),
            Some(k) => x[k / 2].min(LONGEST),
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
        let between = |k: usize| f64::from(u8::from(d[k].abs() < LONGEST));
        let at_bounds = (0..n).map(|k| between(k) * (lambda[m + 2 * k] - lambda[m + 2 * k + 1]));
        let left = (&at.inequalities + &at.slopes * &d).iter().map(|c| c.max(0.0)).sum();
        Self {
            at_bounds: at_bounds.collect(),
            multipliers: lambda[..m].to_vec(),
            left,
            d,
        }
    }

    /// How much the priced value falls along it, to first order.
    fn fall(&self, at: &Point, price: f64) -> f64 {
        -at.slope.dot(&self.d) + price * (at.violation() - self.left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OPTIONS: Options = Options {
        steps: 200,
        close: 1e-8,
        noise: 0.0,
    };

    fn free(value: f64, slope: &[f64]) -> Point {
        Point {
            value,
            slope: DVector::from_column_slice(slope),
            inequalities: DVector::zeros(0),
            slopes: DMatrix::zeros(0, slope.len()),
        }
    }

    /// Source: Rosenbrock (1960), whose valley ends at (1, 1), here 0.5 in both.
    fn rosenbrock(x: &[f64]) -> Point {
        let [a, b] = [4.0 * x[0] - 1.0, 4.0 * x[1] - 1.0];
        let [da, db] = [-400.0 * a * (b - a * a) - 2.0 * (1.0 - a), 200.0 * (b - a * a)];
        free(100.0 * (b - a * a).powi(2) + (1.0 - a).powi(2), &[4.0 * da, 4.0 * db])
    }

    /// Goal: a curved valley is followed to its end, beside places without a value too.
    #[test]
    fn valleys_are_followed_to_their_end() {
        for wall in [2.0, 0.55] {
            let mut count = 0;
            let found = minimise(&[0.0, 0.9], &OPTIONS, &mut |x| {
                count += 1;
                (x[0] < wall).then(|| rosenbrock(x))
            });
            let found = found.expect("a start");
            assert!(found.ended == Ended::Found && found.at.value < 1e-12, "{found:?}");
            assert!(count < 120, "{count}");
        }
        assert!(minimise(&[0.0, 0.9], &OPTIONS, &mut |_| None).is_none());
    }

    /// Source: Rosen & Suzuki (Hock & Schittkowski 43): -44 at (0, 1, 2, -1), two of three inequalities active with multipliers 1 and 2.
    #[test]
    fn inequalities_are_held() {
        let problem = |z: &[f64]| {
            let y: Vec<f64> = z.iter().map(|z| 10.0 * z - 5.0).collect();
            let [a, b, c, d] = [y[0], y[1], y[2], y[3]];
            let slope = [2.0 * a - 5.0, 2.0 * b - 5.0, 4.0 * c - 21.0, 2.0 * d + 7.0];
            let squares = a * a + b * b + c * c + d * d;
            Some(Point {
                value: a * a + b * b + 2.0 * c * c + d * d - 5.0 * a - 5.0 * b - 21.0 * c + 7.0 * d,
                slope: DVector::from_column_slice(&slope) * 10.0,
                inequalities: DVector::from_vec(vec![
                    squares + a - b + c - d - 8.0,
                    squares + b * b + d * d - a - d - 10.0,
                    squares + a * a - d * d + 2.0 * a - b - d - 5.0,
                ]),
                slopes: DMatrix::from_row_slice(
                    3,
                    4,
                    &[
                        [2.0 * a + 1.0, 2.0 * b - 1.0, 2.0 * c + 1.0, 2.0 * d - 1.0],
                        [2.0 * a - 1.0, 4.0 * b, 2.0 * c, 4.0 * d - 1.0],
                        [4.0 * a + 2.0, 2.0 * b - 1.0, 2.0 * c, -1.0],
                    ]
                    .concat(),
                ) * 10.0,
            })
        };
        for start in [[0.5; 4], [1.0; 4], [0.0, 1.0, 0.0, 1.0]] {
            let found = minimise(&start, &OPTIONS, &mut |x| problem(x)).expect("a start");
            assert!(found.ended == Ended::Found, "{start:?}: {found:?}");
            let off =
                |of: &[f64], wanted: &[f64]| of.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off(&found.x, &[0.5, 0.6, 0.7, 0.4]) < 1e-6, "{start:?}: {found:?}");
            assert!(off(&found.multipliers, &[1.0, 0.0, 2.0]) < 1e-4, "{start:?}: {found:?}");
        }
    }

    /// Goal: what would leave the bounds stays at one, with what that costs; what cannot be held is told.
    #[test]
    fn bounds_hold_and_contradictions_are_told() {
        let plane = |x: &[f64]| free(x[0] + (x[1] - 0.25).powi(2), &[1.0, 2.0 * (x[1] - 0.25)]);
        let found = minimise(&[0.7, 0.9], &OPTIONS, &mut |x| Some(plane(x))).expect("a start");
        assert!(found.x[0] == 0.0 && (found.x[1] - 0.25).abs() < 1e-7, "{found:?}");
        assert!(
            (found.at_bounds[0] + 1.0).abs() < 1e-9 && found.at_bounds[1].abs() < 1e-6,
            "{found:?}"
        );
        // x0 >= 0.8 and x0 <= 0.2
        let apart = |x: &[f64]| Point {
            inequalities: DVector::from_vec(vec![0.8 - x[0], x[0] - 0.2]),
            slopes: DMatrix::from_row_slice(2, 2, &[-1.0, 0.0, 1.0, 0.0]),
            ..plane(x)
        };
        let found = minimise(&[0.7, 0.9], &OPTIONS, &mut |x| Some(apart(x))).expect("a start");
        assert!(found.ended == Ended::Apart && found.at.violation() > 0.5, "{found:?}");
    }

    /// Goal: values with an error of 1e-5 do not keep the search from where the slopes vanish.
    #[test]
    fn errors_of_values_are_passed_over() {
        let options = Options {
            noise: 2e-5,
            close: 1e-5,
            ..OPTIONS
        };
        let bowl = |x: &[f64]| {
            let off = 1e-5 * (1e7 * x[0]).sin();
            free(1.0 + (x[0] - 0.3).powi(2) + off, &[2.0 * (x[0] - 0.3)])
        };
        let found = minimise(&[0.9], &options, &mut |x| Some(bowl(x))).expect("a start");
        assert!(
            found.ended == Ended::Found && (found.x[0] - 0.3).abs() < 1e-5,
            "{found:?}"
        );
    }
}
