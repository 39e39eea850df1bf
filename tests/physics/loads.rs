//! Source: issue: "total force and moment are right on every mesh"; statics of beams.
//! Goal: loads along the beam, and the start, reach the mesh by their integrals and not by samples at nodes.
//! Tolerance: round-off where a sum must be right on every mesh; a few per cent of the finest mesh where cells bend.

use slcbeam::case::{Case, Profile};
use slcbeam::discrete::System;

use super::common::{run, shipped, within};

/// A quasi-static cantilever under a load of the given profile, grown within 1 s.
fn pressed(profile: &str, cells: usize) -> Case {
    let load = format!(
        r#"/loads=[{{"force_x_n_m":{{"signal":{{"ramp":{{"to":1,"duration_s":1}}}},"profile":{profile}}}}}]"#
    );
    let cells = format!("/mesh/cells_per_segment={cells}");
    let sets = [
        load.as_str(),
        r#"/effects={"solid_inertia":"off"}"#,
        r#"/beam/damping={"bending_time_s":0.001,"axial_time_s":0.001}"#,
        r#"/start={}"#,
        "/time/end_s=1.1",
        "/time/output_interval_s=0.05",
        &cells,
    ];
    shipped("dry-cantilever", &sets)
}

/// A pad of 1 % of the length, -60 N/m, beside 2 N/m everywhere. Its edges are steep, not sudden.
fn pad_at(middle: f64) -> String {
    let (a, b) = (middle - 0.005, middle + 0.005);
    let places = [0.0, a - 1e-6, a, b, b + 1e-6, 1.0];
    format!(
        r#"{{"sum":[2,{{"table":{{"positions":{places:?},"values":[0,0,-60,-60,0,0],"interpolation":"linear"}}}}]}}"#
    )
}

#[test]
fn a_narrow_pad_is_right_on_every_mesh() {
    for middle in [0.5, 0.5125, 0.61] {
        let tip = |cells| run(&pressed(&pad_at(middle), cells)).last("tip_u1");
        let finest = tip(64);
        // 2 N/m and -0.06 N at the place of the pad, small rotations.
        let (l, ei, p, at) = (0.1, super::common::EI, -0.06 * 0.1 * 10.0 * 0.1, middle * 0.1);
        let closed = 2.0 * l * l * l * l / (8.0 * ei) + 0.1 * p * 10.0 * at * at * (3.0 * l - at) / (6.0 * ei);
        println!("pad at {middle}: finest {finest:.4e} m, closed form {closed:.4e} m");
        for (cells, tolerance) in [(1, 0.05), (2, 0.02), (4, 0.01), (8, 0.005), (16, 0.005)] {
            within(&format!("tip on {cells} cells a segment"), tip(cells), finest, tolerance);
        }
    }
}

/// Force and its moment about the root, as the mesh has them.
fn resultants(case: &Case) -> (f64, f64) {
    let system = System::new(case);
    let shape = &system.loads[0].shape;
    (0..system.mesh.nodes).fold((0.0, 0.0), |(force, moment), i| {
        let at_node = shape[i] * system.mesh.node_length(i);
        (force + at_node, moment + at_node * system.mesh.node_coordinate(i))
    })
}

#[test]
fn twenty_waves_over_ten_segments_do_not_alias() {
    for cells in [1, 2, 4, 8] {
        let wave = r#"{"cosine":{"waves":20}}"#;
        let (force, moment) = resultants(&pressed(wave, cells));
        println!("{cells} cells: force {force:.1e} N, moment {moment:.1e} N m");
        assert!(force.abs() < 1e-15 && moment.abs() < 1e-16);
        let sine = r#"{"sine":{"waves":20}}"#;
        let (force, moment) = resultants(&pressed(sine, cells));
        assert!(force.abs() < 1e-15);
        // ∫ x sin(40 π x) dx = -1/40 π
        within("moment of a sine", moment, -0.01 / (40.0 * std::f64::consts::PI), 1e-12);
    }
}

#[test]
fn a_uniform_load_stays_exactly_what_it_was() {
    for profile in ["1", r#"{"sum":[0.25,0.75]}"#, r#"{"polynomial":{"coefficients":[1,0]}}"#] {
        let system = System::new(&pressed(profile, 4));
        assert!(system.loads[0].shape.iter().all(|s| *s == 1.0), "{profile}");
    }
    let _: Profile = Profile::one();
}
