//! One pressure for each network: the limit of flow that is fast against the motion, ω τ → 0. The error is the pressure drop
//! along the network, of first order in ω τ, proportional to the inverse of the permeability.

use super::common::{run, shipped};
use super::limits::falls;

const SCENE: [&str; 4] = [
    "/time={\"end_s\":0.02,\"output_interval_s\":2e-4}",
    "/solver={\"rtol\":1e-10}",
    "/mesh={\"cells_per_segment\":2,\"cells_per_bladder\":1}",
    r#"/ends/root/clamped={"u3_m":{"sine":{"amplitude":1e-3,"frequency_hz":40,"ramp_cycles":1}},
        "u1_m":{"sine":{"amplitude":1e-3,"frequency_hz":30,"ramp_cycles":1}}}"#,
];

/// Pairs of runs of a network, ever more permeable.
fn uniform(what: &str, chains: &str, column: &str) {
    let of = |inverse: f64, effects: &str| {
        let network = format!(
            r#"/network={{"chains":{chains},"permeability_factor":{}}}"#,
            1.0 / inverse
        );
        let effects = format!("/effects={{\"network_pressure_differences\":\"{effects}\"}}");
        let mut sets = SCENE.to_vec();
        sets.extend([network.as_str(), effects.as_str()]);
        run(&shipped("wiring-2", &sets))
    };
    let numbers = [1e-2, 1e-3, 1e-4];
    falls(what, &numbers, 1.0, 0.1, |n| (of(n, "off"), of(n, "on")), column);
}

#[test]
fn a_closed_network_has_one_pressure() {
    uniform(
        "closed",
        r#"[{"bladders":[1,2,3,4,5,-6,-7]},{"bladders":[-1,-2,-3]}]"#,
        "max_pressure",
    );
}

#[test]
fn a_network_has_the_pressure_of_its_port() {
    let port = r#"{"pressure_pa":{"sine":{"amplitude":2000,"frequency_hz":50}}}"#;
    uniform(
        "port",
        &format!(r#"[{{"bladders":[1,2,3,4,5],"ends":[{port},{port}]}}]"#),
        "tip_u1",
    );
}

#[test]
fn a_network_takes_in_what_is_fed() {
    uniform(
        "fed",
        r#"[{"bladders":[1,2,3,4,5],"ends":[{"flow_m3_s":{"sine":{"amplitude":1e-7,"frequency_hz":50}}},"sealed"]}]"#,
        "max_pressure",
    );
}
