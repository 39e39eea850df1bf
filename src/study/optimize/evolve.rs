//! The search by values alone: generations of designs, each on all cores, and what slopes say where it ends.

use std::time::Instant;

use nalgebra::{DMatrix, DVector};

use super::REACHED;
use super::look::{self, Seen};
use super::search::{Reached, Search};
use crate::numerics::cma::{self, Ended as Why, Options, population};
use crate::numerics::exchange::{Worth, order};
use crate::numerics::sqp::{Ended, HELD, Minimum};
use crate::study::span;
use crate::study::sweep::pool;

/// Share of the slope at a best that limits may leave unexplained for what they cost to be told.
const UNEXPLAINED: f64 = 0.05;

/// Deviations between the bounds that count as none.
const CLOSE: f64 = 1e-4;
/// What cannot be computed is worth least.
const NOTHING: Worth = [f64::MAX, f64::INFINITY];
/// Doublings of the population at most.
const DOUBLED: usize = 6;

/// What a design gives, or why nothing, and its wall time [s].
type Computed = (std::result::Result<Vec<f64>, String>, f64);
/// Figures of a generation, nothing of designs that fail.
type Figures = Vec<Option<Vec<f64>>>;

impl Search<'_> {
    /// The best about one place, so many designs at once, and sizes of figures. Each start has twice the population of the one before.
    pub(super) fn evolve(&self, start: usize, from: &[f64], jobs: usize) -> Option<(Minimum, Vec<f64>)> {
        let numbers = from.len();
        let population = population(numbers) << start.min(DOUBLED);
        let options = Options {
            stream: start as u64,
            population,
            generations: 100 + (50.0 * (numbers as f64 + 3.0).powi(2) / (population as f64).sqrt()) as usize,
            close: CLOSE,
            same: self.noise(),
        };
        let mut sizes: Option<Vec<f64>> = None;
        let mut best: Option<(Worth, Vec<f64>, Vec<f64>)> = None;
        let ended = cma::minimise(from, &options, &mut |places| {
            let (all, whole) = self.generation(start, places, jobs)?;
            if let (None, Some(first)) = (&sizes, all.iter().flatten().next()) {
                sizes = Some(self.sizes(first));
            }
            let worth = |figures: &Option<Vec<f64>>| match (figures, &sizes) {
                (Some(figures), Some(sizes)) => {
                    let point = self.level(figures, sizes);
                    let violation = point.violation();
                    [if violation > HELD { violation } else { 0.0 }, point.value]
                }
                _ => NOTHING,
            };
            let worths: Vec<Worth> = all.iter().map(worth).collect();
            // what was computed before an interruption counts too
            for ((figures, place), worth) in all.iter().zip(places).zip(&worths) {
                let better = best.as_ref().is_none_or(|(own, ..)| order(worth, own).is_lt());
                if let (Some(figures), true) = (figures, better) {
                    best = Some((*worth, place.clone(), figures.clone()));
                }
            }
            whole.then_some(worths)
        });
        let ((worth, x, figures), sizes) = (best?, sizes?);
        let minimum = Minimum {
            at: self.level(&figures, &sizes),
            multipliers: vec![0.0; self.problem.limits.len()],
            at_bounds: vec![0.0; numbers],
            ended: match ended.as_ref().map(|one| one.ended) {
                Some(Why::Close | Why::Alike) if worth[0] > 0.0 => Ended::Apart,
                Some(Why::Close | Why::Alike) => Ended::Found,
                _ => Ended::Unfinished,
            },
            steps: ended.map_or(0, |one| one.generations),
            x,
        };
        Some((minimum, sizes))
    }

    /// Designs of a generation in their order, and whether they are all of it.
    fn generation(&self, start: usize, places: &[Vec<f64>], jobs: usize) -> Option<(Figures, bool)> {
        let numbers: Vec<usize> = (0..places.len()).collect();
        let mut all = vec![None; places.len()];
        let one = |k: usize| {
            let begin = Instant::now();
            let figures = look::level(self.problem, &places[k], &|| (self.stop)());
            (!(self.stop)()).then(|| (k, (figures, begin.elapsed().as_secs_f64())))
        };
        pool::each(&numbers, jobs, &one, &mut |(k, found)| {
            all[k] = Some(found);
            Ok(())
        })
        .ok()?;
        let whole = all.iter().all(Option::is_some);
        let kept = |(place, found): (&Vec<f64>, Option<Computed>)| {
            let (figures, wall_s) = found?;
            self.keep(start, &span::values(&self.problem.spans, place), &figures, wall_s);
            figures.ok().filter(|figures| figures.iter().all(|x| x.is_finite()))
        };
        Some((places.iter().zip(all).map(kept).collect(), whole))
    }

    /// Takes exact slopes at the best into what is known of it, where there are any: what holds it there, and what that costs.
    pub(super) fn slopes_there(&self, reached: &mut Reached) {
        let x = reached.minimum.x.clone();
        let searches = reached.starts.len();
        let keep = |values: &[f64], figures: &std::result::Result<Vec<f64>, String>, wall_s: f64| {
            if !(self.stop)() {
                self.keep(searches, values, figures, wall_s);
            }
        };
        let seen = look::exactly(self.problem, &x, &|| (self.stop)(), &keep);
        reached.sloped = false;
        let Some(Ok((_, Some(Seen { slopes, .. })))) = seen else {
            return;
        };
        if slopes.iter().flatten().any(|slope| !slope.is_finite()) {
            return;
        }
        reached.sloped = true;
        let seen = Seen {
            figures: reached.figures.clone(),
            slopes,
            from: super::found::Derivatives::Exact,
        };
        let minimum = &mut reached.minimum;
        minimum.at = self.point(&seen, &reached.sizes);
        let at_bound = |k: usize| x[k] <= 0.0 || x[k] >= 1.0;
        let free: Vec<usize> = (0..x.len()).filter(|k| !at_bound(*k)).collect();
        let limits: Vec<usize> = (0..minimum.at.inequalities.len())
            .filter(|i| minimum.at.inequalities[*i] > -REACHED)
            .collect();
        // least squares: what is left of the slope along numbers that are free
        let a = DMatrix::from_fn(free.len(), limits.len(), |i, j| minimum.at.slopes[(limits[j], free[i])]);
        let g = DVector::from_fn(free.len(), |i, _| -minimum.at.slope[free[i]]);
        if !limits.is_empty() && !free.is_empty() {
            let lambda = a
                .svd(true, true)
                .solve(&g, 1e-9)
                .unwrap_or_else(|_| DVector::zeros(limits.len()));
            limits
                .iter()
                .zip(lambda.iter())
                .for_each(|(i, l)| minimum.multipliers[*i] = l.max(0.0));
        }
        let lambda = DVector::from_column_slice(&minimum.multipliers);
        let slope = &minimum.at.slope + minimum.at.slopes.tr_mul(&lambda);
        let steep = |of: &DVector<f64>| free.iter().map(|k| of[*k].abs()).fold(0.0, f64::max);
        if !self.problem.limits.is_empty() && steep(&slope) > UNEXPLAINED * steep(&minimum.at.slope) {
            // the best lies a little beside a limit that holds it, so that which ones do is not known, nor what they cost
            reached.sloped = false;
            minimum.multipliers.fill(0.0);
            return;
        }
        for k in (0..x.len()).filter(|k| at_bound(*k)) {
            minimum.at_bounds[k] = -slope[k];
        }
    }
}
