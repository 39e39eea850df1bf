//! What runs on different meshes and at different tolerances tell of each other's errors.
//!
//! With `x(K, τ)` a figure on a mesh of K cells a segment at tolerance τ, and ρ how much smaller the next difference is
//! expected to be,
//!
//! ```text
//! e_time  = ρ_τ/(1 - ρ_τ) |x(K, τ) - x(K, 10 τ)|       ρ_τ = |x(K, τ) - x(K, 10 τ)|/|x(K, 10 τ) - x(K, 100 τ)|
//! e_space = ρ_K/(1 - ρ_K) |x(K, τ) - x(K/2, τ)|        ρ_K = |x(K, τ) - x(K/2, τ)|/|x(K/2, τ) - x(K/4, τ)|
//! ```
//!
//! the sums of geometric series of differences. Where the third run is missing ρ is 1/4: second order in space, and in time
//! about what ten times the tolerance does between the orders 2 and 4. An error of a quantity is the largest of its figures',
//! relative to the quantity's largest figure.
//!
//! Where finer runs go on to differ by a good part of the quantity, the motion is one of many that start nearly alike: it grows
//! from what is no more than round-off, or is chaotic. From then on only its statistics over the window are judged.

use std::collections::BTreeMap;

use crate::run::summary::{Estimate, Judged, Summary};
use crate::study::counted::counted;

/// Expected ratio of one difference to the one before, where it is not seen: halved cells at second order, and a decade of
/// tolerance between orders 2 and 4.
pub const EXPECTED_RATIO: f64 = 0.25;
/// Ratios that are believed when seen: beyond them differences happen to be small or large.
const BELIEVED: std::ops::RangeInclusive<f64> = 0.05..=0.7;
/// A difference that is this part of the quantity, on a mesh and at a tolerance that should resolve it, and no more than
/// [`BELIEVED`]'s least part smaller than the one before: the motion cannot be followed.
pub const LOST: f64 = 0.3;
/// A setting that should resolve a motion.
const RESOLVED: At = (8, 5);
/// How a series of meshes is called.
const MESH: &str = "mesh";
/// One way to compute the case: cells a segment, and `k` of `rtol = 10^-k`.
pub type At = (usize, i32);
/// Figures of each quantity of a run.
type Figures = BTreeMap<String, Vec<f64>>;

/// Runs of one case, and by which of their figures they are judged.
#[derive(Default)]
pub struct Runs {
    all: BTreeMap<At, Looked>,
    /// Every figure, until that proves to be too much.
    pub judged_by: Judged,
    /// Why not by every figure.
    pub lost: Option<String>,
}

/// A run, as it is judged by every figure and by statistics.
struct Looked {
    figures: Figures,
    statistics: Figures,
}

impl Runs {
    /// Takes in a run, of a beam of this length [m], that finished.
    pub fn take(&mut self, at: At, summary: &Summary, length: f64) {
        self.all.insert(at, Looked::new(summary, length));
    }

    /// Whether a run is known.
    pub fn hold(&self, at: At) -> bool {
        self.all.contains_key(&at)
    }

    /// A run's figures that are judged.
    fn judged(&self, at: At) -> Option<&Figures> {
        let run = self.all.get(&at)?;
        Some(match self.judged_by {
            Judged::Figures => &run.figures,
            Judged::WindowStatistics => &run.statistics,
        })
    }

    /// Goes over to statistics where a quantity does not settle.
    pub fn lose_sight(&mut self, at: At) {
        let (cells, decades) = at;
        if self.judged_by != Judged::Figures || cells < RESOLVED.0 || decades < RESOLVED.1 {
            return;
        }
        let lost = |quantity: &String| {
            let apart = |what: &str, [coarsest, coarse, fine]: [At; 3]| {
                let last = self.difference(quantity, fine, coarse)?;
                // meshes are a factor of two apart, tolerances ten: a first difference of meshes need not mean much
                let before = self.difference(quantity, coarse, coarsest);
                let settles = last < LOST || before.map_or(what == MESH, |before| last < *BELIEVED.end() * before);
                (!settles).then(|| format!("{quantity} changes by {last:.1e} from {what} to {what}"))
            };
            apart("rtol", [(cells, decades - 2), (cells, decades - 1), at])
                .or_else(|| apart(MESH, [(cells / 4, decades), (cells / 2, decades), at]))
        };
        self.lost = self.judged(at).and_then(|figures| figures.keys().find_map(lost));
        if self.lost.is_some() {
            self.judged_by = Judged::WindowStatistics;
        }
    }

    /// Largest change of a quantity's figures between two runs, relative to its largest figure.
    fn difference(&self, quantity: &str, a: At, b: At) -> Option<f64> {
        let (a, b) = (self.judged(a)?.get(quantity)?, self.judged(b)?.get(quantity)?);
        let size = a.iter().fold(0.0_f64, |s, x| s.max(x.abs()));
        let apart = a.iter().zip(b).fold(0.0_f64, |d, (x, y)| d.max((x - y).abs()));
        Some(if apart > 0.0 {
            apart / size.max(f64::MIN_POSITIVE)
        } else {
            0.0
        })
    }

    /// `ρ/(1 - ρ)` times the last difference of three runs, coarse to fine.
    fn series(&self, quantity: &str, [coarsest, coarse, fine]: [At; 3]) -> Option<f64> {
        let last = self.difference(quantity, fine, coarse)?;
        let ratio = match self.difference(quantity, coarse, coarsest) {
            Some(before) if before > 0.0 => (last / before).clamp(*BELIEVED.start(), *BELIEVED.end()),
            _ => EXPECTED_RATIO,
        };
        Some(last * ratio / (1.0 - ratio))
    }

    /// Errors of every quantity of a run that are known.
    pub fn estimates(&self, at: At) -> BTreeMap<String, Estimate> {
        let (cells, decades) = at;
        let Some(run) = self.judged(at) else {
            return BTreeMap::new();
        };
        let of = |quantity: &String| {
            let time = [(cells, decades - 2), (cells, decades - 1), at];
            let space = [(cells / 4, decades), (cells / 2, decades), at];
            let (time, space) = (self.series(quantity, time), self.series(quantity, space));
            let estimate = Estimate {
                time,
                space,
                total: time.zip(space).map(|(t, s)| t + s),
            };
            (quantity.clone(), estimate)
        };
        run.keys().map(of).collect()
    }
}

impl Looked {
    /// Of the quantities that are more than round-off, of a beam of this length [m].
    fn new(summary: &Summary, length: f64) -> Self {
        let (mut figures, mut statistics) = (Figures::new(), Figures::new());
        for (name, q) in counted(summary, length) {
            figures.insert(name.clone(), q.figures().map(|f| f.1).collect());
            statistics.insert(name.clone(), q.statistics().map(|f| f.1).collect());
        }
        Self { figures, statistics }
    }
}

/// Largest estimate of a quantity; infinite where one is not known.
pub fn worst(estimates: &BTreeMap<String, Estimate>) -> f64 {
    let total = |e: &Estimate| e.total.unwrap_or(f64::INFINITY);
    estimates.values().map(total).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn looked(last: f64, rms: f64) -> Looked {
        let one = |values: Vec<f64>| Figures::from([("tip_u1_m".to_string(), values)]);
        Looked {
            figures: one(vec![last, 1.0, rms]),
            statistics: one(vec![rms]),
        }
    }

    /// A last value that is another one from tolerance to tolerance, with a root mean square that hardly changes: judged by
    /// the latter from then on. One that settles, or that nothing resolves yet, is judged by every figure.
    #[test]
    fn a_motion_that_cannot_be_followed_is_judged_by_statistics() {
        let judge = |at: At, of: [f64; 3]| {
            let (cells, decades) = at;
            let runs = [
                ((cells, decades - 1), of[0]),
                ((cells / 2, decades), of[1]),
                (at, of[2]),
            ];
            let mut runs = Runs {
                all: runs.map(|(at, last)| (at, looked(last, 0.5 + 0.01 * last))).into(),
                ..Runs::default()
            };
            runs.lose_sight(at);
            (runs.judged_by, worst(&runs.estimates(at)))
        };
        let (judged_by, error) = judge((8, 6), [0.9, 0.3, -0.2]);
        assert_eq!(judged_by, Judged::WindowStatistics);
        assert!(error < 0.1, "{error}");
        let (judged_by, error) = judge((8, 3), [0.9, 0.3, -0.2]);
        assert_eq!(judged_by, Judged::Figures);
        assert!(error > 0.1, "{error}");
        assert_eq!(judge((8, 6), [0.9, 0.89, 0.895]).0, Judged::Figures);
    }
}
