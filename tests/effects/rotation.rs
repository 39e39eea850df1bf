//! Small rotations, and bending without the normal force.

use super::common::{run, shipped};
use super::limits::falls;

const SCENE: [&str; 4] = [
    "/time={\"end_s\":0.02,\"output_interval_s\":2e-4}",
    "/solver={\"rtol\":1e-11}",
    "/mesh={\"cells_per_segment\":2,\"cells_per_bladder\":1}",
    "/formulation=\"conservative\"",
];

fn scene(ends: &str, loads: &str, effects: &str) -> super::common::Run {
    let (ends, loads, effects) = (
        format!("/ends={ends}"),
        format!("/loads={loads}"),
        format!(
            "/effects={}",
            effects.replacen('{', r#"{"tube_inertia":"off","tube_losses":"off","#, 1)
        ),
    );
    let mut sets = SCENE.to_vec();
    sets.extend([ends.as_str(), loads.as_str(), effects.as_str()]);
    run(&shipped("wiring-2", &sets))
}

/// What is left out is of the order φ² relative to what is kept.
#[test]
fn small_rotations_err_with_the_square_of_the_angle() {
    let of = |force: f64, finite: &str| {
        let loads = format!(r#"[{{"force_x_n_m":{{"signal":{{"sine":{{"amplitude":{force},"frequency_hz":15}}}}}}}}]"#);
        let ends = r#"{"root":"clamped","tip":"free"}"#;
        scene(ends, &loads, &format!("{{\"finite_rotation\":\"{finite}\"}}"))
    };
    let pair = |force| (of(force, "off"), of(force, "on"));
    falls("small rotations", &[60.0, 30.0, 15.0], 2.0, 0.15, pair, "tip_u1");
}

/// Geometric stiffness against that of bending: N l_s²/EI.
#[test]
fn the_normal_force_acts_on_bending_in_proportion() {
    let of = |force: f64, acts: &str| {
        let loads = r#"[{"force_x_n_m":{"signal":{"sine":{"amplitude":1e-3,"frequency_hz":15}}}}]"#;
        let ends = format!(
            r#"{{"root":"clamped","tip":{{"free":{{"force_z_n":{{"sine":{{"amplitude":{force},"frequency_hz":10}}}}}}}}}}"#
        );
        let effects = format!("{{\"finite_rotation\":\"off\",\"axial_force_on_bending\":\"{acts}\"}}");
        scene(&ends, loads, &effects)
    };
    let pair = |force| (of(force, "off"), of(force, "on"));
    falls("axial force on bending", &[0.3, 0.03, 0.003], 1.0, 0.05, pair, "tip_u1");
}
