//! Flow against the time it takes: none where the motion is fast, whole bladders where the bladder's own time is short.

use super::common::{run, shipped};
use super::limits::falls;

const SCENE: [&str; 4] = [
    "/time={\"end_s\":0.01,\"output_interval_s\":1e-4}",
    "/solver/rtol=1e-10",
    "/mesh/cells_per_segment=2",
    r#"/ends/root/clamped/u3_m={"sine":{"amplitude":1e-3,"frequency_hz":40,"ramp_cycles":1}}"#,
];

/// Undrained: what leaks in the time of the motion is `1/(ω τ)`, proportional to permeability.
#[test]
fn undrained_is_reached_as_permeability_goes_to_zero() {
    let of = |factor: f64, flow: &str| {
        let (factor, flow) = (
            format!("/network/permeability_factor={factor}"),
            format!("/effects={{\"flow\":\"{flow}\"}}"),
        );
        run(&shipped(
            "wiring-2",
            &[SCENE[0], SCENE[1], SCENE[2], SCENE[3], &factor, &flow],
        ))
    };
    let numbers = [1e-3, 1e-4, 1e-5];
    falls(
        "undrained",
        &numbers,
        1.0,
        0.1,
        |f| (of(f, "off"), of(f, "on")),
        "max_pressure",
    );
}

/// One volume a bladder: its own time `a_p l_b² μ/q1b` against that of the motion. The impedance of a sealed duct is
/// `1/iωC + R/3`, that of one volume behind half a bladder `1/iωC + R/2`: the error is of first order.
#[test]
fn bladders_are_one_volume_as_their_time_goes_to_zero() {
    let of = |permeability: f64, along: &str| {
        let (permeability, along) = (
            format!("/bladders/permeability_m4={permeability:e}"),
            format!("/effects={{\"flow_along_bladders\":\"{along}\"}}"),
        );
        let cells = "/mesh/cells_per_bladder=6";
        run(&shipped(
            "wiring-2",
            &[SCENE[0], SCENE[1], SCENE[2], SCENE[3], cells, &permeability, &along],
        ))
    };
    let numbers = [1e-3, 1e-4, 1e-5];
    falls(
        "one volume a bladder",
        &numbers,
        1.0,
        0.15,
        |n| (of(1.55e-14 / n, "off"), of(1.55e-14 / n, "on")),
        "tip_u3",
    );
}
