//! Sequences of loads: a path of several stages, each of which begins in the last state of the one before.

use super::arclength::Arclength;
use super::faults::{dry, fault};
use super::path::{PathError, PathFollower, weights};
use super::path_coordinates::PathCoordinates;
use super::state::EquilibriumState;
use super::trapped_fluid::{self, TIGHT};
use super::{EquilibriumOptions, Path};
use crate::case::schema::Case;
use crate::dae::{Dae as _, StaticBeam};
use crate::discrete::layout::Layout;
use crate::discrete::{System, TimeData, start};
use crate::error::{self, SolverError};
use crate::functions::signals::Polynomial;
use crate::functions::{Signal, SmoothTime};
use crate::model::Model;
use crate::model::network::Feed;
use crate::run::range::Limits;
use crate::run::record::Control;
use crate::sundials::Kinsol;

/// One stage of the path: signals change linearly from their values at one instant to those at another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    /// Instant of the loads with which it begins; `None` for zero loads.
    from: Option<SmoothTime>,
    /// Instant of the loads with which it ends.
    to: SmoothTime,
    /// Instant of the valve openings [s].
    valves: f64,
}

impl Stage {
    /// From zero to the loads of an instant [s].
    pub fn from_nothing(to: f64) -> Self {
        Self {
            from: None,
            to: SmoothTime { t: to, within: to },
            valves: to,
        }
    }
}

impl EquilibriumOptions {
    /// Stages of the path, in order; at least one. If loads jump at the instant at which a valve closes, the stage has the loads before
    /// the jump. For a start in equilibrium, loads and valves are those of its own instant.
    pub(super) fn stages(&self) -> Vec<Stage> {
        let mut from = None;
        let stage = |(k, &t): (usize, &f64)| {
            let valves = self.valves_s.get(k).copied();
            let to = SmoothTime {
                t,
                within: if valves.is_some_and(|valves| valves < t) {
                    t.next_down()
                } else {
                    t
                },
            };
            Stage {
                from: from.replace(to),
                to,
                valves: valves.unwrap_or(t),
            }
        };
        self.via_s.iter().chain([&self.at_s]).enumerate().map(stage).collect()
    }

    /// True if the stages before the last one belong to valves that close.
    pub(super) fn follows_valves(&self) -> bool {
        !self.valves_s.is_empty()
    }
}

/// Fraction of the largest value of a signal below which its value at an instant is round-off, such as a sine at its zero.
const ROUND_OFF: f64 = 1e-12;

/// A system whose signals follow a stage while t increases from 0 to 1.
pub(super) struct StagedLoads {
    /// The system.
    pub system: System,
    /// Volume that each source of prescribed flow has added since t = 0, at both ends of the stage [m^3].
    pub pumped: Vec<[f64; 2]>,
}

/// An equilibrium between two stages.
pub(super) struct StageEquilibrium {
    /// Scaled unknowns.
    pub y: Vec<f64>,
    /// Layout of the unknowns.
    pub layout: Layout,
}

/// System of a stage of a case: without inertia and damping, with all areas as unknowns.
///
/// # Errors
/// Those of [`System::new`].
pub(super) fn grow(case: &Case, stage: &Stage) -> error::Result<StagedLoads> {
    let StagedLoads { system, pumped } = growing(case, Model::whole(case, false)?, stage)?;
    let system = system.accepted(case)?;
    Ok(StagedLoads { system, pumped })
}

/// System of a stage, from a given model of the case.
pub(super) fn growing(case: &Case, mut model: Model, stage: &Stage) -> error::Result<StagedLoads> {
    let at = |signal: &Signal, clock: SmoothTime| signal.jet(clock).value;
    let between = |from: f64, to: f64| {
        if from == to {
            Signal::Constant(to)
        } else {
            Signal::Polynomial(Polynomial {
                coefficients: vec![from, to - from],
            })
        }
    };
    let before = |signal: &Signal| stage.from.map_or(0.0, |from| at(signal, from));
    let growing = |signal: &Signal| between(before(signal), at(signal, stage.to));
    let sources = model.wet.iter().flat_map(|wet| &wet.network.sources);
    let pumped = sources.map(|source| match &source.feed {
        Feed::Volume(_) => [0.0; 2],
        Feed::Flow(flow) => [
            stage.from.map_or(0.0, |from| flow.integral(from.t)),
            flow.integral(stage.to.t),
        ],
    });
    let pumped = pumped.collect();
    let sources = model.wet.iter().flat_map(|wet| &wet.network.sources);
    let still = sources.map(|source| match &source.feed {
        Feed::Flow(flow) => {
            let (to, most) = (at(flow, stage.to), flow.largest(stage.to.t.max(case.time.end_s)).value);
            (to != 0.0 && to.abs() <= ROUND_OFF * most).then(|| between(before(flow), 0.0))
        }
        Feed::Volume(_) => None,
    });
    let still: Vec<Option<Signal>> = still.collect();
    let stands = |opening: &Signal| {
        let valves = SmoothTime {
            t: stage.valves,
            within: stage.valves,
        };
        let value = at(opening, valves);
        let shut = !opening.is_constant() && value <= TIGHT;
        Signal::Constant(if shut { 0.0 } else { value })
    };
    model.replace_signals(growing, stands);
    let sources = model.wet.iter_mut().flat_map(|wet| &mut wet.network.sources);
    for (source, still) in sources.zip(still) {
        if let (Feed::Flow(flow), Some(still)) = (&mut source.feed, still) {
            *flow = still;
        }
    }
    model.still = true;
    model.relaxation.clear();
    let within = model.within.iter_mut().flatten();
    for section in model.sections.iter_mut().chain(within).chain([&mut model.section]) {
        (section.drag, section.axial_damping_time, section.bending_damping_time) = (0.0, 0.0, 0.0);
    }
    if let Some(wet) = model.wet.as_mut().filter(|wet| wet.flows) {
        (wet.network.still, wet.network.paced) = (true, false);
        wet.flow_everywhere();
        wet.lumped.clear();
    }
    let system = System::with(case, model)?;
    Ok(StagedLoads { system, pumped })
}

/// Equations of a stage and the scaled unknowns with which it begins: those of an equilibrium, or zero. From zero, volumes grow to
/// those of the start of the case.
pub(super) fn begin(case: &Case, grown: StagedLoads, held: Option<&StageEquilibrium>) -> (StaticBeam, Vec<f64>) {
    let StagedLoads { system, pumped } = grown;
    if let Some(held) = held {
        let y = system.layout.take_over(&held.layout, &held.y);
        return (StaticBeam::from_state(system, &y, &pumped), y);
    }
    let mut now = TimeData::new(&system);
    now.update(&system, SmoothTime { t: 0.0, within: 0.0 });
    let volumes = start::state(&system, case, &now);
    let y = vec![0.0; volumes.len()];
    (StaticBeam::from_nothing(system, &volumes, &pumped), y)
}

/// Follows the equilibria of a case from rest through the loads of one instant after the other to a share of the last ones. `watch`
/// receives every state and can end the path.
///
/// # Errors
/// Those of [`System::new`]. The path contains the error with which it ends early.
pub fn follow(
    case: &Case,
    options: &EquilibriumOptions,
    watch: &mut dyn FnMut(&EquilibriumState) -> Control,
) -> error::Result<Path> {
    follow_of(case, &|stage| grow(case, stage), options, true, watch)
}

/// Follows the equilibria of other static systems of the case; determines their stability if `judged`.
///
/// If openings differ from those of the stage before, valves switch at the start of a stage under constant loads. The residual that
/// results decreases in proportion to zero, and the stage begins in the equilibrium that is reached.
pub(super) fn follow_of(
    case: &Case,
    grow: &dyn Fn(&Stage) -> error::Result<StagedLoads>,
    options: &EquilibriumOptions,
    judged: bool,
    watch: &mut dyn FnMut(&EquilibriumState) -> Control,
) -> error::Result<Path> {
    let options = &options.resolved(case)?;
    let stages = options.stages();
    let mut path = Path {
        trapped: trapped_fluid::warning(case, options)?,
        ..Path::default()
    };
    let mut held: Option<StageEquilibrium> = None;
    let mut valves = vec![];
    for (number, stage) in stages.iter().enumerate() {
        let grown = grow(stage)?;
        let unheld = grown.system.model.unheld();
        if !unheld.is_empty() {
            path.fault = Some(not_held(&unheld));
            return Ok(path);
        }
        let stand = openings(&grown.system);
        let mut new = number == 0;
        if let (Some(before), Some(from)) = (&mut held, stage.from.filter(|_| stand != valves)) {
            new = true;
            let switching = Stage { to: from, ..*stage };
            if let Err(fault) = switch(case, grow(&switching)?, options, number, before) {
                path.fault = Some(fault);
                return Ok(path);
            }
        }
        valves = stand;
        let (statics, y) = begin(case, grown, held.as_ref());
        if let Some(inflow) = statics.fed() {
            let shuts = options.valves_s.get(number).map(|_| stage.to.t);
            path.fault = Some(fed(number, inflow, shuts));
            return Ok(path);
        }
        let layout = statics.system().layout.clone();
        let share = if number + 1 < stages.len() { 1.0 } else { options.share };
        let options = EquilibriumOptions {
            share,
            ..options.clone()
        };
        stretch(case, statics, (y, new), (number, options), judged, &mut path, watch);
        let Some(last) = path.states.last().filter(|_| path.fault.is_none()) else {
            return Ok(path);
        };
        let y = last.y.clone();
        held = Some(StageEquilibrium { y, layout });
    }
    Ok(path)
}

/// Follows one stage of a path, from its first state, which is stored if it is new.
fn stretch(
    case: &Case,
    statics: StaticBeam,
    (y, new): (Vec<f64>, bool),
    (stage, options): (usize, EquilibriumOptions),
    judged: bool,
    path: &mut Path,
    watch: &mut dyn FnMut(&EquilibriumState) -> Control,
) {
    let n = statics.len();
    let wet = statics.system().model.wet.is_some();
    let weights = weights(statics.system());
    let limits = Limits::new(case, statics.system());
    path.limits = limits.unphysical.clone();
    let natural = PathCoordinates::new(&statics);
    let solver = match Kinsol::new(Arclength::new(statics)) {
        Err(failure) => {
            path.fault = Some(fault(stage as f64, &failure.what));
            return;
        }
        Ok(solver) => solver,
    };
    let mut x = y;
    x.push(0.0);
    // The state between two stages belongs to the first, and is the reference for a reversal of the load in the second.
    let begins = path.states.len();
    let mut follower = PathFollower {
        stage,
        orientation: 0,
        branch: begins.saturating_sub(usize::from(!new)),
        natural,
        bounds: vec![begins],
        solver,
        weights,
        n,
        options,
        limits,
        path,
        watch,
    };
    let ended = follower.go(x, new);
    if judged {
        follower.judge();
    }
    path.fault = ended.err().map(|PathError(fault)| if wet { fault } else { dry(fault) });
}

/// Switches valves under constant loads, from the state before.
fn switch(
    case: &Case,
    grown: StagedLoads,
    options: &EquilibriumOptions,
    stage: usize,
    held: &mut StageEquilibrium,
) -> std::result::Result<(), SolverError> {
    let (mut statics, y) = begin(case, grown, Some(held));
    let layout = statics.system().layout.clone();
    let lost = |what: &str| {
        fault(
            stage as f64,
            &format!("the switching of valves before stage {} failed: {what}", stage + 1),
        )
    };
    if !statics.relax_from(&y) {
        return Err(lost("the equations cannot be evaluated"));
    }
    let mut path = Path::default();
    let options = EquilibriumOptions {
        share: 1.0,
        points: None,
        ..options.clone()
    };
    let go_on = &mut |_: &EquilibriumState| Control::Continue;
    stretch(case, statics, (y, true), (stage, options), false, &mut path, go_on);
    match (path.fault, path.states.last()) {
        (None, Some(last)) => {
            let y = last.y.clone();
            *held = StageEquilibrium { y, layout };
            Ok(())
        }
        (failed, _) => Err(lost(&failed.map_or_else(String::new, |fault| fault.what))),
    }
}

/// Opening of each valve of a system in which they are constant.
fn openings(system: &System) -> Vec<f64> {
    let links = system.model.wet.iter().flat_map(|wet| &wet.network.links);
    links
        .filter_map(|link| link.opening.as_ref())
        .map(|opening| opening.value(0.0))
        .collect()
}

/// Error for a beam that is not supported in some directions.
fn not_held(directions: &[&str]) -> SolverError {
    let directions = directions.join(" and ");
    let what = format!("there is no equilibrium: the beam is free to move {directions}");
    SolverError {
        cause: Some(format!(
            "nothing holds the beam {directions}: loads move it as a rigid body"
        )),
        hint: Some("hold an end (/ends), or attach a spring to ground (/attachments)".into()),
        ..fault(0.0, &what)
    }
}

/// Error for a closed network with a net inflow, in general or when a valve closes at `shuts` [s].
fn fed(stage: usize, inflow: f64, shuts: Option<f64>) -> SolverError {
    let [what, hint] = match shuts {
        Some(t) => [
            format!(
                "a valve shuts at t = {t} s while a closed network takes in {inflow:.3e} m^3/s: the volume behind the \
                 valve depends on the transient flow"
            ),
            "let the flow stop before the valve shuts, or use the state of a run at that instant (slcbeam run)".into(),
        ],
        None => [
            format!(
                "there is no equilibrium while a port pumps: a closed network takes in {inflow:.3e} m^3/s at that \
                 instant, and has no outlet"
            ),
            "choose an instant at which the flow has stopped (--at): the volume that entered before counts; or \
             prescribe this volume by volume_m3, open the network by a port with pressure_pa, or let the flows sum to \
             zero"
                .into(),
        ],
    };
    SolverError {
        cause: Some("a port with prescribed flow, and no port with prescribed pressure in the same network".into()),
        hint: Some(hint),
        ..fault(stage as f64, &what)
    }
}
