//! Errors that end a path before the requested load.

use super::path::{PathError, PathFollower};
use super::state::EquilibriumState;
use super::{EquilibriumEvent, EventKind};
use crate::discrete::ValveTangents;
use crate::error::numbers::counted;
use crate::error::{Code, SolverError, StopPoint};
use crate::integrate::halt::{self, INTERRUPTED};
use crate::sundials::KinsolError;

impl PathFollower<'_> {
    /// True if the load moves away from the requested one on the way to a state.
    pub(super) fn turns(&self, now: &EquilibriumState) -> bool {
        let away = |state: &EquilibriumState| (self.options.share - state.share).abs();
        let before = self.path.states.last().filter(|before| before.stage == now.stage);
        before.is_some_and(|before| away(now) > away(before))
    }

    /// Error for a load that turns back beyond the range of the model, where states describe no beam.
    pub(super) fn beyond(&mut self) -> PathError {
        let states = self.path.states.iter().filter(|state| state.stage == self.stage);
        let shares = states.map(|state| state.share);
        let asked = self.options.share.signum();
        let largest = asked * shares.map(|share| asked * share).fold(f64::NEG_INFINITY, f64::max);
        let beyond = self.path.beyond.as_deref().unwrap_or_default();
        // a crossing path may reduce the load at once
        let seen = self.path.events.last().map(|event| (event.stage, event.kind));
        if seen != Some((self.stage, EventKind::LimitPoint)) {
            self.path.events.push(EquilibriumEvent {
                stage: self.stage,
                share: largest,
                kind: EventKind::LimitPoint,
            });
        }
        let what = format!(
            "the load turns back at {} (limit point), outside the range of the model: {beyond}",
            self.options.place(self.stage, &format!("{largest:.4}"))
        );
        PathError(SolverError {
            cause: Some("loads that the beam cannot carry, or that exceed the range of the model".into()),
            hint: Some("keep the loads within the range of the model (--load-factor), or stiffen the beam".into()),
            ..fault(self.stage as f64 + largest, &what)
        })
    }

    pub(super) fn lost(&self, share: f64) -> PathError {
        let points = counted(self.path.states.len() as u64, "point");
        let factor = self.stage as f64 + share;
        let what = format!("the path does not reach the requested load factor: it ends after {points} at {factor:.4}");
        PathError(fault(factor, &what))
    }

    pub(super) fn fail(&self, failure: &KinsolError, share: f64) -> PathError {
        if halt::asked() {
            return stopped(self.stage as f64 + share, INTERRUPTED);
        }
        // if a state was found, the beam is supported
        let begun = self.path.states.iter().any(|state| state.stage == self.stage);
        let valves = ValveTangents::needed(self.solver.dae().statics_ref().system());
        let cause = match (begun, valves) {
            (true, true) => Some(VALVE_CAUSE.into()),
            (true, false) => Some(CAUSE.into()),
            (false, _) => None,
        };
        let fault = |share: f64, what: &str| {
            let fault = fault(share, what);
            SolverError {
                cause: cause.clone().or(fault.cause),
                hint: if begun && valves {
                    Some(VALVE_HINT.into())
                } else {
                    fault.hint
                },
                ..fault
            }
        };
        PathError(SolverError {
            unknown: failure.worst.clone(),
            ..fault(
                self.stage as f64 + share,
                &format!(
                    "no equilibrium is found beyond {}: {}",
                    self.options.place(self.stage, &format!("{share:.6}")),
                    failure.what
                ),
            )
        })
    }
}

/// Probable cause of the end of a path, and the one for a beam without fluid.
const CAUSE: &str = "two paths that meet, a coupling that is not convex, or a bladder that closes";
const DRY_CAUSE: &str = "two paths that meet or pass close to each other, or loads that the beam cannot carry";

/// Probable cause and hint for a network with valves that open by pressure.
const VALVE_CAUSE: &str = "a check valve or rectifier whose smoothing_pa is far below the acting pressures; or two \
                           paths that meet, a coupling that is not convex, or a bladder that closes";
const VALVE_HINT: &str = "use a larger smoothing_pa of the valve, or the state after a run (slcbeam run); examine the \
                          states up to this point";

/// Replaces the cause in the error of a beam without fluid, which has neither bladders nor a coupling.
pub(super) fn dry(mut fault: SolverError) -> SolverError {
    if fault.cause.as_deref() == Some(CAUSE) {
        fault.cause = Some(DRY_CAUSE.into());
    }
    fault
}

pub(super) fn fault(share: f64, what: &str) -> SolverError {
    SolverError {
        code: Code::NoEquilibrium,
        at: StopPoint::LoadFactor(share),
        what: what.into(),
        unknown: None,
        cause: Some(if share == 0.0 {
            "nothing holds the beam, or a part of the network has neither a bladder nor a prescribed pressure".into()
        } else {
            CAUSE.into()
        }),
        hint: Some(
            "examine the states up to this point; a small transverse load selects the direction in which a \
             symmetric beam bends"
                .into(),
        ),
    }
}

/// End of a path on request.
pub(super) fn stopped(share: f64, reason: &str) -> PathError {
    PathError(SolverError {
        code: Code::Interrupted,
        cause: None,
        hint: None,
        ..fault(share, reason)
    })
}
