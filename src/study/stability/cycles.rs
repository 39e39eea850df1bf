//! Cycles along one parameter; each search starts from the previous cycle.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::case::schema::Case;
use crate::error::{Code, Result};
use crate::run::early_warnings;
use crate::run::floquet::{self, Floquet};
use crate::run::periodic::balanced_cycle::TighterCycle;
use crate::run::periodic::{PeriodicScene, Settled, ShootingRecord, record, settle, shoot};
use crate::run::record::{Control, Unrecorded};
use crate::run::stop::{INTERRUPTED, StopFlag};
use crate::run::summary::{Quantity, Status};
use crate::study::evaluations::Evaluations;

/// Number of multipliers computed.
const COUNT: usize = 4;

/// Cycle at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleMember {
    /// Value of the parameter.
    pub value: f64,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Search for the cycle.
    pub search: ShootingRecord,
    /// Stability of the cycle.
    pub floquet: Floquet,
    /// Quantities over the period.
    pub quantities: std::collections::BTreeMap<String, Quantity>,
    /// Reason why the tolerance of the cycle is not the case's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refined: Option<TighterCycle>,
    /// Wall time of search and stability [s].
    pub wall_s: f64,
}

/// Cycles at all values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CyclePath {
    /// Name of the case.
    pub case: String,
    /// JSON pointer of the parameter.
    pub pointer: String,
    /// True if the values are evenly spaced in their logarithms.
    pub logarithmic: bool,
    /// Cycles.
    pub members: Vec<CycleMember>,
    /// Values without a cycle, with reasons.
    pub missing: Vec<(f64, String)>,
    /// Warnings about the first case.
    pub warnings: Vec<String>,
}

/// Result at one value, with the state that the next one needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Step {
    found: std::result::Result<CycleMember, String>,
    /// Warning that its energies do not add up.
    open: Option<String>,
    /// State of its cycle.
    state: Option<Vec<f64>>,
}

/// Finds the cycle of every case; `report` is called with the number of finished cases. Cases not finished at a stop are
/// missing. If turbines harvest, tolerances are tightened until the energies of each cycle add up, as for one cycle.
/// Cycles stored in `evaluations` are not searched again.
///
/// # Errors
/// A case without a period, a beam that nothing holds.
pub fn along(
    (pointer, logarithmic): (&str, bool),
    cases: &[(f64, Case)],
    evaluations: &Evaluations,
    stop: &StopFlag,
    report: &dyn Fn(usize),
) -> Result<CyclePath> {
    let mut found = CyclePath {
        case: cases.first().map_or(String::new(), |(_, case)| case.name.clone()),
        pointer: pointer.into(),
        logarithmic,
        members: vec![],
        missing: vec![],
        warnings: match cases.first() {
            Some((_, case)) => early_warnings::without_outputs(case, &crate::run::periodic::scene::system(case)?),
            None => vec![],
        },
    };
    let mut before: Option<(PeriodicScene, Vec<f64>)> = None;
    let mut open: Vec<(f64, String)> = vec![];
    for (k, (value, case)) in cases.iter().enumerate() {
        if stop.raised() {
            found.missing.push((*value, INTERRUPTED.into()));
            continue;
        }
        let begin = Instant::now();
        let scene = PeriodicScene::new(case, None)?.heeding(stop);
        scene.held(&case.name)?;
        if k == 0 {
            found.warnings.extend(scene.trapped.clone());
        }
        let from = before.as_ref().and_then(|(old, y)| scene.take_over(old, y));
        let compute = || step((*value, case), scene.clone(), from.as_deref(), begin);
        let step = evaluations.try_get(&(k, value), &|| stop.raised(), compute)?;
        match step.found {
            Ok(member) => found.members.push(member),
            Err(why) => found.missing.push((*value, why)),
        }
        open.extend(step.open.map(|warning| (*value, warning)));
        if let Some(y) = step.state {
            before = Some((scene, y));
        }
        report(k + 1);
    }
    if let Some((value, warning)) = open.first() {
        let others = match open.len() - 1 {
            0 => String::new(),
            n => format!("; similar at {n} of the other values"),
        };
        found
            .warnings
            .push(format!("{warning} (at {pointer} = {value}{others})"));
    }
    Ok(found)
}

fn step((value, case): (f64, &Case), scene: PeriodicScene, from: Option<&[f64]>, begin: Instant) -> Result<Step> {
    let cycle = match shoot(&scene, from) {
        Ok(cycle) => cycle,
        Err(impasse) => {
            return Ok(Step {
                found: Err(impasse.what),
                open: None,
                state: None,
            });
        }
    };
    let harvests = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
    let Settled {
        case,
        scene,
        mut cycle,
        refined,
    } = match harvests {
        true => settle(case, scene, cycle)?,
        false => Settled::as_found(case, scene, cycle),
    };
    let floquet = floquet::multipliers(&scene, &mut cycle, COUNT);
    let wall_s = begin.elapsed().as_secs_f64();
    let summary = record::record(&case, &scene, &cycle, &mut Unrecorded(|_| Control::Continue))?.summary;
    let finished = summary.status == Status::Finished;
    let mark = Code::EnergyFigure.id();
    Ok(Step {
        open: summary
            .warnings
            .into_iter()
            .find(|warning| finished && warning.starts_with(mark)),
        found: match finished {
            true => Ok(CycleMember {
                value,
                unknowns: scene.system.layout.len,
                search: cycle.search,
                floquet,
                quantities: summary.quantities,
                refined,
                wall_s,
            }),
            false => Err(summary.reason.unwrap_or_default()),
        },
        state: Some(cycle.y),
    })
}
