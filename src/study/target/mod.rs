//! The cheapest run that has an accuracy: mesh, tolerance and effects are refined where measured errors require it.
//!
//! ```text
//! initial_mesh  the setting to begin with, which sees every load
//! effects       effects that are left out and measured to matter
//! levers        next refinement, by the causes of errors
//! verdict       accuracy reached
//! ```
//!
//! Every run has a companion ([`companion`](super::companion)). Where that shows errors above the accuracy, each cause is measured by a
//! run with one change; the orders of the methods give the refinement of each, and the refined run follows. A search ends where all
//! errors are small enough, where a refinement does not make them smaller, or where the next one is too expensive.

pub mod effects;
pub mod initial_mesh;
pub mod levers;
mod verdict;

use crate::case::Case;
use crate::case::schema::Effect;
use crate::discrete::System;
use crate::error::{Code, Result};
use crate::integrate::halt;
use crate::run::dynamics::Outcome;
use crate::run::rounding_scales::RoundingScales;
use crate::run::summary::{Accuracy, PilotRun, Status, Summary};
use crate::study::companion::Accurate;
use crate::study::effects::full_model::full;
use levers::Levers;

/// Part of the accuracy asked that leaving out an effect may take by its number, unless the case sets it.
const EFFECTS: f64 = 0.1;
/// Most runs of a search.
const RUNS: usize = 7;

/// Runs a case into a result, with its errors and their causes ([`companion::measured`](super::companion::measured)).
pub type Record<'a> = &'a mut dyn FnMut(&Case, &Accurate) -> Result<Outcome>;

/// Runs the case so that the measured error of each of its quantities, probes and ports is below `asked`, relative to its size.
///
/// `record` runs a case into a result, over an earlier one only when it finishes; the last that finished counts. A search begins with the
/// setting that a similar case needed, where one is given.
///
/// # Errors
/// Those of `record`.
pub fn reach(case: &Case, asked: f64, from: Option<&ReachedSetting>, record: Record) -> Result<Outcome> {
    let mut case = case.clone();
    case.effects_tolerance.get_or_insert(EFFECTS * asked);
    let mut case = initial_mesh::setting(&case, asked)?;
    if let Some(from) = from {
        case = from.refined_case(&case).unwrap_or(case);
    }
    let mut wanted = Accurate::new(asked);
    let mut outcome = record(&case, &wanted)?;
    let mut added: Vec<Effect> = vec![];
    if outcome.summary.status == Status::Failed
        && let Some(full) = full(&case)?
    {
        (case, added) = (full.case, full.left_out);
        outcome = record(&case, &wanted)?;
    }
    if outcome.summary.status != Status::Finished {
        let why = "accuracy: nothing is known of the errors of a run that did not finish";
        outcome.summary.warnings.push(Code::Accuracy.warning(why));
        return Ok(outcome);
    }
    let floors = RoundingScales::from_case(&case)?;
    let mut levers = Levers::new(asked);
    let (mut pilots, mut cut_short) = (vec![], None);
    while pilots.len() + 1 < RUNS {
        let Some(next) = levers.next(&case, &outcome.summary, &floors)? else {
            break;
        };
        wanted.expect(&outcome.summary, &case, &next.case);
        let finer = record(&next.case, &wanted)?;
        if finer.summary.status != Status::Finished {
            cut_short = finer.summary.reason;
            break;
        }
        added.extend(next.added);
        pilots.push(pilot(&case, &outcome.summary));
        (case, outcome) = (next.case, finer);
    }
    if halt::asked() {
        cut_short.get_or_insert("interrupted".into());
    }
    verdict::conclude(&case, asked, &floors, pilots, &added, cut_short, &mut outcome.summary);
    Ok(outcome)
}

/// Mesh and tolerance that an accuracy led to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachedSetting {
    cells_per_segment: usize,
    cells_per_bladder: usize,
    order: u8,
    rtol: f64,
}

impl ReachedSetting {
    /// That of a search.
    pub fn found(accuracy: &Accuracy) -> Self {
        Self {
            cells_per_segment: accuracy.cells_per_segment,
            cells_per_bladder: accuracy.cells_per_bladder,
            order: accuracy.order,
            rtol: accuracy.rtol,
        }
    }

    /// A case so computed; nothing where it cannot be.
    fn refined_case(&self, case: &Case) -> Option<Case> {
        let mut case = case.clone();
        case.mesh.cells_per_segment = self.cells_per_segment;
        case.mesh.cells_per_bladder = self.cells_per_bladder;
        case.mesh.order = Some(self.order);
        case.solver.rtol = self.rtol;
        System::new(&case).is_ok().then_some(case)
    }
}

fn pilot(case: &Case, summary: &Summary) -> PilotRun {
    PilotRun {
        cells_per_segment: case.mesh.cells_per_segment,
        cells_per_bladder: case.mesh.cells_per_bladder,
        rtol: case.solver.rtol,
        unknowns: summary.unknowns,
        steps: summary.solver.steps,
        wall_s: summary.wall_s.total,
    }
}
