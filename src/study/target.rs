//! The cheapest run that has an accuracy: mesh and tolerance chosen by error estimates from a few cheaper runs.
//!
//! With `x(K, τ)` a figure on a mesh of K cells a segment at tolerance τ, and ρ how much smaller the next difference is
//! expected to be,
//!
//! ```text
//! e_time  = ρ_τ/(1 - ρ_τ) |x(K, τ) - x(K, 10 τ)|       ρ_τ = |x(K, τ) - x(K, 10 τ)|/|x(K, 10 τ) - x(K, 100 τ)|
//! e_space = ρ_K/(1 - ρ_K) |x(K, τ) - x(K/2, τ)|        ρ_K = |x(K, τ) - x(K/2, τ)|/|x(K/2, τ) - x(K/4, τ)|
//! ```
//!
//! the sums of geometric series of differences. Where the third run is missing ρ is 0.3, between the 10^(-2/3) of BDF 2, the
//! 1/4 of second order in space, and what rougher quantities do. An error of a quantity is the largest of its figures',
//! relative to the quantity's largest figure.
//!
//! Where finer runs go on to differ by a good part of the quantity, the motion is one of many that start nearly alike: it grows
//! from what is no more than round-off, or is chaotic. From then on only its statistics over the window are judged.

use std::collections::BTreeMap;

use super::accuracy::plan;
use crate::case::Case;
use crate::error::Result;
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::run::summary::{Accuracy, Estimate, Judged, Pilot, Quantity, Status, Summary};

/// Finest mesh and tightest tolerance that are tried: cells a segment, decades.
const FINEST: usize = 64;
const TIGHTEST: i32 = 9;
/// Expected ratio of one difference to the one before, where it is not seen.
const EXPECTED_RATIO: f64 = 0.3;
/// Ratios that are believed when seen: beyond them differences happen to be small or large.
const BELIEVED: std::ops::RangeInclusive<f64> = 0.1..=0.7;
/// Part of the accuracy asked that an estimate may fill: estimates are no bounds.
const FILL: f64 = 0.6;
/// A difference that is this part of the quantity, on a mesh and at a tolerance that should resolve it, and no more than
/// [`BELIEVED`]'s least part smaller than the one before: the motion cannot be followed.
const LOST: f64 = 0.3;
const RESOLVED: At = (8, 5);
const MESH: &str = "mesh";
/// Quantities whose size is below this part of others of their unit are round-off.
const NOTHING: f64 = 1e-6;

/// One way to compute the case: cells a segment, and `k` of `rtol = 10^-k`.
type At = (usize, i32);
/// Figures of each quantity of a run.
type Figures = BTreeMap<String, Vec<f64>>;

/// Asked before every step whether to go on.
pub type Hook<'a> = &'a dyn Fn(&Progress) -> Control;
/// Runs a case into a result and returns how it ended.
pub type Record<'a> = &'a mut dyn FnMut(&Case) -> Result<Outcome>;

struct Search<'a> {
    case: &'a Case,
    asked: f64,
    hook: Hook<'a>,
    runs: BTreeMap<At, Looked>,
    pilots: Vec<Pilot>,
    judged_by: Judged,
    /// Why not by every figure.
    lost: Option<String>,
}

/// A run, as it is judged by every figure and by statistics.
struct Looked {
    figures: Figures,
    statistics: Figures,
}

/// The case on a mesh at a tolerance.
fn variant(case: &Case, (cells, decades): At) -> Case {
    plan::refined(case, cells, 10_f64.powi(-decades))
}

/// Runs the case so that the estimated error of each of its quantities is below `asked`, relative to the quantity's size.
///
/// `record` runs a case into a result, over an earlier one only when it finishes; the last that finished counts, and its
/// summary carries the estimates. `hook` may stop everything: what was recorded then stands, with what is known of it.
pub fn reach(case: &Case, asked: f64, hook: Hook, record: Record) -> Result<Outcome> {
    let mut search = Search {
        case,
        asked,
        hook,
        runs: BTreeMap::new(),
        pilots: vec![],
        judged_by: Judged::Figures,
        lost: None,
    };
    let mut at: At = (2, 3);
    let mut recorded = at;
    let mut outcome = record(&variant(case, at))?;
    if outcome.summary.status != Status::Finished {
        let why = "accuracy: nothing is known of the errors of a run that did not finish";
        outcome.summary.warnings.push(why.into());
        return Ok(outcome);
    }
    search.runs.insert(at, Looked::new(&outcome.summary));
    let cut_short = loop {
        if let Some(reason) = search.compare_with_cheaper(at)? {
            break Some(reason);
        }
        search.lose_sight(at);
        let estimates = search.estimates(at);
        let next = search.cheapest(at, &estimates);
        let sure = match next {
            Some((next, sure)) if search.fill(&estimates) > FILL => {
                at = next;
                sure
            }
            _ if recorded == at => break None,
            _ => true,
        };
        if !sure {
            if let Some(reason) = search.run(at)? {
                break Some(reason);
            }
            continue;
        }
        let finer = record(&variant(case, at))?;
        if finer.summary.status != Status::Finished {
            break finer.summary.reason;
        }
        search.pilots.push(pilot(recorded, &outcome.summary));
        search.runs.insert(at, Looked::new(&finer.summary));
        (recorded, outcome) = (at, finer);
    };
    search.conclude(recorded, cut_short, &mut outcome.summary);
    Ok(outcome)
}

impl Search<'_> {
    /// Runs a setting without recording, unless it has been run. Returns why everything must stop, if it must.
    fn run(&mut self, at: At) -> Result<Option<String>> {
        if self.runs.contains_key(&at) {
            return Ok(None);
        }
        let mut watch = Watch {
            hook: self.hook,
            stopped: None,
        };
        let summary = dynamics::run(&variant(self.case, at), &mut watch)?.summary;
        self.pilots.push(pilot(at, &summary));
        if summary.status == Status::Finished {
            self.runs.insert(at, Looked::new(&summary));
        }
        Ok(watch.stopped)
    }

    /// The two runs that the errors of one are estimated by.
    fn compare_with_cheaper(&mut self, (cells, decades): At) -> Result<Option<String>> {
        for cheaper in [(cells / 2, decades), (cells, decades - 1)] {
            let stopped = self.run(cheaper)?;
            if stopped.is_some() {
                return Ok(stopped);
            }
        }
        Ok(None)
    }

    /// A run's figures that are judged.
    fn judged(&self, at: At) -> Option<&Figures> {
        let run = self.runs.get(&at)?;
        Some(match self.judged_by {
            Judged::Figures => &run.figures,
            Judged::WindowStatistics => &run.statistics,
        })
    }

    /// Goes over to statistics where a quantity does not settle.
    fn lose_sight(&mut self, at: At) {
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
    fn estimates(&self, at: At) -> BTreeMap<String, Estimate> {
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

    /// Largest estimate over what is asked; infinite where one is not known.
    fn fill(&self, estimates: &BTreeMap<String, Estimate>) -> f64 {
        let total = |e: &Estimate| e.total.unwrap_or(f64::INFINITY) / self.asked;
        estimates.values().map(total).fold(0.0, f64::max)
    }

    /// The cheapest finer setting that should do, and whether it should; one step towards it where that is far.
    fn cheapest(&self, (cells, decades): At, estimates: &BTreeMap<String, Estimate>) -> Option<(At, bool)> {
        let predicted = |refinements: i32, tighter: i32| {
            let part = |error: Option<f64>, steps: i32| error.unwrap_or(1.0) * EXPECTED_RATIO.powi(steps);
            let total = |e: &Estimate| part(e.space, refinements) + part(e.time, tighter);
            estimates.values().map(total).fold(0.0, f64::max) / self.asked
        };
        // Twice the cells are four times the work: unknowns, and steps through stiffness. A decade is 10^(1/3) of steps.
        let cost = |refinements: i32, tighter: i32| 4_f64.powi(refinements) * 10_f64.powf(f64::from(tighter) / 3.0);
        let mut best: Option<((i32, i32), f64, f64)> = None;
        for refinements in 0..=6 {
            for tighter in 0..=6 {
                let (fill, cost) = (predicted(refinements, tighter), cost(refinements, tighter));
                let possible = cells << refinements <= FINEST && decades + tighter <= TIGHTEST;
                let better = best.is_none_or(|(_, f, c)| if fill <= FILL { f > FILL || cost < c } else { fill < f });
                if possible && (refinements, tighter) != (0, 0) && better {
                    best = Some(((refinements, tighter), fill, cost));
                }
            }
        }
        let ((refinements, tighter), fill, _) = best?;
        let step = (refinements.min(1), tighter.min(2));
        let sure = fill <= FILL && step == (refinements, tighter);
        Some(((cells << step.0, decades + step.1), sure))
    }

    fn conclude(&self, at: At, cut_short: Option<String>, summary: &mut Summary) {
        let (cells, decades) = at;
        let estimates = self.estimates(at);
        let reached = self.fill(&estimates) <= 1.0;
        if let Some(reason) = cut_short {
            summary
                .warnings
                .push(format!("accuracy: the search was cut short: {reason}"));
        }
        if !reached {
            let short = |(name, e): (&String, &Estimate)| match e.total {
                Some(total) if total > self.asked => Some(format!("{name} {total:.1e}")),
                Some(_) => None,
                None => Some(format!("{name} unknown")),
            };
            let short: Vec<String> = estimates.iter().filter_map(short).collect();
            summary.warnings.push(format!(
                "accuracy: {:e} is not reached with {cells} cells a segment and rtol 1e-{decades}: {}",
                self.asked,
                short.join(", ")
            ));
        }
        if let Some(lost) = &self.lost {
            let grows = summary
                .growth
                .as_ref()
                .map_or(String::new(), |g| format!(" (it grows at {:.2} 1/s)", g.rate_per_s));
            summary.warnings.push(format!(
                "accuracy: {lost}: the motion{grows} is one of many that start alike, and cannot be followed to the end. Judged are root \
                 mean squares and increments over the window, not single values"
            ));
        }
        summary.accuracy = Some(Accuracy {
            asked: self.asked,
            reached,
            cells_per_segment: cells,
            cells_per_bladder: plan::fluid_cells(cells),
            rtol: 10_f64.powi(-decades),
            judged_by: self.judged_by,
            quantities: estimates,
            pilots: self.pilots.clone(),
        });
    }
}

fn pilot((cells, decades): At, summary: &Summary) -> Pilot {
    Pilot {
        cells_per_segment: cells,
        rtol: 10_f64.powi(-decades),
        steps: summary.solver.steps,
        wall_s: summary.wall_s.total,
    }
}

impl Looked {
    /// Of the quantities that are more than round-off beside others of their unit.
    fn new(summary: &Summary) -> Self {
        let size = |q: &Quantity| q.figures().fold(0.0_f64, |s, (_, x)| s.max(x.abs()));
        let all = &summary.quantities;
        let counts = |name: &str, q: &Quantity| {
            let unit = |n: &str| n.rsplit('_').next().map(str::to_owned);
            let alike = all.iter().filter(|(other, _)| unit(other) == unit(name));
            let largest = alike.map(|(_, q)| size(q)).fold(0.0, f64::max);
            size(q) > NOTHING * largest
        };
        let counted = all.iter().filter(|(name, q)| counts(name, q));
        let (mut figures, mut statistics) = (Figures::new(), Figures::new());
        for (name, q) in counted {
            figures.insert(name.clone(), q.figures().map(|f| f.1).collect());
            statistics.insert(name.clone(), q.statistics().map(|f| f.1).collect());
        }
        Self { figures, statistics }
    }
}

/// Records nothing, passes progress on.
struct Watch<'a> {
    hook: Hook<'a>,
    stopped: Option<String>,
}

impl Recorder for Watch<'_> {
    fn begin(&mut self, _: &Header) -> Result<()> {
        Ok(())
    }
    fn history(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }
    fn fields(&mut self, _: f64, _: &[&[f64]]) -> Result<()> {
        Ok(())
    }
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        let control = (self.hook)(progress);
        if let Control::Stop(reason) = &control {
            self.stopped = Some(reason.clone());
        }
        Ok(control)
    }
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
        let case = crate::case::load("cases/dry-cantilever.json".as_ref(), &[])
            .expect("a case")
            .case;
        let hook = |_: &Progress| Control::Continue;
        let judge = |at: At, of: [f64; 3]| {
            let (cells, decades) = at;
            let runs = [
                ((cells, decades - 1), of[0]),
                ((cells / 2, decades), of[1]),
                (at, of[2]),
            ];
            let mut search = Search {
                case: &case,
                asked: 0.1,
                hook: &hook,
                runs: runs.map(|(at, last)| (at, looked(last, 0.5 + 0.01 * last))).into(),
                pilots: vec![],
                judged_by: Judged::Figures,
                lost: None,
            };
            search.lose_sight(at);
            (search.judged_by, search.fill(&search.estimates(at)))
        };
        let (judged_by, fill) = judge((8, 6), [0.9, 0.3, -0.2]);
        assert_eq!(judged_by, Judged::WindowStatistics);
        assert!(fill < 1.0, "{fill}");
        let (judged_by, fill) = judge((8, 3), [0.9, 0.3, -0.2]);
        assert_eq!(judged_by, Judged::Figures);
        assert!(fill > 1.0, "{fill}");
        assert_eq!(judge((8, 6), [0.9, 0.89, 0.895]).0, Judged::Figures);
    }
}
