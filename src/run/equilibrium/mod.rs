//! Static equilibrium: the path from rest to the full load, every point of it solved by KINSOL.
//!
//! ```text
//! arclength  equilibrium with the load factor as one more unknown: the arc length
//! natural  coordinates in which paths are nearly straight
//! predict  where the next point probably is
//! path     step by step along the path, as far as predictions hold; limit points, bifurcations
//! sensitivity  derivatives by numbers of the case
//! branch   from one path onto another that crosses it
//! state    what is read off a state; one state as the unknowns of another system
//! ```
//!
//! Everything that acts grows in proportion from nothing: loads, motions of the ends, pressures and flows of ports, volumes
//! of closed networks. Valves stand as they do under the full load.

mod arclength;
mod branch;
mod judge;
mod natural;
mod path;
mod predict;
mod sensitivity;
mod state;

use crate::case::schema::Case;
use crate::dae::{BeamDae, StaticBeam};
use crate::discrete::{System, TimeData, start};
use crate::error::{self, At, Code, SolverError};
use crate::functions::signals::Polynomial;
use crate::functions::{Clock, Signal};
use crate::model::{Model, Storage};
use crate::run::range::REYNOLDS;
use crate::run::record::Control;
use crate::sundials::Solution;

pub use path::follow;
pub use sensitivity::{Sensitivity, differentiate};
pub use state::{Stability, State, columns, restate};

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// TimeData whose loads are the full ones [s].
    pub at_s: f64,
    /// Share of the loads at which the path ends.
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
            share: 1.0,
            points: None,
            branches: true,
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
    /// The largest Reynolds number of steady flow through a tube, and the share of the loads at which it is reached.
    pub reynolds: [f64; 2],
}

/// A remarkable point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Share of the loads.
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
        beyond.chain(fast).collect()
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
    growing(case, Model::whole(case, false)?, at_s)?.accepted(case)
}

fn growing(case: &Case, mut model: Model, at_s: f64) -> error::Result<System> {
    let at = |signal: &Signal| signal.jet(Clock { t: at_s, within: at_s }).value;
    let growing = |signal: &Signal| match at(signal) {
        0.0 => Signal::Constant(0.0),
        value => Signal::Polynomial(Polynomial {
            coefficients: vec![0.0, value],
        }),
    };
    model.replace_signals(growing, |opening| Signal::Constant(at(opening)));
    model.relaxation.clear();
    let section = &mut model.section;
    (section.drag, section.axial_damping_time, section.bending_damping_time) = (0.0, 0.0, 0.0);
    if let Some(wet) = model.wet.as_mut().filter(|wet| wet.flows) {
        wet.network.still = true;
        wet.storage.fill(Storage::Flowing);
        wet.lumped.clear();
    }
    System::with(case, model)
}

/// The state in which a run begins, where the case asks for an equilibrium: the scaled unknowns of the run's system, with the
/// velocities that stand in `y`. Everything that the run leaves out is left out of the equilibrium too.
///
/// # Errors
/// There is no equilibrium, or no way to it from rest.
pub fn at_start(case: &Case, at_s: f64, dae: &mut BeamDae, y: &[f64]) -> Result<Vec<f64>, SolverError> {
    at_start_watched(case, at_s, dae, y, &mut || Control::Continue)
}

/// The same; `ask` is asked at every point of the path whether to go on.
///
/// # Errors
/// As [`at_start`], or it was told to stop.
pub fn at_start_watched(
    case: &Case,
    at_s: f64,
    dae: &mut BeamDae,
    y: &[f64],
    ask: &mut dyn FnMut() -> Control,
) -> Result<Vec<f64>, SolverError> {
    let at_rest = dae.system().model.at_rest(case);
    let statics = at_rest.and_then(|model| growing(case, model, at_s));
    let statics = statics.map_err(|error| path::fault(0.0, &error.to_string()))?;
    let mut from = BeamDae::new(statics.clone());
    let path = path::follow_of(case, statics, &Options::at(at_s), false, &mut |_| ask());
    if let Some(fault) = path.fault {
        return Err(SolverError {
            at: At::Time(0.0),
            what: format!("no equilibrium to start from: {}", fault.what),
            ..fault
        });
    }
    let last = &path.states[path.states.len() - 1];
    let (system, now) = dae.instant(0.0);
    let mut z = restate(&mut from, last.share, &last.y, system, now);
    let l = &system.layout;
    for velocity in l.velocities() {
        z[velocity] = y[velocity];
    }
    Ok(z)
}

/// Scaled unknowns of a static system at rest, and of the state that its volumes are those of.
fn rest(case: &Case, system: System) -> (StaticBeam, Vec<f64>) {
    let mut now = TimeData::new(&system);
    now.update(&system, Clock { t: 0.0, within: 0.0 });
    let volumes = start::state(&system, case, &now);
    let y = vec![0.0; volumes.len()];
    (StaticBeam::new(system, &volumes), y)
}
