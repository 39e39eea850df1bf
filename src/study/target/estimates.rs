//! What runs on different meshes, at different tolerances, by different methods and with more effects tell of each other's errors.
//!
//! With `x(K, τ)` a figure on a mesh of K cells a segment at tolerance τ, and ρ how much smaller the next difference is
//! expected to be,
//!
//! ```text
//! e_time    = ρ_τ/(1 - ρ_τ) |x(K, τ) - x(K, 10 τ)|     ρ_τ = |x(K, τ) - x(K, 10 τ)|/|x(K, 10 τ) - x(K, 100 τ)|
//! e_space   = ρ_K/(1 - ρ_K) |x(K, τ) - x(K/2, τ)|      ρ_K = |x(K, τ) - x(K/2, τ)|/|x(K/2, τ) - x(K/4, τ)|
//! e_open    = what the balance leaves open              of the energy put in
//! e_method  = |x(K', τ) - x'(K', τ)|                   x' by a method of higher order, K' = K or coarser
//! e_effects = |x(K', τ') - x"(K', τ')|                 x" with the effects that are left out
//! e         = max(e_time, e_method, e_open) + e_space + e_effects
//! ```
//!
//! The first two are sums of geometric series of differences. Two runs show no ratio: without a third 0.6 of the last difference
//! counts, nearly twice what second order makes of it, so that the difference itself is below what is asked where the estimate
//! fills no more of it than it may. Ratios that no order explains are not believed: of differences that hardly
//! fall ρ is at most 0.7, and one that is small by accident counts as a tenth of the one before. Differences are the largest of
//! a quantity's figures, relative to its largest figure. Meshes of fourth order hold figures of second order too, such as pressures, and sums of
//! both, which are up to 1.8 times what ρ says: so much more counts. What relatives of a run all miss they do not show; another method, and
//! the effects that were left out, are no relatives.
//!
//! Where finer runs go on to differ by a good part of the quantity, the motion is one of many that start nearly alike: it grows
//! from what is no more than round-off, or is chaotic. From then on only its statistics over the window are judged.

use std::collections::{BTreeMap, BTreeSet};

use crate::discrete::quantities::Interest;
use crate::run::summary::{Estimate, Judged, Quantity, Summary};
use crate::study::counted::{Floors, counted, counted_of_ports};

/// Expected ratio of one difference to the one before, where it is not seen: halved cells at second order, and a decade of
/// tolerance between orders 2 and 4.
pub const EXPECTED_RATIO: f64 = 0.25;
/// The same of halved cells at fourth order, beside fluid whose order is lower.
const EXPECTED_OF_FOURTH: f64 = 0.125;
/// Ratios that are believed when seen: beyond them differences happen to be small or large.
const BELIEVED: std::ops::RangeInclusive<f64> = 0.1..=0.7;
/// Part of the last difference that counts where no third run shows how differences fall.
pub const UNSEEN: f64 = 0.6;
/// A difference that is this part of the quantity, on a mesh and at a tolerance that should resolve it, and no more than
/// [`SETTLING`] smaller than the one before: the motion cannot be followed.
pub const LOST: f64 = 0.3;
/// How much smaller differences have to become for a motion to settle.
const SETTLING: f64 = 0.7;
/// A setting that should resolve a motion.
const RESOLVED: At = (8, 5);
/// How a series of meshes is called.
const MESH: &str = "mesh";
/// How much coarser the mesh may be on which methods, or effects, are compared.
const COARSER: usize = 4;

/// One way to compute the case: cells a segment, and `k` of `rtol = 10^-k`.
pub type At = (usize, i32);

/// How a run is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// As a candidate for the result.
    Candidate,
    /// By another method.
    Method,
    /// With the effects that a candidate leaves out.
    Full,
}

/// Runs of one case, and by which of their figures they are judged.
#[derive(Clone, Default)]
pub struct Runs {
    all: BTreeMap<(Way, At), Looked>,
    /// Of meshes, in cells a segment: whether they leave out so much of a shape that no order of differences is to be seen on them.
    unresolved: BTreeMap<usize, bool>,
    floors: Floors,
    /// Whether meshes are of fourth order.
    fourth: bool,
    /// Every figure, until that proves to be too much.
    pub judged_by: Judged,
    /// Why not by every figure.
    pub lost: Option<String>,
}

/// What is looked at of a run.
#[derive(Clone)]
struct Looked {
    quantities: BTreeMap<String, Quantity>,
    /// Those that are more than round-off.
    counted: BTreeSet<String>,
    steps: u64,
}

impl Runs {
    /// None yet, of a case with these sizes of round-off, on meshes of an order.
    pub fn new(floors: Floors, order: u8) -> Self {
        Self {
            floors,
            fourth: order == 4,
            ..Self::default()
        }
    }

    /// Takes in a run that finished.
    pub fn take(&mut self, way: Way, at: At, summary: &Summary) {
        let mut looked = Looked {
            quantities: summary.quantities.clone(),
            counted: counted(summary, &self.floors).map(|(name, _)| name.clone()).collect(),
            steps: summary.solver.steps,
        };
        looked.counted.extend(counted_of_ports(summary, &self.floors).cloned());
        looked.quantities.extend(summary.ports.clone());
        self.all.insert((way, at), looked);
    }

    /// Whether it is known what a mesh leaves out.
    pub fn knows_mesh(&self, cells: usize) -> bool {
        self.unresolved.contains_key(&cells)
    }

    /// Takes it whether a mesh leaves out so much of a shape that no order of differences is to be seen on it.
    pub fn take_mesh(&mut self, cells: usize, unresolved: bool) {
        self.unresolved.insert(cells, unresolved);
    }

    /// Goes over to other candidates, of which nothing is known: with all effects, as those of [`Way::Full`] already are, or
    /// with more of them.
    pub fn go_over(&mut self, all_effects: bool) {
        self.unresolved.clear();
        self.all.retain(|(way, _), _| *way == Way::Full);
        if all_effects {
            let full = std::mem::take(&mut self.all).into_iter();
            self.all = full.map(|((_, at), run)| ((Way::Candidate, at), run)).collect();
        }
    }

    /// Expected ratio of one difference of meshes to the one before.
    pub fn expected(&self) -> f64 {
        if self.fourth {
            EXPECTED_OF_FOURTH
        } else {
            EXPECTED_RATIO
        }
    }

    /// Whether a run is known.
    pub fn hold(&self, way: Way, at: At) -> bool {
        self.all.contains_key(&(way, at))
    }

    /// Steps of a candidate, or of the nearest coarser or looser one.
    pub fn steps(&self, (cells, decades): At) -> Option<u64> {
        let near = self.all.iter().rev();
        let mut near = near.filter(|((way, at), _)| *way == Way::Candidate && at.0 <= cells && at.1 <= decades);
        near.next().map(|(_, run)| run.steps)
    }

    /// A quantity's figures that are judged.
    fn judged(&self, q: &Quantity) -> Vec<(&'static str, f64)> {
        match self.judged_by {
            Judged::Figures => q.figures().collect(),
            Judged::WindowStatistics => q.statistics().collect(),
        }
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
                let settles = last < LOST || before.map_or(what == MESH, |before| last < SETTLING * before);
                (!settles).then(|| format!("{quantity} changes by {last:.1e} from {what} to {what}"))
            };
            apart("rtol", [(cells, decades - 2), (cells, decades - 1), at])
                .or_else(|| apart(MESH, [(cells / 4, decades), (cells / 2, decades), at]))
        };
        let run = self.all.get(&(Way::Candidate, at));
        self.lost = run.and_then(|run| run.counted.iter().find_map(lost));
        if self.lost.is_some() {
            self.judged_by = Judged::WindowStatistics;
        }
    }

    /// Largest change of a quantity's figures between two candidates.
    pub fn difference(&self, quantity: &str, a: At, b: At) -> Option<f64> {
        self.apart(quantity, (Way::Candidate, a), (Way::Candidate, b))
    }

    /// Largest change of a quantity's figures between two runs, relative to its largest figure in the first.
    fn apart(&self, quantity: &str, a: (Way, At), b: (Way, At)) -> Option<f64> {
        let of = |run: (Way, At)| Some(self.judged(self.all.get(&run)?.quantities.get(quantity)?));
        let (a, b) = (of(a)?, of(b)?);
        let size = a.iter().fold(0.0_f64, |s, (_, x)| s.max(x.abs()));
        let other = |figure: &str| b.iter().find(|(name, _)| *name == figure).map_or(0.0, |(_, y)| *y);
        let apart = a.iter().fold(0.0_f64, |d, (name, x)| {
            let apart = (x - other(name)).abs();
            d.max(if apart.is_nan() { f64::INFINITY } else { apart })
        });
        Some(if apart > 0.0 {
            apart / size.max(f64::MIN_POSITIVE)
        } else {
            0.0
        })
    }

    /// What is left over after the last difference of three runs, coarse to fine: see the top of the file.
    fn series(&self, quantity: &str, [coarsest, coarse, fine]: [At; 3], left_over: fn(f64, f64) -> f64) -> Option<f64> {
        let last = self.difference(quantity, fine, coarse)?;
        Some(match self.difference(quantity, coarse, coarsest) {
            None => UNSEEN * last,
            Some(before) => left_over(last, before),
        })
    }

    /// The finest run of a kind that stands for those at a setting, beside a candidate at its own: no more than [`COARSER`], nor
    /// looser than by so many decades.
    fn beside(&self, way: Way, (cells, decades): At, looser: i32) -> Option<At> {
        let all = self.all.keys().filter(|(w, _)| *w == way).map(|(_, at)| *at);
        all.filter(|(k, d)| *k <= cells && COARSER * k >= cells && *d <= decades && d + looser >= decades)
            .filter(|at| self.hold(Way::Candidate, *at))
            .max_by_key(|(k, d)| (*d, *k))
    }

    /// Where another method was compared that stands for a setting.
    pub fn method(&self, at: At) -> Option<At> {
        self.beside(Way::Method, at, 0)
    }

    /// Where the effects left out were looked at that stands for a setting.
    pub fn effects(&self, at: At) -> Option<At> {
        self.beside(Way::Full, at, 1)
    }

    /// What leaving out effects changes in every quantity of a candidate, against the run with them at the same setting.
    pub fn changes(&self, at: At) -> BTreeMap<String, f64> {
        let counted = |way| {
            self.all
                .get(&(way, at))
                .map(|run| run.counted.clone())
                .unwrap_or_default()
        };
        let names: BTreeSet<String> = &counted(Way::Candidate) | &counted(Way::Full);
        let change = |name: String| {
            let apart = self.apart(&name, (Way::Full, at), (Way::Candidate, at));
            (name, apart.unwrap_or(f64::INFINITY))
        };
        names.into_iter().map(change).collect()
    }

    /// Whether three meshes, and three tolerances, are known for a setting.
    pub fn thirds(&self, (cells, decades): At) -> [bool; 2] {
        let hold = |at| self.hold(Way::Candidate, at);
        [hold((cells / 4, decades)), hold((cells, decades - 2))]
    }

    /// What the balance leaves open of the energy put in, relative to its largest figure: that was lost by steps. Of what is harvested
    /// it says little, which is a small part of what the balance is about.
    fn open(&self, name: &str, q: &Quantity) -> f64 {
        if name != Interest::InputEnergy.name() {
            return 0.0;
        }
        let figures = self.judged(q);
        let size = figures.iter().fold(f64::MIN_POSITIVE, |s, (_, x)| s.max(x.abs()));
        let open = |(figure, value): &(&str, f64)| match *figure {
            "final" => value.abs() * q.final_error.unwrap_or(0.0),
            "window" => value.abs() * q.window_error.unwrap_or(0.0),
            _ => 0.0,
        };
        figures.iter().map(open).fold(0.0, f64::max) / size
    }

    /// Errors of every quantity of a candidate that are known.
    pub fn estimates(&self, at: At) -> BTreeMap<String, Estimate> {
        let (cells, decades) = at;
        let Some(run) = self.all.get(&(Way::Candidate, at)) else {
            return BTreeMap::new();
        };
        let changes = self.effects(at).map(|coarse| self.changes(coarse));
        let method = self.method(at);
        let of = |quantity: &String| {
            let time = [(cells, decades - 2), (cells, decades - 1), at];
            let space = [(cells / 4, decades), (cells / 2, decades), at];
            let method = method.and_then(|at| self.apart(quantity, (Way::Method, at), (Way::Candidate, at)));
            let of_meshes = if self.fourth { left_over_of_fourth } else { left_over };
            let (time, space) = (
                self.series(quantity, time, left_over),
                self.series(quantity, space, of_meshes),
            );
            let last = self.difference(quantity, at, (cells / 2, decades));
            let last = last.filter(|_| self.unresolved.get(&cells) == Some(&true));
            let space = space.map(|space| last.map_or(space, |last| space.max(slowly(last))));
            let open = self.open(quantity, &run.quantities[quantity]);
            let time = time.map(|time| method.map_or(time, |method| method.max(time)).max(open));
            let effects = changes.as_ref().map(|all| all.get(quantity).copied().unwrap_or(0.0));
            let estimate = Estimate {
                time,
                space,
                effects,
                method,
                total: time.zip(space).map(|(t, s)| t + s + effects.unwrap_or(0.0)),
            };
            (quantity.clone(), estimate)
        };
        run.counted.iter().map(of).collect()
    }
}

/// `ρ/(1 - ρ)` times the last of two differences, which counts as no less than what an order explains.
fn left_over(last: f64, before: f64) -> f64 {
    let least = BELIEVED.start() * before;
    if last <= least {
        return least * EXPECTED_RATIO / (1.0 - EXPECTED_RATIO);
    }
    let ratio = (last / before).min(*BELIEVED.end());
    last * ratio / (1.0 - ratio)
}

/// The same of meshes of fourth order: a sum of parts of fourth and of second order, whose ratio is between a sixteenth and a quarter, is
/// up to 1.8 times what this ratio says.
fn left_over_of_fourth(last: f64, before: f64) -> f64 {
    let ratio = if before > 0.0 { last / before } else { 1.0 }.min(*BELIEVED.end());
    let mixed = (1.8 - 8.0 * (ratio - 0.15)).clamp(1.0, 1.8);
    (mixed * last * ratio / (1.0 - ratio)).max(left_over(0.0, before))
}

/// What is left over after a difference, where the next hardly fall.
fn slowly(last: f64) -> f64 {
    last * BELIEVED.end() / (1.0 - BELIEVED.end())
}

/// Largest error of integration in time and of the mesh; infinite where one is not known.
pub fn numerical(estimates: &BTreeMap<String, Estimate>) -> f64 {
    let both = |e: &Estimate| e.time.zip(e.space).map_or(f64::INFINITY, |(t, s)| t + s);
    largest(estimates.values().map(both))
}

/// Largest estimate of a quantity; infinite where one is not known.
pub fn worst(estimates: &BTreeMap<String, Estimate>) -> f64 {
    largest(estimates.values().map(|e| e.total.unwrap_or(f64::INFINITY)))
}

/// What is no number is larger than any.
fn largest(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(0.0, |m, x| m.max(if x.is_nan() { f64::INFINITY } else { x }))
}
