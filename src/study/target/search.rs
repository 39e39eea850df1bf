//! The runs that a candidate is judged by, and what to try next.

use std::collections::BTreeMap;

use super::Hook;
use super::estimates::{At, EXPECTED_RATIO, Runs, UNSEEN, Way};
use super::models::{self, Full};
use crate::case::Case;
use crate::case::schema::Effect;
use crate::case::schema::Method;
use crate::discrete::{System, resolution};
use crate::error::Result;
use crate::error::numbers::counted;
use crate::run::dynamics;
use crate::run::record::{Control, Progress, Unrecorded};
use crate::run::summary::{Estimate, Pilot, Status, Summary};
use crate::study::accuracy::{Scheme, plan};
use crate::study::counted::Floors;

/// Finest mesh and tightest tolerance that are tried: cells a segment, decades.
const FINEST: usize = 64;
const TIGHTEST: i32 = 9;
/// Part of the accuracy asked that errors of time and mesh may fill: estimates are no bounds.
pub const FILL: f64 = 0.6;
/// Share of a shape beyond which no order is to be expected while a mesh leaves it out.
const LEFT_OUT: f64 = 0.1;
/// Part of the present error below which that of a setting must be for it to be worth a run.
const WORTH: f64 = 0.9;
/// Steps that a run beside a candidate may take: so many times the candidate's, and some for what is short.
const STEPS: (u64, u64) = (30, 3000);

/// A search for the cheapest run.
pub struct Search<'a> {
    /// The case, with the effects that candidates have at present.
    pub case: Case,
    /// Accuracy asked for.
    pub asked: f64,
    hook: Hook<'a>,
    /// What is known of candidates with these effects.
    pub runs: Runs,
    /// Every run but the result's own.
    pub pilots: Vec<Pilot>,
    /// The case with the effects that candidates leave out, where they leave out any.
    pub full: Option<Full>,
    /// Effects that candidates had left out, and no longer do.
    pub taken_in: Vec<Effect>,
    /// Runs beside candidates that did not finish, and why.
    pub failed: BTreeMap<(Way, At), String>,
}

/// How it went with a run.
pub enum Ran {
    /// It finished.
    Finished,
    /// It has been run, or tried, before.
    Known,
    /// Everything must stop.
    Stopped(String),
}

impl<'a> Search<'a> {
    /// Nothing known yet.
    pub fn new(case: Case, asked: f64, hook: Hook<'a>) -> Result<Self> {
        Ok(Self {
            runs: Runs::new(Floors::of(&case)?, case.mesh.order()),
            full: models::full(&case)?,
            case,
            asked,
            hook,
            pilots: vec![],
            taken_in: vec![],
            failed: BTreeMap::new(),
        })
    }

    /// A candidate: the case on a mesh at a tolerance.
    pub fn variant(&self, at: At) -> Case {
        refined(&self.case, at)
    }

    /// Runs a setting without recording, unless that has been done. With other methods and more effects it may take only so many
    /// steps.
    pub fn run(&mut self, way: Way, at: At) -> Result<Ran> {
        if self.runs.hold(way, at) || self.failed.contains_key(&(way, at)) {
            return Ok(Ran::Known);
        }
        let case = match (way, &self.full) {
            (Way::Candidate, _) | (Way::Full, None) => self.variant(at),
            (Way::Full, Some(full)) => refined(&full.case, at),
            (Way::Method, _) => {
                let (method, tighter) = other(self.case.solver.method);
                let mut case = refined(&self.case, (at.0, at.1 + tighter));
                let scheme = Scheme::one_step(method).unwrap_or(Scheme::ida(2));
                scheme.apply(&mut case.solver);
                case
            }
        };
        let most = match way {
            Way::Candidate => None,
            _ => self.runs.steps(at).map(|steps| STEPS.0 * steps + STEPS.1),
        };
        let (summary, stopped) = self.unrecorded(&case, way, at, most)?;
        if summary.status == Status::Finished {
            self.runs.take(way, at, &summary);
            return Ok(stopped.map_or(Ran::Finished, Ran::Stopped));
        }
        let why = summary.reason.unwrap_or_default();
        self.failed.insert((way, at), why);
        Ok(stopped.map_or(Ran::Finished, Ran::Stopped))
    }

    /// Runs a case of a kind for its summary alone, with at most so many steps; with why everything must stop, if it must.
    pub fn unrecorded(
        &mut self,
        case: &Case,
        way: Way,
        at: At,
        most: Option<u64>,
    ) -> Result<(Summary, Option<String>)> {
        let mut stopped = None;
        let mut watch = Unrecorded(|progress: &Progress| {
            let control = (self.hook)(progress);
            match &control {
                Control::Stop(reason) => stopped = Some(reason.clone()),
                Control::Continue if most.is_some_and(|most| progress.steps > most) => {
                    let share = 100.0 * progress.t / progress.end;
                    return Control::Stop(format!(
                        "{} for {share:.1} % of the run",
                        counted(progress.steps, "step")
                    ));
                }
                Control::Continue => {}
            }
            control
        });
        let summary = dynamics::run(&plan::unrecorded(case), &mut watch)?.summary;
        self.pilots.push(pilot(self.with(way), at, &summary));
        Ok((summary, stopped))
    }

    /// What a run of a kind is, besides coarser or looser.
    fn with(&self, way: Way) -> String {
        match way {
            Way::Candidate => String::new(),
            Way::Method => {
                let (method, tighter) = other(self.case.solver.method);
                let name = Scheme::one_step(method).map_or(String::new(), Scheme::label);
                let at = if tighter == 0 { "" } else { ", a tenth of the tolerance" };
                format!("{name}{at}")
            }
            Way::Full => "the effects left out".into(),
        }
    }

    /// The result so far gives way to a better one, and becomes a pilot.
    pub fn replace(&mut self, at: At, summary: &Summary) {
        self.pilots.push(pilot(String::new(), at, summary));
    }

    /// The two runs that the errors of one are estimated by, after that itself where it is not known.
    pub fn compare_with_cheaper(&mut self, at: At) -> Result<Option<String>> {
        let (cells, decades) = at;
        if !self.runs.knows_mesh(cells) {
            let case = self.variant(at);
            let findings = resolution::findings(&case, &System::new(&case)?);
            let unresolved = findings.iter().any(|finding| finding.left_out > LEFT_OUT);
            self.runs.take_mesh(cells, unresolved);
        }
        for candidate in [at, (cells / 2, decades), (cells, decades - 1)] {
            if let Ran::Stopped(reason) = self.run(Way::Candidate, candidate)? {
                return Ok(Some(reason));
            }
        }
        Ok(None)
    }

    /// The run on a quarter of the mesh, that shows how differences fall; a cheap one before anything is promised.
    pub fn compare_with_coarsest(&mut self, at: At) -> Result<Ran> {
        if at.0 < 4 {
            return Ok(Ran::Known);
        }
        self.run(Way::Candidate, (at.0 / 4, at.1))
    }

    /// The run by another method, on half the mesh, that a candidate's error in time is not taken below.
    pub fn compare_methods(&mut self, at: At) -> Result<Ran> {
        if self.runs.method(at).is_some() {
            return Ok(Ran::Known);
        }
        self.run(Way::Method, (at.0 / 2, at.1))
    }

    /// The cheapest finer setting that should do, and whether it should; one step towards it where that is far.
    pub fn cheapest(&self, at: At, estimates: &BTreeMap<String, Estimate>) -> Option<(At, bool)> {
        let (cells, decades) = at;
        let thirds = self.runs.thirds(at);
        // A third run shows that differences fall, and what is left over is then a part of the last.
        let summed = |known: bool, steps: i32| match (known, steps) {
            (false, 1..) => EXPECTED_RATIO / (1.0 - EXPECTED_RATIO) / UNSEEN,
            _ => 1.0,
        };
        let predicted = |refinements: i32, tighter: i32| {
            let part = |error: Option<f64>, ratio: f64, steps: i32, known: bool| {
                error.unwrap_or(1.0) * ratio.powi(steps) * summed(known, steps)
            };
            let total = |e: &Estimate| {
                part(e.space, self.runs.expected(), refinements, thirds[0])
                    + part(e.time, EXPECTED_RATIO, tighter, thirds[1] || e.method.is_some())
            };
            estimates.values().map(total).fold(0.0, f64::max) / self.asked
        };
        // Twice the cells are four times the work: unknowns, and steps through stiffness. A decade is 10^(1/3) of steps.
        let cost = |refinements: i32, tighter: i32| 4_f64.powi(refinements) * 10_f64.powf(f64::from(tighter) / 3.0);
        let now = predicted(0, 0);
        let mut best: Option<((i32, i32), f64, f64)> = None;
        for refinements in 0..=6 {
            for tighter in 0..=6 {
                let (fill, cost) = (predicted(refinements, tighter), cost(refinements, tighter));
                let possible = cells << refinements <= FINEST && decades + tighter <= TIGHTEST;
                let better = best.is_none_or(|(_, f, c)| if fill <= FILL { f > FILL || cost < c } else { fill < f });
                if possible && fill < WORTH * now && better {
                    best = Some(((refinements, tighter), fill, cost));
                }
            }
        }
        let ((refinements, tighter), fill, _) = best?;
        let step = (refinements.min(1), tighter.min(2));
        let sure = fill <= FILL && step == (refinements, tighter);
        Some(((cells << step.0, decades + step.1), sure))
    }
}

/// Another method, and by how many decades its tolerance is tighter: of order 5, whose error is a fraction of others' at the same
/// tolerance (docs/accuracy.md), so that the distance is the others' error. Where the case asks for it, one of order 4 at a
/// tenth of the tolerance.
fn other(method: Method) -> (Method, i32) {
    match method {
        Method::Esdirk57 => (Method::Esdirk46, 1),
        _ => (Method::Esdirk57, 0),
    }
}

/// The case on a mesh at a tolerance.
fn refined(case: &Case, (cells, decades): At) -> Case {
    plan::refined(case, cells, 10_f64.powi(-decades))
}

fn pilot(with: String, (cells, decades): At, summary: &Summary) -> Pilot {
    Pilot {
        with,
        cells_per_segment: cells,
        rtol: 10_f64.powi(-decades),
        unknowns: summary.unknowns,
        steps: summary.solver.steps,
        wall_s: summary.wall_s.total,
    }
}
