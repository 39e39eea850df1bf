//! Walls and circles that the beam comes to lie against, [E61], [E62] and [E85], against laws of one body integrated by themselves, statics and balances.

mod bodies;
#[path = "../common/chance.rs"]
mod chance;
mod circles;
#[path = "../differences/mod.rs"]
mod differences;
mod resting;
mod strikes;

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::Error;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::{Status, Summary};

use differences::worst_difference;

/// A case of a JSON value.
pub fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// Runs it to its end.
pub fn run(value: &Value) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let summary = dynamics::run(&parse(value), &mut memory).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    (memory, summary)
}

/// A dry beam with EI = 1 N m², EA = 1e4 N, m = 1 kg/m, l = 1 m.
pub fn beam(root: Value, tip: Value, contacts: Value) -> Value {
    let height = (12.0e-4_f64).sqrt();
    json!({
        "name": "struck",
        "beam": {"length_m": 1.0, "height_m": height, "width_m": 1.0, "young_modulus_pa": 1e4 / height, "density_kg_m3": 1.0 / height},
        "ends": {"root": root, "tip": tip},
        "contacts": contacts,
        "formulation": "conservative",
        "mesh": {"segments": 8, "cells_per_segment": 2},
        "time": {"end_s": 1.0},
        "solver": {"rtol": 1e-8}
    })
}

/// Source: a cantilever with a tip force F on a spring, `F - k (w - g_0 - d/2) = 3 EI w/l³`, linear. Goal: 1e-3, the mesh's error of the
/// cantilever; the wall's force is what it tells, and the recorded depth is that of the tip.
#[test]
fn a_stop_holds_a_cantilever() {
    let stop = json!([{"name": "stop", "point_m": [1e-3, 1], "normal": [-1, 0], "at": 1, "stiffness_n_m": 500, "reach_m": 0, "smoothing_m": 1e-5}]);
    let mut case = beam(json!("clamped"), json!({"free": {"force_x_n": 0.1}}), stop);
    case["effects"] = json!({"finite_rotation": "off", "axial_force_on_bending": "off"});
    let case = parse(&case);
    let path = follow(&case, &EquilibriumOptions::at(0.0), &mut |_| Control::Continue).unwrap();
    let row = &path.last().row;
    let columns = columns(&system(&case, 0.0).unwrap());
    let read = |name: &str| row[columns.iter().position(|c| c.name == name).unwrap()];
    let exact = (0.1 + 500.0 * (1e-3 + 5e-6)) / 503.0;
    let (w, force) = (read("tip_u1"), read("contact_stop_normal_force"));
    assert!((w / exact - 1.0).abs() < 1e-3, "{w} {exact}");
    assert!((read("contact_stop_depth") - (w - 1e-3)).abs() < 1e-12);
    assert!((force / (500.0 * (w - 1e-3 - 5e-6)) - 1.0).abs() < 1e-9, "{force}");
}

/// Goal: the Jacobian is that of the residual, pressed and not, sliding and not, in every kinematics and in the published form.
#[test]
fn the_jacobian_is_that_of_the_residual() {
    let walls = json!([
        {"name": "floor", "point_m": [0.01, 0.2], "normal": [-2, 1], "stiffness_pa": 100, "reach_m": 0, "smoothing_m": 0.05, "damping_s_m": 1,
         "friction_coefficient": 0.4, "friction_velocity_m_s": 0.3},
        {"name": "disc", "circle": {"center_m": [0.2, 0.6], "radius_m": 0.25}, "stiffness_pa": 80, "reach_m": 0.02, "smoothing_m": 0.05, "damping_s_m": 1,
         "friction_coefficient": 0.4, "friction_velocity_m_s": 0.3},
        {"name": "room", "circle": {"center_m": [0.1, 0.5], "radius_m": 0.4, "inside": true}, "at": 0.9, "stiffness_n_m": 30, "reach_m": 0, "smoothing_m": 0.05},
        {"name": "stop", "point_m": [-0.01, 1], "normal": [1, 0], "at": 0.83, "stiffness_n_m": 40, "reach_m": 0, "smoothing_m": 0.02, "damping_s_m": 0.5}
    ]);
    for (effects, formulation) in [
        (json!("full"), "conservative"),
        (json!("full"), "published"),
        (json!({"finite_rotation": "off"}), "conservative"),
        (
            json!({"finite_rotation": "off", "axial_force_on_bending": "off"}),
            "conservative",
        ),
    ] {
        let mut case = beam(json!("clamped"), json!("free"), walls.clone());
        case["effects"] = effects.clone();
        case["formulation"] = json!(formulation);
        for seed in 1..=6 {
            let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
            let off = worst_difference(&mut dae, seed, 0.3);
            assert!(off < 2e-6, "{effects} {formulation} {seed}: {off:e}");
        }
    }
}

/// Goal: a wall brings no unknown; one that is never touched changes nothing, to the last digit.
#[test]
fn a_wall_far_away_is_not_felt() {
    let far = json!([{"name": "far", "point_m": [-1, 0], "normal": [1, 0], "stiffness_pa": 1e5, "reach_m": 0, "smoothing_m": 1e-3}]);
    let drive = json!({"clamped": {"u1_m": {"sine": {"amplitude": 0.01, "frequency_hz": 1}}}});
    let mut with = beam(drive.clone(), json!("free"), far);
    let mut without = beam(drive, json!("free"), json!([]));
    for case in [&mut with, &mut without] {
        case["effects"] = json!("full");
        case["solver"] = json!({"rtol": 1e-5});
    }
    let unknowns = |case: &Value| BeamDae::new(System::new(&parse(case)).unwrap()).len();
    assert_eq!(unknowns(&with), unknowns(&without));
    let (a, b) = (run(&with).0, run(&without).0);
    assert_eq!(a.column("tip_u1"), b.column("tip_u1"));
    assert!(a.column("contact_far_depth").unwrap().iter().all(|d| *d < -0.9));
}

/// Goal: what a wall needs and what it does not go with is told, with its place.
#[test]
fn what_is_not_clear_is_refused() {
    let refused = |contact: Value, effects: Value, pointer: &str| {
        let mut case = beam(json!("clamped"), json!("free"), json!([contact]));
        case["effects"] = effects;
        let text = case.to_string();
        let case = case::parse(&text, Path::new("test.json"), Path::new(""), &[]);
        let Err(Error::Case(told)) = case.and_then(|case| System::new(&case)) else {
            panic!("{text} is taken");
        };
        assert!(
            told.violations.iter().any(|v| v.pointer == pointer),
            "{pointer}: {:?}",
            told.violations
        );
    };
    let wall = json!({"name": "w", "point_m": [-0.1, 0], "normal": [1, 0], "stiffness_pa": 1e3, "reach_m": 0, "smoothing_m": 1e-3});
    let with = |key: &str, value: Value| {
        let mut wall = wall.clone();
        wall[key] = value;
        wall
    };
    let auto = || json!("auto");
    refused(with("normal", json!([0, 0])), auto(), "/contacts/0/normal");
    refused(with("normal", json!(null)), auto(), "/contacts/0");
    let circle = |center: f64, radius: f64, inside: bool| json!({"center_m": [center, 0.5], "radius_m": radius, "inside": inside});
    refused(with("circle", circle(-0.2, 0.1, false)), auto(), "/contacts/0/circle");
    let round = |circle: Value| json!({"name": "c", "circle": circle, "stiffness_pa": 1e3, "reach_m": 0.1, "smoothing_m": 1e-3});
    for radius in [1e-7, 1e7, 1e300] {
        let pointer = "/contacts/0/circle/radius_m";
        refused(round(circle(-0.2, radius, false)), auto(), pointer);
    }
    for radius in [0.0, -1.0] {
        refused(
            round(circle(-0.2, radius, false)),
            auto(),
            "/contacts/0/circle/radius_m",
        );
    }
    refused(round(circle(1e300, 0.1, false)), auto(), "/contacts/0/circle/center_m");
    refused(round(circle(0.0, 0.1, true)), auto(), "/contacts/0/circle/radius_m");
    refused(round(json!({"center_m": [0, 0]})), auto(), "/contacts/0/circle");
    refused(
        round(json!({"center_m": [0], "radius_m": 1})),
        auto(),
        "/contacts/0/circle/center_m",
    );
    refused(with("stiffness_n_m", json!(10)), auto(), "/contacts/0");
    refused(
        with("friction_coefficient", json!(0.3)),
        auto(),
        "/contacts/0/friction_coefficient",
    );
    refused(
        with("friction_velocity_m_s", json!(0.3)),
        auto(),
        "/contacts/0/friction_velocity_m_s",
    );
    refused(
        with("damping_s_m", json!(0.3)),
        json!({"solid_inertia": "off"}),
        "/effects/solid_inertia",
    );
    refused(
        wall.clone(),
        json!({"transverse_motion": "off"}),
        "/effects/transverse_motion",
    );
    let stretch = json!({"finite_rotation": "off", "axial_stretch": "off"});
    refused(wall.clone(), stretch, "/effects/axial_stretch");
}

/// Goal: a beam that begins inside a wall, and one that is pressed in by more than half its height, say so.
#[test]
fn deep_contact_is_told() {
    let warns = |point: f64, velocity: f64| {
        let wall = json!([{"name": "soft", "point_m": [point, 0], "normal": [1, 0], "stiffness_pa": 10, "reach_m": 0, "smoothing_m": 1e-3}]);
        let mut case = beam(json!("free"), json!("free"), wall);
        case["start"] = json!({"u1_rate_m_s": velocity});
        case["solver"] = json!({"rtol": 1e-4});
        let warnings = run(&case).1.warnings;
        warnings
            .into_iter()
            .filter(|w| w.starts_with("W023"))
            .collect::<Vec<_>>()
    };
    assert!(warns(-0.01, 0.0).is_empty());
    assert!(warns(1e-3, 0.0)[0].contains("begins"));
    assert!(warns(-0.01, -0.3)[0].contains("half its height"));
}

/// Goal: a beam touches with its surface unless it says otherwise: half its height in front of the line of its centre.
#[test]
fn a_beam_touches_with_its_surface() {
    let wall = json!([{"name": "w", "point_m": [-0.1, 0], "normal": [3, 0], "stiffness_pa": 1e3, "smoothing_m": 1e-3}]);
    let mut case = beam(json!("clamped"), json!("free"), wall);
    let half_height = 0.5 * case["beam"]["height_m"].as_f64().unwrap();
    let depth = |case: &Value| run(case).0.column("contact_w_depth").unwrap()[0];
    assert!((depth(&case) - (half_height - 0.1)).abs() < 1e-15);
    case["contacts"][0]["reach_m"] = json!(0.03);
    assert!((depth(&case) + 0.07).abs() < 1e-15);
}
