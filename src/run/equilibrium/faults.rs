//! Why a path ends before the load that is asked for.

use super::path::{End, Follower};
use super::state::State;
use super::{Event, Kind};
use crate::discrete::ValveTangents;
use crate::error::numbers::counted;
use crate::error::{At, Code, SolverError};
use crate::integrate::halt::{self, INTERRUPTED};
use crate::sundials::KinsolError;

impl Follower<'_> {
    /// True if the load moves away from the one that is asked for on the way to a state.
    pub(super) fn turns(&self, now: &State) -> bool {
        let away = |state: &State| (self.options.share - state.share).abs();
        let before = self.path.states.last().filter(|before| before.stage == now.stage);
        before.is_some_and(|before| away(now) > away(before))
    }

    /// The load turns back beyond the range of the model: what follows describes no beam.
    pub(super) fn beyond(&mut self) -> End {
        let states = self.path.states.iter().filter(|state| state.stage == self.stage);
        let shares = states.map(|state| state.share);
        let asked = self.options.share.signum();
        let largest = asked * shares.map(|share| asked * share).fold(f64::NEG_INFINITY, f64::max);
        let beyond = self.path.beyond.as_deref().unwrap_or_default();
        // a path that crosses may lead down at once
        let seen = self.path.events.last().map(|event| (event.stage, event.kind));
        if seen != Some((self.stage, Kind::LimitPoint)) {
            self.path.events.push(Event {
                stage: self.stage,
                share: largest,
                kind: Kind::LimitPoint,
            });
        }
        let what = format!(
            "the load turns back at {} (limit point) after the range of the model has been left: {beyond}",
            self.options.place(self.stage, &format!("{largest:.4}"))
        );
        End(SolverError {
            cause: Some("loads beyond those that the beam can bear, or beyond those that the model describes".into()),
            hint: Some(
                "keep the loads below those at which the range is left (--load-factor), or stiffen the beam".into(),
            ),
            ..fault(self.stage as f64 + largest, &what)
        })
    }

    pub(super) fn lost(&self, share: f64) -> End {
        let points = counted(self.path.states.len() as u64, "point");
        let factor = self.stage as f64 + share;
        let what = format!(
            "the path does not come to the load factor that is asked for: it ends after {points} at {factor:.4}"
        );
        End(fault(factor, &what))
    }

    pub(super) fn fail(&self, failure: &KinsolError, share: f64) -> End {
        if halt::asked() {
            return stopped(self.stage as f64 + share, INTERRUPTED);
        }
        // where a state has been found, what holds it is there
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
        End(SolverError {
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

/// What probably ends a path, and what of a beam without fluid.
const CAUSE: &str = "two paths that meet, a coupling that is not convex, a bladder that closes";
const DRY_CAUSE: &str = "two paths that meet or pass close by each other, or loads beyond those that the beam can bear";

/// The same of a network with valves that open by themselves.
const VALVE_CAUSE: &str = "a check valve or rectifier that opens over a pressure far below those that act; or two paths that meet, a coupling that is not convex, a bladder that closes";
const VALVE_HINT: &str =
    "a larger smoothing_pa of the valve, or the state after a run (slcbeam run); look at the states up to there";

/// The same fault of a beam without fluid: neither bladders nor a coupling are a cause.
pub(super) fn dry(mut fault: SolverError) -> SolverError {
    if fault.cause.as_deref() == Some(CAUSE) {
        fault.cause = Some(DRY_CAUSE.into());
    }
    fault
}

pub(super) fn fault(share: f64, what: &str) -> SolverError {
    SolverError {
        code: Code::NoEquilibrium,
        at: At::LoadFactor(share),
        what: what.into(),
        unknown: None,
        cause: Some(if share == 0.0 {
            "nothing holds the beam, or a part of the network has neither bladder nor pressure".into()
        } else {
            CAUSE.into()
        }),
        hint: Some("look at the states up to there; a small load across tells which way a symmetric beam bends".into()),
    }
}

/// The end of a path that somebody asked for.
pub(super) fn stopped(share: f64, reason: &str) -> End {
    End(SolverError {
        code: Code::Interrupted,
        cause: None,
        hint: None,
        ..fault(share, reason)
    })
}
