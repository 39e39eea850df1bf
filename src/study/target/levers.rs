//! Choice of the next refinement.

use std::collections::{BTreeMap, BTreeSet};

use super::effects;
use crate::case::Case;
use crate::case::schema::Effect;
use crate::error::Result;
use crate::error::numbers::rounded;
use crate::run::rounding_scales::RoundingScales;
use crate::run::summary::Summary;
use crate::study::companion::error::{SMALL, relative, relative_by_cause};
use crate::study::companion::variant::ErrorCause;
use crate::study::companion::{companion_steps, work};

/// Part of the accuracy that a refinement aims at.
const FILL: f64 = 0.7;
/// Part of the accuracy from which on an effect is simulated.
const SHARE: f64 = 0.25;
/// Largest refinement at once: doublings of the cells of a segment, of those of a bladder, and decades of the tolerance.
const FARTHEST: [i32; 3] = [2, 3, 3];
/// Decades that are added to a tighter tolerance where ten times the tolerance takes at least so many times the steps: loads and outputs
/// decide on the steps there.
const IDLE: i32 = 2;
const STEADY: f64 = 0.95;
/// Finest meshes, and the tightest tolerance in decades.
const FINEST: [usize; 2] = [128, 64];
const TIGHTEST: i32 = 10;
/// Work after twice the beam cells, twice the fluid cells and a decade, over that before.
const WORK: [f64; 3] = [3.0, 2.0, 1.8];
/// Largest cost of a refinement, over that of the run before.
const AT_ONCE: f64 = 5.0;
/// A refinement pays where errors fall at least as the work to this power; and it is preferred to a cheaper one where it leaves less than so
/// much of the error of that.
const PAYS: f64 = -0.25;
const PREFERRED: f64 = 0.8;
/// Work without a smaller error, over that with the smallest.
const PATIENCE: f64 = 4.0;
/// Ratio of an error to the smallest before above which that smallest one is discarded.
const SHOWN: f64 = 2.0;
/// Error above which a quantity is unknown: if a refinement makes it larger, there is no reason for another.
const UNKNOWN: f64 = 1.0;
/// Error above which its size is unreliable; larger errors count as this one in sums.
const SATURATED: f64 = 0.3;
/// Largest work (steps times unknowns) that a refinement is expected to do: so many times that of the first run, and so much.
const LARGEST_WORK: (f64, f64) = (15.0, 3e6);

/// Refinements of a search.
pub struct Levers {
    asked: f64,
    /// Work of the first run.
    first: Option<f64>,
    /// Work and error of each quantity when it last became smaller.
    best: BTreeMap<String, (f64, f64)>,
    /// Quantities whose errors coarse runs do not show.
    shown: BTreeSet<String>,
    /// Steps and decades of the tolerance before the last refinement.
    before: Option<(f64, f64)>,
}

/// A finer case.
pub struct FinerCase {
    /// The case.
    pub case: Case,
    /// Effects that it has more.
    pub added: Vec<Effect>,
}

impl Levers {
    /// For an accuracy.
    pub fn new(asked: f64) -> Self {
        Self {
            asked,
            first: None,
            best: BTreeMap::new(),
            shown: BTreeSet::new(),
            before: None,
        }
    }

    /// The cheapest finer case whose errors should be small enough; nothing where no refinement is wanted, or pays.
    ///
    /// # Errors
    /// As [`System::new`](crate::discrete::System::new).
    pub fn next(&mut self, case: &Case, summary: &Summary, floors: &RoundingScales) -> Result<Option<FinerCase>> {
        let work = work(summary) as f64;
        let first = *self.first.get_or_insert(work);
        let mut large = relative(summary, &summary.errors, floors, SMALL);
        large.retain(|_, error| *error > self.asked);
        if large.is_empty() {
            return Ok(None);
        }
        large.retain(|name, error| !self.is_stuck(name, work, *error));
        let now = (summary.solver.steps as f64, -case.solver.rtol.log10());
        let per_decade = match self.before.replace(now) {
            Some(before) if now.1 > before.1 + 0.5 => (now.0 / before.0).powf(1.0 / (now.1 - before.1)),
            _ => WORK[2],
        };
        let wanted = parts(summary, floors, &large);
        let more = effects::needed(case, summary, [SHARE * self.asked, SMALL])?;
        let budget = ((LARGEST_WORK.0 * first + LARGEST_WORK.1) / work).min(AT_ONCE);
        let [beam, fluid, decades] = self.refinement(case, &wanted, budget, per_decade.max(WORK[2]));
        if [beam, fluid, decades] == [0; 3] && more.is_none() {
            return Ok(None);
        }
        let (mut finer, added) = match more {
            Some(needed) => (needed.case, needed.added.into_keys().collect()),
            None => (case.clone(), vec![]),
        };
        finer.mesh.cells_per_segment <<= beam;
        finer.mesh.cells_per_bladder <<= fluid;
        let steady = companion_steps(summary) >= STEADY * summary.solver.steps as f64;
        let idle = if decades > 0 && steady { IDLE } else { 0 };
        let tighter = case.solver.rtol * 10_f64.powi(-decades - idle);
        finer.solver.rtol = rounded(tighter, 4).max(10_f64.powi(-TIGHTEST));
        Ok(Some(FinerCase { case: finer, added }))
    }

    /// True if the error of a quantity is no longer worth the work; stores its best error. If a finer run shows a much larger error, that error
    /// replaces the best one, once per quantity; unless it exceeds the quantity, as of flows that no mesh resolves.
    fn is_stuck(&mut self, name: &str, work: f64, error: f64) -> bool {
        let best = self.best.entry(name.into()).or_insert((work, error));
        if error > UNKNOWN && error > best.1 {
            return true;
        }
        let falls = error <= best.1 * (work / best.0).powf(PAYS).min(1.0);
        if falls || error > SHOWN * best.1 && self.shown.insert(name.into()) {
            *best = (work, error);
        }
        work > PATIENCE * best.0
    }

    /// Doublings of the beam's cells, of a bladder's cells, and decades: the cheapest that should do, or those that come nearest.
    fn refinement(&self, case: &Case, wanted: &[[f64; 3]], budget: f64, decade: f64) -> [i32; 3] {
        let ratios =
            [ErrorCause::BeamMesh, ErrorCause::FluidMesh, ErrorCause::TimeSteps].map(|cause| cause.falls(case));
        let left = |finer: [i32; 3]| {
            let of = |parts: &[f64; 3]| (0..3).map(|k| parts[k] * ratios[k].powi(finer[k])).sum::<f64>();
            most(wanted.iter().map(of).collect::<Vec<_>>().iter()) / (FILL * self.asked)
        };
        let cost = |[beam, fluid, decades]: [i32; 3]| WORK[0].powi(beam) * WORK[1].powi(fluid) * decade.powi(decades);
        let now = -case.solver.rtol.log10();
        let possible = |[beam, fluid, decades]: [i32; 3]| {
            (case.mesh.cells_per_segment << beam) <= FINEST[0]
                && (case.mesh.cells_per_bladder << fluid) <= FINEST[1]
                && now + f64::from(decades) <= f64::from(TIGHTEST) + 0.5
        };
        let mut best = ([0; 3], left([0; 3]), 1.0);
        for beam in 0..=FARTHEST[0] {
            for fluid in 0..=FARTHEST[1] {
                for decades in 0..=FARTHEST[2] {
                    let finer = [beam, fluid, decades];
                    let (fill, cost) = (left(finer), cost(finer));
                    let better = if fill <= 1.0 {
                        best.1 > 1.0 || cost < best.2
                    } else {
                        fill < PREFERRED * best.1
                    };
                    if possible(finer) && cost <= budget && better {
                        best = (finer, fill, cost);
                    }
                }
            }
        }
        best.0
    }
}

/// Parts of the errors of quantities by cause: beam mesh, fluid mesh and time steps, scaled so that all causes add up to the error.
fn parts(summary: &Summary, floors: &RoundingScales, errors: &BTreeMap<String, f64>) -> Vec<[f64; 3]> {
    let causes = relative_by_cause(summary, floors, SMALL);
    let of = |(name, error): (&String, &f64)| {
        let part = |errors: &BTreeMap<String, f64>| errors.get(name).copied().unwrap_or(0.0);
        let all: f64 = causes.values().map(part).sum();
        let scale = if all > 0.0 { error.min(SATURATED) / all } else { 0.0 };
        let settings = [ErrorCause::BeamMesh, ErrorCause::FluidMesh, ErrorCause::TimeSteps];
        settings.map(|cause| scale * causes.get(cause.pointer().as_str()).map_or(0.0, part))
    };
    errors.iter().map(of).collect()
}

fn most<'a>(errors: impl Iterator<Item = &'a f64>) -> f64 {
    errors.copied().fold(0.0, f64::max)
}
