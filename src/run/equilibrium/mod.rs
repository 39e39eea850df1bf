//! Static equilibrium: the path from rest to the full load, with every point solved by KINSOL.
//!
//! ```text
//! stages            sequences of loads: the whole path
//! arclength         equilibrium with the load factor as an additional unknown
//! path_coordinates  coordinates in which paths are nearly straight
//! structures        beams assembled from their cells
//! overdamped        motion without inertia to the next equilibrium, where walls turn the path too sharply
//! predictor         prediction of the next point
//! path              step by step along the path, by predictions; limit points, bifurcations
//! stability         stability of the states
//! sensitivity       derivatives by numbers of the case, or along any change of it
//! trapped_fluid     stages required by valves that closed before: the fluid behind them
//! nearby            states under loads that differ a little from those of a known one
//! faults            errors that end a path before its loads are reached
//! branch            transition from one path to another that crosses it
//! state             values of a state; a state as unknowns of another system
//! ```
//!
//! Everything that acts grows in proportion from zero: loads, motions of the ends, pressures and flows of ports, volumes of closed
//! networks. Valves have their openings under the full load. If a valve closed before, the path first leads to the loads at its
//! closure. If loads of other instants precede, each stage follows the straight line from the loads of one instant to the next.

mod arclength;
mod branch;
mod faults;
mod nearby;
mod overdamped;
mod path;
mod path_coordinates;
mod predictor;
mod sensitivity;
mod stability;
mod stages;
mod state;
mod structures;
mod trapped_fluid;

use crate::case::schema::{Case, EquilibriumStart};
use crate::dae::BeamDae;
use crate::discrete::System;
use crate::error::{self, Code, SolverError, StopPoint};
use crate::run::range::{MACH, REYNOLDS, STRAIN};
use crate::run::record::Control;
use crate::run::unphysical::{Unphysical, UnphysicalRecord};
use crate::sundials::Solution;

pub use nearby::KnownEquilibrium;
pub use sensitivity::{Derivative, EquilibriumSensitivity, ParameterDirection, along, differentiate};
pub use stages::follow;
pub use state::{EquilibriumStability, EquilibriumState, columns, restate};
pub use trapped_fluid::{TIGHT, TrappedFluid, kept, warning as trapped};

/// Options of a search for equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct EquilibriumOptions {
    /// Instant of the full loads [s].
    pub at_s: f64,
    /// Instants whose loads are reached before, in this order [s].
    pub via_s: Vec<f64>,
    /// Instants of the valve openings in these stages, if the stages belong to valves that close ([`Options::resolved`]). If
    /// empty, each
    /// stage has the openings at its end [s].
    pub valves_s: Vec<f64>,
    /// Share of the last stage at which the path ends; 1 is the full load.
    pub share: f64,
    /// Least number of points in which to divide the path; `None` if only predictions limit the steps.
    pub points: Option<usize>,
    /// True if the path continues on a crossing path where it loses its stability.
    pub branches: bool,
}

impl EquilibriumOptions {
    /// Options for the loads of an instant [s].
    pub fn at(at_s: f64) -> Self {
        Self {
            at_s,
            via_s: vec![],
            valves_s: vec![],
            share: 1.0,
            points: None,
            branches: true,
        }
    }

    /// Options for the equilibrium in which a run starts.
    pub fn of_start(start: &EquilibriumStart) -> Self {
        Self {
            via_s: start.via_s.clone(),
            ..Self::at(start.loads_at_s)
        }
    }

    /// Describes the position of a load factor on the path: `0.25 of the loads`, or of the stage to which it belongs.
    pub fn place(&self, stage: usize, share: &str) -> String {
        if self.via_s.is_empty() {
            format!("{share} of the loads")
        } else {
            format!("{share} of stage {}", stage + 1)
        }
    }
}

/// A load path, up to the last state found.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// States, from rest on.
    pub states: Vec<EquilibriumState>,
    /// Remarkable points of the path.
    pub events: Vec<EquilibriumEvent>,
    /// Work of the solver.
    pub work: Solution,
    /// Predictions that had to be shortened.
    pub rejected: u64,
    /// Error that ended the path before the requested share, if any.
    pub fault: Option<SolverError>,
    /// Description of the limit that the first state beyond the model exceeds, if any.
    pub beyond: Option<String>,
    /// Largest Reynolds number of steady flow through a tube, and its load factor.
    pub reynolds: [f64; 2],
    /// Largest Mach number of steady flow through a tube, and its load factor.
    pub mach: [f64; 2],
    /// Largest strain of a fiber, and its load factor.
    pub strain: [f64; 2],
    /// Unphysical states of the path, by load factor.
    unphysical: UnphysicalRecord,
    /// Limits of physical states.
    limits: Unphysical,
    /// Warning about fluid behind valves that closed before, if there is any.
    pub trapped: Option<String>,
}

/// A remarkable point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquilibriumEvent {
    /// Stage of the path, from 0.
    pub stage: usize,
    /// Share of the stage.
    pub share: f64,
    /// Kind of the point.
    pub kind: EventKind,
}

/// Kind of a remarkable point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The load factor turns back: snap-through under a load that continues to grow.
    LimitPoint,
    /// Another path crosses: buckling. The path continues on the other one.
    Bifurcation,
}

impl EquilibriumEvent {
    /// Load factor: number of earlier stages plus the share of this one.
    pub fn load_factor(&self) -> f64 {
        self.stage as f64 + self.share
    }

    /// Description for messages.
    pub fn describe(&self) -> &'static str {
        match self.kind {
            EventKind::LimitPoint => "limit point: the load that the beam carries turns back here",
            EventKind::Bifurcation => {
                "bifurcation: the path loses its stability where another one crosses it; the other path is followed"
            }
        }
    }
}

impl Path {
    /// Warnings of states outside the range of the model.
    pub fn warnings(&self) -> Vec<String> {
        let beyond = self.beyond.iter().map(|beyond| {
            let what = format!("{beyond}. Later states are not reliable.");
            Code::BeyondRange.warning(what)
        });
        let [reynolds, share] = self.reynolds;
        let fast = (reynolds > REYNOLDS).then(|| {
            Code::FastFlow.warning(format!(
                "range of the model: the Reynolds number of steady flow in a tube reached {reynolds:.0} at load \
                 factor {share:.4} (above {REYNOLDS}). The model assumes creeping flow. Pressures are estimates. Use \
                 --set '/effects/tube_losses=\"on\"'."
            ))
        });
        let [mach, share] = self.mach;
        let choked = (mach > MACH).then(|| {
            Code::FastGas.warning(format!(
                "range of the model: the Mach number of steady flow in a tube reached {mach:.2} at load factor \
                 {share:.4} (above {MACH}). A tube passes at most Mach 1, so the real flow is slower than the \
                 computed one."
            ))
        });
        let [strain, share] = self.strain;
        let strained = (strain > STRAIN).then(|| {
            Code::Strain.warning(format!(
                "range of the model: the largest fibre strain |lambda - 1| + |kappa| h_s/2 reached {strain:.2} at \
                 load factor {share:.4} (above {STRAIN}). The model assumes small strains. Use later shapes only \
                 qualitatively."
            ))
        });
        let trapped = self.trapped.clone();
        let at = |factor: f64| format!("load factor {factor:.4}");
        let unphysical = self.limits.warnings(&self.unphysical, &at, "Reduce the load");
        let all = trapped.into_iter().chain(beyond).chain(unphysical).chain(strained);
        all.chain(fast).chain(choked).collect()
    }

    /// The last state.
    pub fn last(&self) -> &EquilibriumState {
        &self.states[self.states.len() - 1]
    }
}

/// System for equilibria: the case without inertia and damping, with all areas as unknowns. Its signals grow from zero to their
/// values at `at_s` [s] while t grows from 0 to 1.
///
/// # Errors
/// Those of [`System::new`].
pub fn system(case: &Case, at_s: f64) -> error::Result<System> {
    let first = stages::Stage::from_nothing(at_s);
    stages::grow(case, &first).map(|grown| grown.system)
}

/// State in which a run begins, if the case requests an equilibrium: scaled unknowns of the run's system, with the velocities in
/// `y`. Effects that the run neglects are also neglected in the equilibrium.
///
/// # Errors
/// There is no equilibrium, or no path to it from rest.
pub fn at_start(
    case: &Case,
    options: &EquilibriumOptions,
    dae: &mut BeamDae,
    y: &[f64],
) -> Result<Vec<f64>, SolverError> {
    at_start_watched(case, options, dae, y, &mut || Control::Continue)
}

/// Computes the state of [`at_start`]; `ask` decides at every point of the path if the search continues.
///
/// # Errors
/// As [`at_start`], or `ask` stopped the search.
pub fn at_start_watched(
    case: &Case,
    options: &EquilibriumOptions,
    dae: &mut BeamDae,
    y: &[f64],
    ask: &mut dyn FnMut() -> Control,
) -> Result<Vec<f64>, SolverError> {
    let options = &options
        .resolved(case)
        .map_err(|error| faults::fault(0.0, &error.to_string()))?;
    let model = dae.system().model.clone();
    let grow = |stage: &stages::Stage| stages::growing(case, model.at_rest(case)?, stage);
    let path = stages::follow_of(case, &grow, options, false, &mut |_| ask());
    let path = path.map_err(|error| faults::fault(0.0, &error.to_string()))?;
    if let Some(fault) = path.fault {
        return Err(SolverError {
            at: StopPoint::Time(0.0),
            what: format!("no equilibrium to start from: {}", fault.what),
            ..fault
        });
    }
    let last = path.last();
    let stages = options.stages();
    let grown = stages
        .last()
        .map_or_else(|| stages::Stage::from_nothing(options.at_s), |stage| *stage);
    let grown = grow(&grown).map_err(|error| faults::fault(0.0, &error.to_string()))?;
    let mut from = BeamDae::new(grown.system);
    let (system, now) = dae.instant(0.0);
    let mut z = restate(&mut from, last.share, &last.y, system, now);
    let l = &system.layout;
    for velocity in l.velocities() {
        z[velocity] = y[velocity];
    }
    Ok(z)
}
