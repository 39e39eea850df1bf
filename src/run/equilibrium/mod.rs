//! Static equilibrium: the path from rest to the full load, every point of it solved by KINSOL.
//!
//! ```text
//! stages   loads that follow one another: the whole path
//! arclength  equilibrium with the load factor as one more unknown: the arc length
//! natural  coordinates in which paths are nearly straight
//! overdamped  motion without inertia to the next state at rest, where walls turn the path too sharply
//! predict  where the next point probably is
//! path     step by step along the path, as far as predictions hold; limit points, bifurcations
//! sensitivity  derivatives by numbers of the case, or along any change of it
//! trapped  stages that valves ask for which shut before: what is behind them
//! resting  states under loads that differ a little from those of a known one
//! faults   why a path ends before its loads are reached
//! branch   from one path onto another that crosses it
//! state    what is read off a state; one state as the unknowns of another system
//! ```
//!
//! Everything that acts grows in proportion from nothing: loads, motions of the ends, pressures and flows of ports, volumes
//! of closed networks. Valves stand as they do under the full load; where one has shut before, the path goes first to the loads under
//! which it did. Where loads of other instants come first, each stage of the
//! path goes along the straight line from the loads of one instant to those of the next.

mod arclength;
mod branch;
mod faults;
mod judge;
mod natural;
mod overdamped;
mod path;
mod predict;
mod resting;
mod sensitivity;
mod stages;
mod state;
mod trapped;

use crate::case::schema::{Case, EquilibriumStart};
use crate::dae::BeamDae;
use crate::discrete::System;
use crate::error::{self, At, Code, SolverError};
use crate::run::range::{MACH, REYNOLDS, STRAIN};
use crate::run::record::Control;
use crate::run::unphysical::{Met, Unphysical};
use crate::sundials::Solution;

pub use resting::Resting;
pub use sensitivity::{Derivative, Direction, Sensitivity, along, differentiate};
pub use stages::follow;
pub use state::{Stability, State, columns, restate};
pub use trapped::{Kept, TIGHT, kept, warning as trapped};

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Instant whose loads are the full ones [s].
    pub at_s: f64,
    /// Instants whose loads are reached before, one after the other [s].
    pub via_s: Vec<f64>,
    /// Instants as of which valves stand in these stages, where they are those of valves that shut ([`Options::resolved`]); none:
    /// each as at its end [s].
    pub valves_s: Vec<f64>,
    /// Share of the last stage, from the loads before to the full ones, at which the path ends.
    pub share: f64,
    /// Largest share of an arc that a step may take, a number of points at least; none: as far as predictions hold.
    pub points: Option<usize>,
    /// Whether the path that crosses is taken where this one loses its stability.
    pub branches: bool,
}

impl Options {
    /// Under the loads of an instant [s].
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

    /// In which a run starts.
    pub fn of_start(start: &EquilibriumStart) -> Self {
        Self {
            via_s: start.via_s.clone(),
            ..Self::at(start.loads_at_s)
        }
    }

    /// Where on the way a load factor is, for people: `0.25 of the loads`, or of the stage that it belongs to.
    pub fn place(&self, stage: usize, share: &str) -> String {
        if self.via_s.is_empty() {
            format!("{share} of the loads")
        } else {
            format!("{share} of stage {}", stage + 1)
        }
    }
}

/// A load path, as far as it was followed.
#[derive(Clone, Debug, Default)]
pub struct Path {
    /// Its states, from rest on.
    pub states: Vec<State>,
    /// What happened on the way.
    pub events: Vec<Event>,
    /// Work of the solver.
    pub work: Solution,
    /// Predictions that had to be shortened.
    pub rejected: u64,
    /// Why the path ends before the share that was asked for, if it does.
    pub fault: Option<SolverError>,
    /// What of the first state lies beyond the model, where one does.
    pub beyond: Option<String>,
    /// The largest Reynolds number of steady flow through a tube, and the load factor at which it is reached.
    pub reynolds: [f64; 2],
    /// Likewise the largest Mach number.
    pub mach: [f64; 2],
    /// Likewise the largest strain of a fibre.
    pub strain: [f64; 2],
    /// States met that are not physical, by load factor.
    unphysical: Met,
    /// What such a state is.
    limits: Unphysical,
    /// What is to be said of fluid behind valves that have shut before, where there is some.
    pub trapped: Option<String>,
}

/// A remarkable point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Stage of the path, from 0.
    pub stage: usize,
    /// Share of the stage.
    pub share: f64,
    /// What is remarkable.
    pub kind: Kind,
}

/// What is remarkable about a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The load factor turns back: snap-through under a load that keeps growing.
    LimitPoint,
    /// Another path crosses: buckling. The path that is followed from there on is the other one.
    Bifurcation,
}

impl Event {
    /// Load factor: stages before and share of this one.
    pub fn load_factor(&self) -> f64 {
        self.stage as f64 + self.share
    }

    /// For people.
    pub fn words(&self) -> &'static str {
        match self.kind {
            Kind::LimitPoint => "limit point: the load that the beam carries turns back here",
            Kind::Bifurcation => {
                "bifurcation: the path loses its stability where another one crosses it; that one is followed"
            }
        }
    }
}

impl Path {
    /// That states are not what the model describes.
    pub fn warnings(&self) -> Vec<String> {
        let beyond = self.beyond.iter().map(|beyond| {
            let what = format!("{beyond}; states from there on are not to be trusted");
            Code::BeyondRange.warning(what)
        });
        let [reynolds, share] = self.reynolds;
        let fast = (reynolds > REYNOLDS).then(|| {
            Code::FastFlow.warning(format!(
                "range of the model: the Reynolds number of steady flow in a tube reached {reynolds:.0} at load factor {share:.4} (above \
                 {REYNOLDS}); flow is meant to creep"
            ))
        });
        let [mach, share] = self.mach;
        let choked = (mach > MACH).then(|| {
            Code::FastGas.warning(format!(
                "range of the model: the Mach number of steady flow in a tube reached {mach:.2} at load factor {share:.4} (above {MACH}); a tube \
                 passes no more than at 1, so that real flow is slower than this"
            ))
        });
        let [strain, share] = self.strain;
        let strained = (strain > STRAIN).then(|| {
            Code::Strain.warning(format!(
                "range of the model: the largest fibre strain |lambda - 1| + |kappa| h_s/2 reached {strain:.2} at load factor {share:.4} (above \
                 {STRAIN}); strains are meant to be small"
            ))
        });
        let trapped = self.trapped.clone();
        let at = |factor: f64| format!("load factor {factor:.4}");
        let unphysical = self.limits.warnings(&self.unphysical, &at);
        let all = trapped.into_iter().chain(beyond).chain(unphysical).chain(strained);
        all.chain(fast).chain(choked).collect()
    }

    /// The last state.
    pub fn last(&self) -> &State {
        &self.states[self.states.len() - 1]
    }
}

/// The system whose equilibria are looked for: everything the case describes without inertia and damping, all areas unknowns,
/// with signals that grow from nothing to what they are at an instant [s] while t grows from 0 to 1.
///
/// # Errors
/// Those of [`System::new`].
pub fn system(case: &Case, at_s: f64) -> error::Result<System> {
    let first = stages::Stage::from_nothing(at_s);
    stages::grow(case, &first).map(|grown| grown.system)
}

/// The state in which a run begins, where the case asks for an equilibrium: the scaled unknowns of the run's system, with the
/// velocities that stand in `y`. Everything that the run leaves out is left out of the equilibrium too.
///
/// # Errors
/// There is no equilibrium, or no way to it from rest.
pub fn at_start(case: &Case, options: &Options, dae: &mut BeamDae, y: &[f64]) -> Result<Vec<f64>, SolverError> {
    at_start_watched(case, options, dae, y, &mut || Control::Continue)
}

/// The same; `ask` is asked at every point of the path whether to go on.
///
/// # Errors
/// As [`at_start`], or it was told to stop.
pub fn at_start_watched(
    case: &Case,
    options: &Options,
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
            at: At::Time(0.0),
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
