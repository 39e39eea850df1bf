//! The least value of a rugged function between bounds, by values alone: evolution with an adapted covariance (CMA-ES).
//!
//! ```text
//! x_k = m + σ y_k,  y_k ~ N(0, C),  k = 1..λ      those beyond a bound are put on it, and y_k with them
//! m += σ Σ w_i y_i                                over the better half, w_i falling with the logarithm of the rank
//! σ by the length of the path of m in the metric of C, C by that path and by the y_i
//! rank by f + ρ Σ max(0, c)                       ρ grows while the best of a generation breaks what has to hold
//! ```
//!
//! Hansen, The CMA Evolution Strategy: A Tutorial (arXiv 1604.00772), with its constants and weights above 0. A whole generation is asked for at
//! once, so that whoever answers may use all cores; numbers by chance are those of one seed, so that the answer is the same on any number of them.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::chance::Chance;
use super::exchange::{Worth, order};
use super::normal;

/// How a search goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Its seed beside others.
    pub stream: u64,
    /// Values at once, 4 or more.
    pub population: usize,
    /// Generations at most.
    pub generations: usize,
    /// Deviations between the bounds that are all shorter end it.
    pub close: f64,
    /// Values over their size that differ by less are the same.
    pub same: f64,
}

/// Why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All of a generation lies in one place.
    Close,
    /// Values no longer differ.
    Alike,
    /// After as many generations as were allowed.
    Unfinished,
    /// Whoever answers wanted the end.
    Stopped,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Best {
    /// Where.
    pub x: Vec<f64>,
    /// How far it breaks what has to hold, and the value.
    pub worth: Worth,
    /// How the search ended.
    pub ended: Ended,
    /// Generations.
    pub generations: usize,
}

/// Seed of all searches.
const SEED: u64 = 35;
/// Deviation between the bounds to begin with.
const FIRST: f64 = 0.3;
/// Price of what is not held: at first, how it grows, and at most.
const PRICE: [f64; 3] = [10.0, 2.0, 1e7];
/// Breaches below this are none.
const HELD: f64 = 1e-6;

/// Values at once that suit so many numbers.
pub fn population(numbers: usize) -> usize {
    6 + (3.0 * (numbers as f64).ln()) as usize
}

/// What is asked for a generation: of each place how far it breaks what has to hold, and its value; infinite where there is none. Nothing is the end.
pub type Evaluate<'a> = dyn FnMut(&[Vec<f64>]) -> Option<Vec<Worth>> + 'a;

/// Searches about a start, whose value comes first. Nothing where nothing was to be had.
pub fn minimise(start: &[f64], options: &Options, evaluate: &mut Evaluate<'_>) -> Option<Best> {
    let first: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
    let mut best = Best {
        worth: evaluate(std::slice::from_ref(&first))?.first().copied()?,
        x: first.clone(),
        ended: Ended::Unfinished,
        generations: 0,
    };
    let mut chance = Chance::new(SEED, options.stream);
    let mut state = State::new(first, options.population);
    let mut price = PRICE[0];
    let (mut bests, window) = (vec![], 10 + 30 * best.x.len() / options.population);
    while best.generations < options.generations {
        let places = state.sample(&mut chance);
        let Some(worths) = evaluate(&places) else {
            best.ended = Ended::Stopped;
            break;
        };
        best.generations += 1;
        let merit = |worth: &Worth| worth[1] + price * worth[0];
        let mut ranks: Vec<usize> = (0..places.len()).collect();
        ranks.sort_by(|a, b| merit(&worths[*a]).total_cmp(&merit(&worths[*b])).then(a.cmp(b)));
        for (place, worth) in places.iter().zip(&worths) {
            if order(worth, &best.worth).is_lt() {
                (best.x, best.worth) = (place.clone(), *worth);
            }
        }
        let (top, last) = (worths[ranks[0]], worths[ranks[places.len() - 1]]);
        bests.push(merit(&top));
        let recent = &bests[bests.len().saturating_sub(window)..];
        let spread = |least: f64, most: f64| most - least <= options.same * least.abs().max(f64::MIN_POSITIVE);
        let [low, high] = [f64::min, f64::max].map(|of| recent.iter().copied().reduce(of).unwrap_or(f64::NAN));
        let alike = recent.len() == window && spread(low, high) && spread(merit(&top), merit(&last));
        if top[0] > HELD {
            price = (price * PRICE[1]).min(PRICE[2]);
        }
        state.update(&ranks);
        if state.width() < options.close || alike {
            best.ended = if alike { Ended::Alike } else { Ended::Close };
            break;
        }
    }
    best.worth[1].is_finite().then_some(best)
}

/// Where a search is, and how it samples.
struct State {
    mean: DVector<f64>,
    sigma: f64,
    c: DMatrix<f64>,
    /// `C = B D² Bᵀ`.
    b: DMatrix<f64>,
    d: DVector<f64>,
    path: DVector<f64>,
    path_sigma: DVector<f64>,
    weights: Vec<f64>,
    population: usize,
    generation: i32,
    /// Of the last sample.
    steps: Vec<DVector<f64>>,
}

impl State {
    fn new(mean: Vec<f64>, population: usize) -> Self {
        let n = mean.len();
        let half = population / 2;
        let weight = |i: usize| (0.5 * (population as f64 + 1.0)).ln() - (i as f64 + 1.0).ln();
        let sum: f64 = (0..half).map(weight).sum();
        Self {
            mean: DVector::from_vec(mean),
            sigma: FIRST,
            c: DMatrix::identity(n, n),
            b: DMatrix::identity(n, n),
            d: DVector::from_element(n, 1.0),
            path: DVector::zeros(n),
            path_sigma: DVector::zeros(n),
            weights: (0..half).map(|i| weight(i) / sum).collect(),
            population,
            generation: 0,
            steps: vec![],
        }
    }

    /// The longest deviation along a number.
    fn width(&self) -> f64 {
        self.sigma * self.c.diagonal().max().sqrt()
    }

    fn sample(&mut self, chance: &mut Chance) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        let mut places = vec![];
        self.steps.clear();
        for _ in 0..self.population {
            let z = DVector::from_fn(n, |k, _| self.d[k] * normal::quantile(chance.share()));
            let x = (&self.mean + &self.b * z * self.sigma).map(|x| x.clamp(0.0, 1.0));
            self.steps.push((&x - &self.mean) / self.sigma);
            places.push(x.iter().copied().collect());
        }
        places
    }

    fn update(&mut self, ranks: &[usize]) {
        let n = self.mean.len() as f64;
        let effective = 1.0 / self.weights.iter().map(|w| w * w).sum::<f64>();
        let cs = (effective + 2.0) / (n + effective + 5.0);
        let damping = 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + cs;
        let cc = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        let c1 = 2.0 / ((n + 1.3).powi(2) + effective);
        let cmu = (2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective)).min(1.0 - c1);
        let length = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let chosen: Vec<(f64, &DVector<f64>)> = self
            .weights
            .iter()
            .zip(ranks)
            .map(|(w, k)| (*w, &self.steps[*k]))
            .collect();
        let step = chosen
            .iter()
            .fold(DVector::zeros(self.mean.len()), |sum, (w, y)| sum + *y * *w);
        self.mean += &step * self.sigma;
        self.generation += 1;
        let white = &self.b * (self.b.tr_mul(&step)).component_div(&self.d);
        self.path_sigma = &self.path_sigma * (1.0 - cs) + white * (cs * (2.0 - cs) * effective).sqrt();
        let own = self.path_sigma.norm();
        let usual = (1.0 - (1.0 - cs).powi(2 * self.generation)).sqrt();
        let stalled = if own / usual < (1.4 + 2.0 / (n + 1.0)) * length {
            1.0
        } else {
            0.0
        };
        self.path = &self.path * (1.0 - cc) + &step * (stalled * (cc * (2.0 - cc) * effective).sqrt());
        let lost = (1.0 - stalled) * cc * (2.0 - cc);
        self.c *= 1.0 + c1 * lost - c1 - cmu;
        self.c += &self.path * self.path.transpose() * c1;
        for (w, y) in chosen {
            self.c += y * y.transpose() * (cmu * w);
        }
        self.sigma *= ((cs / damping) * (own / length - 1.0)).min(1.0).exp();
        let eigen = SymmetricEigen::new((&self.c + self.c.transpose()) * 0.5);
        // what lies on a bound has no deviation across it
        let least = 1e-14 * eigen.eigenvalues.max();
        self.d = eigen.eigenvalues.map(|value| value.max(least).sqrt());
        self.b = eigen.eigenvectors;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(stream: u64, population: usize) -> Options {
        Options {
            stream,
            population,
            generations: 400,
            close: 1e-6,
            same: 1e-12,
        }
    }

    fn free(values: impl Fn(&[f64]) -> f64) -> impl FnMut(&[Vec<f64>]) -> Option<Vec<Worth>> {
        move |places| Some(places.iter().map(|x| [0.0, values(x)]).collect())
    }

    /// Source: Rosenbrock's valley and Rastrigin's bowl with its many hollows, of which the middle one is the least, in four numbers.
    #[test]
    fn valleys_and_hollows() {
        let valley = |x: &[f64]| {
            let z: Vec<f64> = x.iter().map(|x| 4.0 * x - 1.5).collect();
            let pairs = z
                .windows(2)
                .map(|p| 100.0 * (p[1] - p[0] * p[0]).powi(2) + (1.0 - p[0]).powi(2));
            pairs.sum::<f64>()
        };
        let best = minimise(&[0.2; 4], &options(0, population(4)), &mut free(valley)).expect("a start");
        assert!(best.x.iter().all(|x| (x - 0.625).abs() < 1e-4), "{best:?}");
        let hollows = |x: &[f64]| {
            let z = x.iter().map(|x| 6.0 * (x - 0.4));
            z.map(|z| z * z - 3.0 * (std::f64::consts::TAU * z).cos() + 3.0)
                .sum::<f64>()
        };
        let best = minimise(&[0.9; 4], &options(0, 40), &mut free(hollows)).expect("a start");
        assert!(best.ended == Ended::Close && best.worth[1] < 1e-8, "{best:?}");
        assert_eq!(
            Some(&best),
            minimise(&[0.9; 4], &options(0, 40), &mut free(hollows)).as_ref()
        );
    }

    /// Goal: a best at a bound lies on it, what has to hold is held with the price that this takes, places without a value are passed over, and
    /// a flat value, an end that is wanted and a start of nothing end the search.
    #[test]
    fn bounds_limits_and_ends() {
        let mut plane = |places: &[Vec<f64>]| {
            let of = |x: &Vec<f64>| match x[1] < 0.9 {
                true => [(0.3 - x[1]).max(0.0), 1e3 * x[1] - x[0]],
                false => [0.0, f64::INFINITY],
            };
            Some(places.iter().map(of).collect::<Vec<Worth>>())
        };
        let best = minimise(&[0.4, 0.95], &options(1, 8), &mut plane).expect("a place");
        assert!(
            best.x[0] == 1.0 && (best.x[1] - 0.3).abs() < 1e-4 && best.worth[0] <= HELD,
            "{best:?}"
        );
        let best = minimise(&[0.4], &options(1, 6), &mut free(|_| 3.0)).expect("a start");
        assert!(best.ended == Ended::Alike && best.generations < 30, "{best:?}");
        let mut left = 3;
        let best = minimise(&[0.9], &options(1, 6), &mut |places| {
            left -= 1;
            (left > 0).then(|| places.iter().map(|x| [0.0, x[0]]).collect())
        });
        assert!(best.is_some_and(|best| best.ended == Ended::Stopped && best.x[0] < 0.9));
        assert_eq!(minimise(&[0.9], &options(1, 6), &mut free(|_| f64::INFINITY)), None);
    }
}
