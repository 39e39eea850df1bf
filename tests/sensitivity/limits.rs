//! Checkpoints, the integrator, and what is refused.

use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;

use super::common::{beam, finished, parse, wet};

/// Checkpoints restart the integrator with the sensitivities that it has reached: derivatives change by what the tolerance leaves.
#[test]
fn checkpoints_change_nothing() {
    let mut value = wet(0.01);
    let pointer = "/fluid/viscosity_pa_s";
    let slopes = |value: &Value| {
        let case = parse(value, &[]);
        let parameter = Parameter::find(&case, pointer).unwrap();
        let memory = finished(&case, &[parameter]).0;
        let of = |name| memory.sensitivity(name, pointer).unwrap();
        (memory.checkpoints.len(), [of("max_pressure"), of("dissipated_tubes")])
    };
    let (none, through) = slopes(&value);
    value["time"]["checkpoint_interval_s"] = json!(0.003);
    let (some, restarted) = slopes(&value);
    assert_eq!((none, some), (0, 3));
    for (through, restarted) in through.iter().zip(&restarted) {
        let largest = through.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (a, b) in through.iter().zip(restarted) {
            assert!((a - b).abs() < 1e-3 * largest, "{a:e} {b:e} of {largest:e}");
        }
    }
}

/// Sensitivities are IDA's: a case that would take a one-step method takes IDA, and says so.
#[test]
fn integrator_is_ida() {
    let mut value = beam(0.001);
    value["solver"] = json!({"rtol": 1e-4, "method": "esdirk46"});
    let case = parse(&value, &[]);
    let usual = finished(&case, &[]).1.effects["method"].clone();
    let parameter = Parameter::find(&case, "/beam/young_modulus_pa").unwrap();
    let method = finished(&case, &[parameter]).1.effects["method"].clone();
    assert_eq!(usual.value, "ESDIRK4(3)6");
    assert_eq!(method.value, "IDA");
    assert!(method.reason.contains(&usual.value), "{}", method.reason);
}

/// A number that moves a switching time past the end of the run has no derivative there.
#[test]
fn switching_times_stay_in_order() {
    let mut value = beam(0.01);
    value["ends"]["tip"] =
        json!({"free": {"force_x_n": {"ramp": {"from": 0.0, "to": 0.05, "start_s": 0.00999, "duration_s": 0.0}}}});
    let case = parse(&value, &[]);
    let parameter = Parameter::find(&case, "/ends/tip/free/force_x_n/ramp/start_s").unwrap();
    match dynamics::run_with(&case, System::new(&case).unwrap(), &[parameter], &mut Memory::default()) {
        Err(Error::Usage(what)) => assert!(what.contains("switching times"), "{what}"),
        other => panic!("{other:?}"),
    }
}

/// What has no derivative is refused with one message.
#[test]
fn refusals() {
    let mut value = wet(0.01);
    value["start"]["u1_m"] = json!(0.0);
    let case = parse(&value, &[]);
    let refused = |pointer: &str| match Parameter::find(&case, pointer) {
        Err(Error::Usage(what)) => what,
        other => panic!("{pointer}: {other:?}"),
    };
    for (pointer, word) in [
        ("fluid/viscosity_pa_s", "nearest is /fluid/viscosity_pa_s"),
        ("/fluid/viscosty_pa_s", "nearest is /fluid/viscosity_pa_s"),
        ("/fluid", "no number"),
        ("/bladders/per_row", "count"),
        ("/start/u1_m", "it is 0"),
        ("/name", "not a part of the model"),
        ("/time/end_s", "not a part of the model"),
        ("/solver/rtol", "not a part of the model"),
        ("/mesh/cells_per_segment", "not a part of the model"),
        ("/bladders/coupling", "no number"),
    ] {
        let what = refused(pointer);
        assert!(what.contains(word) && what.contains(pointer), "{what}");
    }
}
