//! Errors that end a run, with cause and hint.

use super::stall::STALL_STEPS;
use crate::error::{Code, SolverError, StopPoint};
use crate::integrate::{IntegrationError, StartError};

pub(super) fn fault(failure: &IntegrationError) -> SolverError {
    SolverError {
        code: if failure.singular.is_some() {
            Code::Singular
        } else {
            Code::Integrator
        },
        at: StopPoint::Time(failure.time),
        what: failure.to_string(),
        unknown: failure
            .worst
            .as_ref()
            .map(|w| w.name.clone())
            .or_else(|| failure.singular.clone()),
        cause: Some(
            if failure.singular.is_some() {
                "the equations have no unique solution here: the quasi-static beam buckles, or the coupling is not \
                 convex"
            } else {
                "the solution changes faster than the smallest step resolves: a closing bladder, an instability, or a \
                 tolerance beyond double precision"
            }
            .into(),
        ),
        hint: Some(
            "examine the balances and fields up to this time; try another rtol, a wider kink_width, a larger \
             smoothing_pa or more leak of check valves, or damping"
                .into(),
        ),
    }
}

/// Error at a time, with a description, the likely cause and a hint.
fn at(t: f64, code: Code, [what, cause, hint]: [&str; 3]) -> SolverError {
    SolverError {
        code,
        at: StopPoint::Time(t),
        what: what.into(),
        unknown: None,
        cause: Some(cause.into()),
        hint: Some(hint.into()),
    }
}

pub(super) fn beyond(t: f64, what: String) -> SolverError {
    let cause = "loads, pressures or flows exceed the range of the model, or the motion grows without bounds";
    let hint = "results are valid up to this time; examine the fields before it, and check the units of loads and \
                flows";
    at(t, Code::OutOfRange, [&what, cause, hint])
}

pub(super) fn too_many_steps(t: f64, step: f64) -> SolverError {
    let what = format!("the allowed number of steps is used up at t = {t:.6} s, with steps of {step:.2e} s");
    let cause = "fast waves that the tolerance requires to be resolved";
    at(
        t,
        Code::Steps,
        [&what, cause, "raise /solver/max_steps, or loosen /solver/rtol"],
    )
}

pub(super) fn inconsistent(t: f64, failure: &StartError) -> SolverError {
    let (what, cause, hint) = if t == 0.0 {
        (
            "no consistent start".to_string(),
            "start values that contradict each other, or a model without a unique state",
            "run `slcbeam check`, and examine /start and /ends of the case",
        )
    } else {
        (
            format!("no consistent state after the switching time {t:.6} s"),
            "after the switch the equations have no unique state",
            "switch more slowly (a ramp with a duration)",
        )
    };
    SolverError {
        unknown: failure.worst.as_ref().map(|(_, name)| name.clone()),
        ..at(t, Code::NoStart, [&format!("{what}: {}", failure.what), cause, hint])
    }
}

pub(super) fn stalled(t: f64, step: f64) -> SolverError {
    let what =
        format!("no progress: {STALL_STEPS} steps hardly advanced the time from t = {t:.9} s (step {step:.2e} s)");
    let cause = "the solution changes ever faster towards this time: a closing bladder, an instability, a jump";
    let hint = "examine the fields just before this time; damping or a smoother signal may help";
    at(t, Code::Integrator, [&what, cause, hint])
}
