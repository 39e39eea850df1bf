//! Named numbers with estimated errors, for analyses other than runs: equilibria, modes, cycles, multipliers.
//!
//! With `x(K, G, τ)` a number on a mesh of K cells per segment and G per bladder at tolerance τ,
//!
//! ```text
//! e_beam = S ρ/(1 - ρ) |x(K) - x(K/2)|      ρ = |x(K) - x(K/2)|/|x(K/2) - x(K/4)|      likewise with G/2, G/4 and 10 τ, 100 τ
//! ```
//!
//! the sum of the geometric series of differences, with a safety factor S. A mesh is accepted only if its half and quarter were computed, a
//! tolerance only if ten times and a hundred times it were. The axis with the largest error is refined. An error below a tenth of the
//! requested accuracy is not computed again while others are refined.

pub mod meshes;
pub mod numbers;

use std::collections::BTreeMap;
use std::time::Instant;

use super::accuracy::plan;
use crate::case::Case;
use crate::case::schema::Effect;
use crate::discrete::{BeamMesh, System, resolution};
use crate::error::numbers::error_percent as percent;
use crate::error::{Code, Result};
use crate::model::Model;
use crate::run::summary::{Accuracy, ErrorEstimate, PilotRun};

/// Finest meshes and tightest tolerance: cells per segment, cells per bladder, decades.
const FINEST: usize = 64;
const FINEST_ALONG_BLADDERS: usize = 64;
const TIGHTEST: i32 = 9;
/// Initial mesh and tolerance.
const FIRST: At = At {
    cells: 4,
    along: None,
    decades: 5,
};
/// Initial cells per bladder: their quarter is one.
const FIRST_ALONG_BLADDERS: usize = 4;
/// Finest initial mesh, if coarser ones have no result.
const LAST_FIRST: usize = 16;
/// Range of accepted ratios of differences: outside it, differences are small or large by chance.
const BELIEVED: [f64; 2] = [0.2, 0.7];
/// Share of the requested accuracy below which an error is not computed again.
const SETTLED: f64 = 0.1;
/// Safety factor of an estimate.
const SAFETY: f64 = 1.25;
/// Range of reasonable accuracies, dimensionless.
const SENSIBLE: std::ops::RangeInclusive<f64> = 1e-6..=0.5;

/// Cells per segment, cells per bladder if flows along bladders are resolved, and `k` of `rtol = 10^-k`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct At {
    cells: usize,
    along: Option<usize>,
    decades: i32,
}

/// Axis of refinement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    Bladders,
    Beam,
    Time,
}

impl At {
    /// Returns the setting that is finer by `finer` factors of two, or of ten for the tolerance; coarser if negative.
    fn moved(self, axis: Axis, finer: i32) -> Self {
        let times = |count: usize| {
            if finer < 0 { count >> -finer } else { count << finer }
        };
        let mut at = self;
        match axis {
            Axis::Bladders => at.along = self.along.map(times),
            Axis::Beam => at.cells = times(self.cells),
            Axis::Time => at.decades += finer,
        }
        at
    }

    fn possible(self) -> bool {
        let along = self.along.is_none_or(|along| along <= FINEST_ALONG_BLADDERS);
        along && self.cells <= FINEST && self.decades <= TIGHTEST
    }
}

/// Computed number, and the reference size of its error if the number itself is smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencedNumber {
    /// Its value.
    pub value: f64,
    /// Reference size.
    pub size: f64,
}

impl ReferencedNumber {
    /// Creates a number with its reference size.
    pub fn new(value: f64, size: f64) -> Self {
        Self { value, size }
    }

    /// Size to which errors refer: the larger of number and reference size.
    pub fn counted(&self) -> f64 {
        self.value.abs().max(self.size).max(f64::MIN_POSITIVE)
    }
}

/// Numbers by name.
pub type RefinedNumbers = BTreeMap<String, ReferencedNumber>;

/// [`refine`] if an accuracy is requested.
///
/// # Errors
/// Those of [`refine`].
pub fn if_asked(
    case: &Case,
    asked: Option<f64>,
    in_time: bool,
    compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>,
) -> Result<Option<(Case, Accuracy)>> {
    asked.map(|asked| refine(case, asked, in_time, compute)).transpose()
}

/// Finds the mesh, and the tolerance if `in_time`, at which every number of `compute` has an estimated relative error below `asked`.
/// Returns the case with these settings, and the accuracy.
///
/// # Errors
/// Those of `compute` on the initial mesh. If a finer mesh fails, the last one is used.
pub fn refine(
    case: &Case,
    asked: f64,
    in_time: bool,
    compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>,
) -> Result<(Case, Accuracy)> {
    let case = &plan::of_best_order(case);
    let along = has_cells_along_bladders(case)?;
    let mut search = Search {
        case,
        axes: [(Axis::Bladders, along), (Axis::Beam, true), (Axis::Time, in_time)]
            .into_iter()
            .filter_map(|(axis, there)| there.then_some(axis))
            .collect(),
        in_time,
        runs: BTreeMap::new(),
        known: vec![],
        pilots: vec![],
    };
    // a quarter of the cells must allow the same order
    let cells = (4 * BeamMesh::fewest(case.mesh.order())).div_ceil(case.segments());
    let mut at = At {
        along: along.then_some(FIRST_ALONG_BLADDERS),
        cells: FIRST.cells.max(cells.next_power_of_two()),
        ..FIRST
    };
    // meshes that do not see a load or a taper agree about it
    let begun = search.variant(at);
    let [seeing, _] = resolution::cells_that_resolve(&begun, &System::new(&begun)?);
    at.cells = at.cells.max(seeing.next_power_of_two().min(FINEST));
    // a coarse mesh may have no result: fewer modes than requested, no equilibrium
    let settled = SETTLED * asked;
    while let Err(fault) = search.look(at, settled, compute) {
        if at.cells >= LAST_FIRST.max(cells) {
            return Err(fault);
        }
        at.cells *= 2;
    }
    let mut estimates = search.estimates(at);
    while largest(&estimates) > asked {
        let Some(next) = search.next(at, asked) else { break };
        if search.look(next, settled, compute).is_err() {
            break;
        }
        at = next;
        estimates = search.estimates(at);
    }
    let case = search.variant(at);
    let accuracy = Accuracy {
        asked,
        reached: largest(&estimates) <= asked,
        cells_per_segment: case.mesh.cells_per_segment,
        cells_per_bladder: case.mesh.cells_per_bladder,
        order: case.mesh.order(),
        rtol: case.solver.rtol,
        effects: String::new(),
        quantities: estimates,
        pilots: search.pilots,
    };
    Ok((case, accuracy))
}

/// True if an accuracy is reasonable.
pub fn sensible(asked: f64) -> bool {
    SENSIBLE.contains(&asked)
}

/// Warns if an accuracy is not reached.
pub fn warning(found: &Accuracy) -> Option<String> {
    let short = |(name, e): (&String, &ErrorEstimate)| {
        let parts = [
            ("time steps", e.time),
            ("meshes", e.space),
            ("effects left out", e.effects),
        ];
        let parts = parts.into_iter().filter_map(|(cause, part)| Some((cause, part?)));
        let worst = parts.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, part)| *part > 0.0);
        let by = worst.map_or(String::new(), |(cause, _)| format!(", limited by {cause}"));
        match e.total {
            Some(total) if total <= found.asked => None,
            Some(total) => Some(format!("{name} ± {}{by}", percent(total))),
            None => Some(format!("{name} unknown")),
        }
    };
    let short: Vec<String> = found.quantities.iter().filter_map(short).collect();
    let what = match short.as_slice() {
        [] => "no error is known".into(),
        all => all.join("; "),
    };
    (!found.reached).then(|| {
        Code::Accuracy.warning(format!(
            "accuracy {:e} is not reached with {}, {} per bladder and rtol {:e}: {what}",
            found.asked,
            found.cells(),
            found.cells_per_bladder,
            found.rtol,
        ))
    })
}

/// True if a case has cells along its bladders: flow within them, and the effect that retains it.
pub fn has_cells_along_bladders(case: &Case) -> Result<bool> {
    // second-order meshes exist for every model
    let mut second = case.clone();
    second.mesh.order = None;
    let system = System::with(&second, Model::whole(&second, true)?)?;
    let flows = system.fluid.as_ref().is_some_and(|fluid| !fluid.flowing.is_empty());
    Ok(flows && system.model.effects.has(Effect::FlowAlongBladders))
}

/// The case with twice the cells along its bladders, if there are any.
pub fn finer_along_bladders(case: &Case) -> Result<Option<Case>> {
    let mut finer = case.clone();
    finer.mesh.cells_per_bladder *= 2;
    Ok(has_cells_along_bladders(case)?.then_some(finer))
}

/// Relative errors by name; `None` if unknown.
type Errors = BTreeMap<String, Option<f64>>;

struct Search<'a> {
    case: &'a Case,
    axes: Vec<Axis>,
    in_time: bool,
    runs: BTreeMap<At, RefinedNumbers>,
    /// Errors of every axis, in the order of `axes`.
    known: Vec<Errors>,
    pilots: Vec<PilotRun>,
}

impl Search<'_> {
    fn variant(&self, at: At) -> Case {
        let rtol = if self.in_time {
            10_f64.powi(-at.decades)
        } else {
            self.case.solver.rtol
        };
        let mut case = plan::refined(self.case, at.cells, rtol);
        if let Some(along) = at.along {
            case.mesh.cells_per_bladder = along;
        }
        case
    }

    /// Computes the results from which the errors of a setting are estimated.
    fn look(&mut self, at: At, settled: f64, compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>) -> Result<()> {
        // at first, coarse before fine
        if self.known.is_empty() {
            for &axis in &self.axes.clone() {
                for coarser in [-2, -1] {
                    self.run(at.moved(axis, coarser), compute)?;
                }
            }
        }
        self.run(at, compute)?;
        let mut known = vec![];
        for (k, &axis) in self.axes.clone().iter().enumerate() {
            let names = self.runs.get(&at).into_iter().flat_map(BTreeMap::keys);
            let small = |errors: &Errors| {
                let error = |name: &String| errors.get(name).copied().flatten();
                names.clone().all(|name| error(name).is_some_and(|e| e <= settled))
            };
            if let Some(before) = self.known.get(k).filter(|errors| small(errors)) {
                known.push(before.clone());
                continue;
            }
            for coarser in [-2, -1] {
                self.run(at.moved(axis, coarser), compute)?;
            }
            known.push(self.errors(at, axis));
        }
        self.known = known;
        Ok(())
    }

    /// Refines the axis with the largest error; `None` if the errors of axes that cannot be refined exceed the accuracy.
    fn next(&self, at: At, asked: f64) -> Option<At> {
        let mut worst: Vec<(f64, At)> = self
            .axes
            .iter()
            .zip(&self.known)
            .map(|(axis, errors)| (most(errors.values().copied()), at.moved(*axis, 1)))
            .collect();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        let stuck: f64 = worst
            .iter()
            .filter(|(_, to)| !to.possible())
            .map(|(error, _)| error)
            .sum();
        let best = worst.into_iter().find(|(error, to)| *error > 0.0 && to.possible())?;
        (stuck <= asked).then_some(best.1)
    }

    fn run(&mut self, at: At, compute: &mut dyn FnMut(&Case) -> Result<RefinedNumbers>) -> Result<()> {
        if self.runs.contains_key(&at) {
            return Ok(());
        }
        let (case, begin) = (self.variant(at), Instant::now());
        let numbers = compute(&case)?;
        self.runs.insert(at, numbers);
        self.pilots.push(PilotRun {
            unknowns: 0,
            cells_per_segment: at.cells,
            cells_per_bladder: case.mesh.cells_per_bladder,
            rtol: case.solver.rtol,
            steps: 0,
            wall_s: begin.elapsed().as_secs_f64(),
        });
        Ok(())
    }

    fn errors(&self, at: At, axis: Axis) -> Errors {
        let numbers = self.runs.get(&at).into_iter().flatten();
        let before = [at.moved(axis, -2), at.moved(axis, -1)];
        numbers
            .map(|(name, number)| (name.clone(), self.series(name, number, before)))
            .collect()
    }

    fn estimates(&self, at: At) -> BTreeMap<String, ErrorEstimate> {
        let names = self.runs.get(&at).into_iter().flat_map(BTreeMap::keys);
        let of = |name: &String| {
            let along = |wanted: fn(Axis) -> bool| {
                let chosen = self.axes.iter().zip(&self.known).filter(|(axis, _)| wanted(**axis));
                let errors = chosen.map(|(_, errors)| errors.get(name).copied().flatten());
                errors.reduce(|a, b| Some(a? + b?)).flatten()
            };
            let (space, time) = (along(|axis| axis != Axis::Time), along(|axis| axis == Axis::Time));
            let estimate = ErrorEstimate {
                time,
                space,
                total: if self.in_time {
                    time.zip(space).map(|(t, s)| t + s)
                } else {
                    space
                },
                ..ErrorEstimate::default()
            };
            (name.clone(), estimate)
        };
        names.map(of).collect()
    }

    /// Error of a number, relative to it, from its values at two coarser settings.
    fn series(&self, name: &str, number: &ReferencedNumber, [coarsest, coarse]: [At; 2]) -> Option<f64> {
        let value = |at: At| Some(self.runs.get(&at)?.get(name)?.value);
        let (coarsest, coarse) = (value(coarsest)?, value(coarse)?);
        let (before, last) = ((coarse - coarsest).abs(), (number.value - coarse).abs());
        if last == 0.0 {
            return Some(0.0);
        }
        let [least, most] = BELIEVED;
        let ratio = if before > 0.0 {
            (last / before).clamp(least, most)
        } else {
            most
        };
        let size = number.counted();
        Some(SAFETY * ratio / (1.0 - ratio) * last / size).filter(|e| e.is_finite())
    }
}

fn largest(estimates: &BTreeMap<String, ErrorEstimate>) -> f64 {
    most(estimates.values().map(|e| e.total))
}

/// Largest error; infinite if one is unknown.
fn most(errors: impl Iterator<Item = Option<f64>>) -> f64 {
    errors.map(|e| e.unwrap_or(f64::INFINITY)).fold(0.0, f64::max)
}
