//! Zero loads, tiny loads, and impossible ones.

use slcbeam::run::summary::Status;

use crate::harness::{COMBINATIONS, run};

/// Goal: a resting beam remains at rest for 10^6 s, in a handful of steps (steps double from a thousandth of the run to a tenth of it; 10 +
/// 10 + the start).
#[test]
fn rest_for_a_million_seconds() {
    for (name, sets) in COMBINATIONS {
        let ran = run("rest", &sets).sound().steps_within(5, 20);
        for column in ["tip_u1", "tip_u3", "max_pressure", "kinetic_energy"] {
            assert_eq!(ran.largest(column), 0.0, "{name}: {column}");
        }
        ran.line(name);
    }
}

/// Goal: a load for a second, then rest for 10^6 s: nine decades of time in a few hundred steps. Before the axial scale depended on
/// bending: 3.7 million steps for the first quarter.
#[test]
fn settling_for_a_million_seconds() {
    for (name, sets) in COMBINATIONS {
        let ran = run("settle", &sets).sound().steps_within(8, 666);
        let (early, late) = (ran.column("tip_u1")[1], ran.last("tip_u1"));
        let ran = ran.line(&format!(
            "{name}, tip u1 {late:.5e} m, drift {:.1e}",
            late / early - 1.0
        ));
        assert!((late / early - 1.0).abs() < 1e-3, "{}", ran.name);
    }
}

/// Goal: an impossible motion (a root that runs into the beam faster than axial waves) ends with a time, a place and a cause instead of
/// numbers.
#[test]
fn a_crushed_beam_is_diagnosed() {
    for (name, sets) in &COMBINATIONS[..2] {
        let ran = run("crushed", sets);
        let reason = ran.summary.reason.clone().unwrap_or_default();
        println!(
            "crushed, {name} | {} steps | {:?} at {:.6} s: {reason}",
            ran.steps(),
            ran.summary.status,
            ran.summary.time_s
        );
        assert!(ran.record.rows.iter().flatten().all(|v| v.is_finite()), "{name}");
        match ran.summary.status {
            Status::Finished => {
                ran.sound();
            }
            Status::Stopped => panic!("{name}: nobody asked it to stop: {reason}"),
            Status::OutOfRange => assert!(
                reason.contains("reached") && reason.contains("t = "),
                "{name}: {reason}"
            ),
            Status::Failed => {
                let fault = ran.fault.expect("a failure has a fault");
                assert!(
                    fault.at.time_s().is_some_and(|t| t > 0.0) && fault.cause.is_some() && fault.hint.is_some(),
                    "{name}: {fault:?}"
                );
            }
        }
    }
}
