//! The cheapest run that has an accuracy: mesh, tolerance and effects chosen by error estimates from a few cheaper runs.
//!
//! ```text
//! first       the mesh to begin with, which sees every load
//! estimates   what runs tell of each other's errors
//! search      the runs that a candidate is judged by, and what to try next
//! models      which effects are left out, and the cases that have them
//! left_out    what they change, and whether to take them in
//! verdict     what is said in the end
//! ```

pub mod estimates;
pub mod first;
mod left_out;
pub mod models;
mod search;
mod verdict;

use crate::case::Case;
use crate::error::{Code, Result};
use crate::run::dynamics::Outcome;
use crate::run::record::{Control, Progress};
use crate::run::summary::Status;

use estimates::{At, Way, numerical};
use left_out::Look;
use search::{FILL, Ran, Search};

/// Part of the accuracy asked that leaving out an effect may take by its number, unless the case says.
const EFFECTS: f64 = 0.1;
/// Tolerance to begin with, in decades.
const LOOSEST: i32 = 3;

/// Asked before every step whether to go on.
pub type Hook<'a> = &'a dyn Fn(&Progress) -> Control;
/// Runs a case into a result and returns how it ended.
pub type Record<'a> = &'a mut dyn FnMut(&Case) -> Result<Outcome>;

/// Runs the case so that the estimated error of each of its quantities is below `asked`, relative to the quantity's size.
///
/// `record` runs a case into a result, over an earlier one only when it finishes; the last that finished counts, and its
/// summary carries the estimates. `hook` may stop everything: what was recorded then stands, with what is known of it.
pub fn reach(case: &Case, asked: f64, hook: Hook, record: Record) -> Result<Outcome> {
    let mut case = case.clone();
    case.effects_tolerance.get_or_insert(EFFECTS * asked);
    let mut search = Search::new(models::of_best_order(case)?, asked, hook)?;
    let mut at: At = (first::least_cells(&search.case)?, LOOSEST);
    let mut outcome = record(&search.variant(at))?;
    if outcome.summary.status == Status::Failed && search.take_all_effects() {
        outcome = record(&search.variant(at))?;
    }
    if outcome.summary.status != Status::Finished {
        let why = "accuracy: nothing is known of the errors of a run that did not finish";
        outcome.summary.warnings.push(Code::Accuracy.warning(why));
        return Ok(outcome);
    }
    search.runs.take(Way::Candidate, at, &outcome.summary);
    // What is recorded, and whether with the effects of the present candidates.
    let (mut recorded, mut present) = (at, true);
    let mut begins = true;
    let cut_short = loop {
        if let Some(reason) = search.compare_with_cheaper(at)? {
            break Some(reason);
        }
        search.runs.lose_sight(at);
        let estimates = search.runs.estimates(at);
        let fill = numerical(&estimates) / asked;
        let next = if fill > FILL {
            search.cheapest(at, &estimates)
        } else {
            None
        };
        let judge = next.is_none() && fill <= 1.0 && (present && recorded == at);
        if judge || std::mem::take(&mut begins) {
            match search.look_at_effects(at, judge)? {
                Look::Stopped(reason) => break Some(reason),
                Look::Known => {}
                Look::MoreEffects => present = false,
            }
        }
        if judge && present {
            match search.compare_with_coarsest(at)? {
                Ran::Stopped(reason) => break Some(reason),
                Ran::Finished => continue,
                Ran::Known => {}
            }
            match search.compare_methods(at)? {
                Ran::Stopped(reason) => break Some(reason),
                Ran::Finished => continue,
                Ran::Known => break None,
            }
        }
        match next {
            Some((finer, _)) if present => at = finer,
            None if present && recorded == at => break None,
            _ => {}
        }
        let sure = !present || next.is_none_or(|(_, sure)| sure);
        if !sure {
            if let Ran::Stopped(reason) = search.run(Way::Candidate, at)? {
                break Some(reason);
            }
            continue;
        }
        let finer = record(&search.variant(at))?;
        if finer.summary.status != Status::Finished {
            break finer.summary.reason;
        }
        search.replace(recorded, &outcome.summary);
        search.runs.take(Way::Candidate, at, &finer.summary);
        (recorded, present, outcome) = (at, true, finer);
    };
    search.conclude(recorded, present, cut_short, &mut outcome.summary);
    Ok(outcome)
}
