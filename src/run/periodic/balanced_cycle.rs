//! A cycle whose energies balance: computed again at tighter tolerances until its figures do.
//!
//! Tolerances refer to the sizes of displacements and pressures. The energy input and output of a cycle may be a hundredth of the
//! energy that it stores. Steps that are accurate enough for the motion are then too inaccurate for this difference.

use serde::{Deserialize, Serialize};

use super::scene::PeriodicScene;
use super::shooting::{Cycle, ShootingRecord, attempt, shoot};
use super::{record, self_oscillation};
use crate::case::schema::Case;
use crate::error::Result;
use crate::run::energies::{open_over_window, too_open};
use crate::run::record::{Control, Unrecorded};
use crate::run::summary::{Status, Summary};

/// Largest reduction of the tolerance, in decades.
const DECADES: u32 = 4;
/// Tightest tolerance.
const TIGHTEST: f64 = 1e-10;

/// A cycle with the case and the scene, including their tolerance, in which it was found.
pub struct Settled {
    /// The case.
    pub case: Case,
    /// Scene of the cycle.
    pub scene: PeriodicScene,
    /// The cycle.
    pub cycle: Cycle,
    /// Refinement, if the tolerance is not that of the case.
    pub refined: Option<TighterCycle>,
}

impl Settled {
    /// A cycle at the tolerance at which it was found.
    pub fn as_found(case: &Case, scene: PeriodicScene, cycle: Cycle) -> Self {
        Self {
            case: case.clone(),
            scene,
            cycle,
            refined: None,
        }
    }
}

/// A refinement: the cycle was computed again at a tighter tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TighterCycle {
    /// Tolerance of the case.
    pub from_rtol: f64,
    /// Tolerance of the final cycle.
    pub rtol: f64,
    /// Largest error of the balance over the cycle, relative to its figures: of the first cycle, and of the final one.
    pub open: [f64; 2],
}

impl TighterCycle {
    /// Description for messages.
    pub fn describe(&self) -> String {
        format!(
            "at rtol {:e} the energy balance over the cycle had an error of {:.0} % of a figure: found again at rtol \
             {:e}, with an error of {:.2} %",
            self.from_rtol,
            100.0 * self.open[0],
            self.rtol,
            100.0 * self.open[1]
        )
    }
}

/// Tightens the tolerance of a cycle as long as its energy balance has a large error relative to its figures.
///
/// # Errors
/// Those of a run that cannot be recorded. If no cycle is found or followed at a tolerance, the one before remains.
pub fn settle(case: &Case, scene: PeriodicScene, cycle: Cycle) -> Result<Settled> {
    let mut now = Settled::as_found(case, scene, cycle);
    let Some(mut open) = open(&now)? else { return Ok(now) };
    let first = open;
    for _ in 0..DECADES {
        let rtol = tenth(now.case.solver.rtol);
        if !too_open(open) || rtol < TIGHTEST * (1.0 - 1e-9) {
            break;
        }
        let mut next = now.case.clone();
        next.solver.rtol = rtol;
        let mut scene = now.scene.clone();
        scene.rtol = rtol;
        // a cycle of several periods is only searched from here: elsewhere one of a single period may be found
        let found = match scene.periods {
            _ if scene.free_period => self_oscillation::refine(&mut scene, &now.cycle),
            1 => shoot(&scene, Some(&now.cycle.y)),
            _ => attempt(&scene, now.cycle.y.clone(), &mut ShootingRecord::default()),
        };
        let Ok(cycle) = found else { break };
        let tried = Settled {
            case: next,
            scene,
            cycle,
            refined: None,
        };
        let Some(left) = self::open(&tried)? else { break };
        open = left;
        now = Settled {
            refined: Some(TighterCycle {
                from_rtol: case.solver.rtol,
                rtol,
                open: [first, left],
            }),
            ..tried
        };
    }
    Ok(now)
}

/// A tenth of a tolerance, without the rounding error in its last digit.
fn tenth(rtol: f64) -> f64 {
    format!("{:.12e}", 0.1 * rtol).parse().unwrap_or(0.1 * rtol)
}

/// Largest error of the balance over the cycle relative to its figures, if there are any.
fn open(of: &Settled) -> Result<Option<f64>> {
    let outcome = record::record(&of.case, &of.scene, &of.cycle, &mut Unrecorded(|_| Control::Continue))?;
    let Summary {
        status,
        quantities,
        balances,
        ..
    } = &outcome.summary;
    let largest = balances.energy_j.values().fold(0.0_f64, |s, x| s.max(x.abs()));
    Ok((*status == Status::Finished)
        .then(|| open_over_window(quantities, largest))
        .flatten())
}
