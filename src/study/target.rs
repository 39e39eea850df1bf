//! The cheapest run that has an accuracy: mesh and tolerance chosen by error estimates from a few cheaper runs.

pub mod estimates;

use std::collections::BTreeMap;

use super::accuracy::plan;
use crate::case::Case;
use crate::error::{Code, Result};
use crate::run::dynamics::{self, Outcome};
use crate::run::record::{Control, Progress, Unrecorded};
use crate::run::summary::{Accuracy, Estimate, Pilot, Status, Summary};

use estimates::{At, EXPECTED_RATIO, Runs, worst};

/// Finest mesh and tightest tolerance that are tried: cells a segment, decades.
const FINEST: usize = 64;
const TIGHTEST: i32 = 9;
/// Part of the accuracy asked that an estimate may fill: estimates are no bounds.
const FILL: f64 = 0.6;
/// Part of the accuracy asked that leaving out an effect may take, unless the case says.
const EFFECTS: f64 = 0.1;

/// Asked before every step whether to go on.
pub type Hook<'a> = &'a dyn Fn(&Progress) -> Control;
/// Runs a case into a result and returns how it ended.
pub type Record<'a> = &'a mut dyn FnMut(&Case) -> Result<Outcome>;

struct Search<'a> {
    case: &'a Case,
    asked: f64,
    hook: Hook<'a>,
    runs: Runs,
    pilots: Vec<Pilot>,
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
    let mut case = case.clone();
    case.effects_tolerance.get_or_insert(EFFECTS * asked);
    let case = &case;
    let mut search = Search {
        case,
        asked,
        hook,
        runs: Runs::default(),
        pilots: vec![],
    };
    let mut at: At = (2, 3);
    let mut recorded = at;
    let mut outcome = record(&variant(case, at))?;
    if outcome.summary.status != Status::Finished {
        let why = "accuracy: nothing is known of the errors of a run that did not finish";
        outcome.summary.warnings.push(Code::Accuracy.warning(why));
        return Ok(outcome);
    }
    search.runs.take(at, &outcome.summary, case.beam.length_m);
    let cut_short = loop {
        if let Some(reason) = search.compare_with_cheaper(at)? {
            break Some(reason);
        }
        search.runs.lose_sight(at);
        let estimates = search.runs.estimates(at);
        let next = search.cheapest(at, &estimates);
        let sure = match next {
            Some((next, sure)) if worst(&estimates) / asked > FILL => {
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
        search.runs.take(at, &finer.summary, case.beam.length_m);
        (recorded, outcome) = (at, finer);
    };
    search.conclude(recorded, cut_short, &mut outcome.summary);
    Ok(outcome)
}

impl Search<'_> {
    /// Runs a setting without recording, unless it has been run. Returns why everything must stop, if it must.
    fn run(&mut self, at: At) -> Result<Option<String>> {
        if self.runs.hold(at) {
            return Ok(None);
        }
        let mut stopped = None;
        let mut watch = Unrecorded(|progress: &Progress| {
            let control = (self.hook)(progress);
            if let Control::Stop(reason) = &control {
                stopped = Some(reason.clone());
            }
            control
        });
        let summary = dynamics::run(&variant(self.case, at), &mut watch)?.summary;
        self.pilots.push(pilot(at, &summary));
        if summary.status == Status::Finished {
            self.runs.take(at, &summary, self.case.beam.length_m);
        }
        Ok(stopped)
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
        let estimates = self.runs.estimates(at);
        let reached = worst(&estimates) <= self.asked;
        if let Some(reason) = cut_short {
            summary
                .warnings
                .push(Code::Accuracy.warning(format!("accuracy: the search was cut short: {reason}")));
        }
        if !reached {
            let short = |(name, e): (&String, &Estimate)| match e.total {
                Some(total) if total > self.asked => Some(format!("{name} {total:.1e}")),
                Some(_) => None,
                None => Some(format!("{name} unknown")),
            };
            let short: Vec<String> = estimates.iter().filter_map(short).collect();
            summary.warnings.push(Code::Accuracy.warning(format!(
                "accuracy: {:e} is not reached with {cells} cells a segment and rtol 1e-{decades}: {}",
                self.asked,
                short.join(", ")
            )));
        }
        if let Some(lost) = &self.runs.lost {
            let grows = summary
                .growth
                .as_ref()
                .map_or(String::new(), |g| format!(" (it grows at {:.2} 1/s)", g.rate_per_s));
            summary.warnings.push(Code::Accuracy.warning(format!(
                "accuracy: {lost}: the motion{grows} is one of many that start alike, and cannot be followed to the end. Judged are root \
                 mean squares and increments over the window, not single values"
            )));
        }
        summary.accuracy = Some(Accuracy {
            asked: self.asked,
            reached,
            cells_per_segment: cells,
            cells_per_bladder: plan::fluid_cells(cells),
            rtol: 10_f64.powi(-decades),
            judged_by: self.runs.judged_by,
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
