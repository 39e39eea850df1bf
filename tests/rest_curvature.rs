//! A beam that is curved at rest, [E59].

#[path = "common/balances.rs"]
mod balances;
#[path = "common/chance.rs"]
mod chance;
mod differences;
#[path = "common/scene.rs"]
mod scene;

use std::path::Path;

use balances::close;
use differences::worst_difference;
use scene::{finished, parse};
use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::Control;

/// A strip 0.1 m long whose loads are these, with changes.
fn strip(loads: Value, sets: Value) -> Value {
    let mut case = json!({
        "name": "strip",
        "beam": {"length_m": 0.1, "height_m": 0.004, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000},
        "loads": loads,
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 10, "cells_per_segment": 1},
        "time": {"end_s": 0.5, "output_interval_s": 0.02},
        "solver": {"rtol": 1e-9}
    });
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

fn curved(signal: Value, profile: Value) -> Value {
    json!({"rest_curvature_1_m": {"signal": signal, "profile": profile}})
}

fn at_rest(case: Value) -> impl Fn(&str) -> f64 {
    let case = parse(&case);
    let path = follow(&case, &EquilibriumOptions::at(0.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let names = columns(&system(&case, 0.0).unwrap());
    let row = path.last().row.clone();
    move |name| row[names.iter().position(|c| c.name == name).unwrap()]
}

/// Source: a beam of curvature κ_0 on which nothing acts is an arc: angle -κ_0 l, `x = -(1 - cos κ_0 l)/κ_0`, no moment. Goal: to second order in
/// the mesh, the angle exactly, over three quarters of a circle too; a profile's angle is its integral.
#[test]
fn what_nothing_acts_on_has_its_own_shape() {
    for kappa in [5.0, -47.0] {
        let error = |cells: usize| {
            let mesh = json!({"segments": cells, "cells_per_segment": 1});
            let of = at_rest(strip(json!([curved(json!(kappa), json!(1))]), json!({"mesh": mesh})));
            assert!((of("tip_angle") + kappa * 0.1).abs() < 1e-9 * kappa.abs());
            assert!(of("bending_energy") < 1e-20);
            of("tip_u1") + (1.0 - (kappa * 0.1_f64).cos()) / kappa
        };
        let (coarse, fine) = (error(10), error(20));
        assert!(
            (3.9..4.1).contains(&(coarse / fine)) && fine.abs() < 1e-4,
            "{coarse:e} {fine:e}"
        );
    }
    let grown = json!({"polynomial": {"coefficients": [1, 0, 6]}});
    let of = at_rest(strip(json!([curved(json!(5), grown)]), json!({})));
    assert!((of("tip_angle") + 5.0 * 0.1 * 3.0).abs() < 1e-9);
}

/// Source: superposition of small rotations. Goal: loads bend a curved beam that turns little by as much as a straight one; clamped at both ends a
/// uniform curvature is held by the moment -EI κ_0 everywhere.
#[test]
fn loads_and_ends_hold_it() {
    let small = json!({"finite_rotation": "off", "axial_force_on_bending": "off"});
    let tip = |loads: Value| at_rest(strip(loads, json!({"effects": small})))("tip_u1");
    let push = json!({"force_x_n_m": {"signal": 1e-3}});
    let rest = curved(json!(0.3), json!(1));
    let sum = tip(json!([push])) + tip(json!([rest]));
    assert!((tip(json!([push, rest])) / sum - 1.0).abs() < 1e-10);
    let probe = json!([{"name": "middle", "at": 0.5}]);
    let held = json!({"root": "clamped", "tip": "clamped"});
    let of = at_rest(strip(json!([rest]), json!({"ends": held, "probes": probe})));
    let ei = 1e6 * 0.02 * 0.004_f64.powi(3) / 12.0;
    assert!((of("middle_moment") / (-0.3 * ei) - 1.0).abs() < 1e-9 && of("middle_u1").abs() < 1e-12);
}

const WAVE: &str = r#"{"sine": {"amplitude": 5, "frequency_hz": 4}}"#;

fn scenes() -> Vec<(&'static str, Value)> {
    let wave: Value = serde_json::from_str(WAVE).unwrap();
    let loads = json!([curved(wave, json!({"polynomial": {"coefficients": [1, -0.5]}})), {"gravity": {"x_m_s2": 2}}]);
    let beam = |more: Value| {
        let mut beam = strip(json!([]), json!({}))["beam"].clone();
        beam.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        beam
    };
    let relaxing = json!({"viscoelasticity": {"prony": [{"modulus_ratio": 0.8, "time_s": 0.05}]}});
    let turned =
        json!({"root": "clamped", "tip": {"free": {"moment_n_m": {"sine": {"amplitude": 2e-4, "frequency_hz": 3}}}}});
    vec![
        ("alone", strip(loads.clone(), json!({}))),
        (
            "damped",
            strip(
                loads.clone(),
                json!({"beam": beam(json!({"damping": {"bending_time_s": 5e-3}}))}),
            ),
        ),
        (
            "relaxing",
            strip(loads.clone(), json!({"beam": beam(relaxing.clone()), "ends": turned})),
        ),
        (
            "small",
            strip(
                loads.clone(),
                json!({"effects": {"finite_rotation": "off"}, "ends": turned}),
            ),
        ),
        (
            "at rest",
            strip(
                loads.clone(),
                json!({"effects": {"solid_inertia": "off"}, "beam": beam(relaxing)}),
            ),
        ),
        ("free", strip(loads, json!({"ends": {"root": "free", "tip": "free"}}))),
    ]
}

/// Goal: energy and momentum close while the curvature changes: what changes it works on the beam.
#[test]
fn balances_close() {
    for (what, case) in scenes() {
        close(what, &finished(&case).1, 1e-6);
    }
    let wet = json!({
        "name": "wet", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5]}]},
        "loads": [curved(json!({"sine": {"amplitude": 2, "frequency_hz": 8}}), json!(1))],
        "ends": {"root": "clamped", "tip": "free"},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "time": {"end_s": 0.2, "output_interval_s": 0.002}, "solver": {"rtol": 1e-9}
    });
    close("wet", &finished(&wet).1, 1e-6);
}

/// Goal: it brings no unknown; the Jacobian is that of the residual.
#[test]
fn unknowns_and_their_jacobian() {
    for (what, case) in scenes() {
        let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
        for (seed, size) in [(1, 0.3), (2, 0.1)] {
            let worst = worst_difference(&mut dae, seed, size);
            assert!(worst < 1e-6, "{what} {worst:e}");
        }
    }
}

/// Goal: what cannot be is told at its place.
#[test]
fn mistakes_are_told_at_their_place() {
    let step = json!({"ramp": {"to": 1, "start_s": 0.1, "duration_s": 0}});
    let mut damped = strip(json!([curved(step, json!(1))]), json!({}));
    damped["beam"]["damping"] = json!({"bending_time_s": 1e-3});
    let off = json!({"effects": {"transverse_motion": "off"}});
    for (case, told) in [
        (
            strip(json!([curved(json!(1), json!(1))]), json!({"formulation": "published"})),
            "/loads/0/rest_curvature_1_m",
        ),
        (
            strip(json!([curved(json!(1e5), json!(1))]), json!({})),
            "/loads/0/rest_curvature_1_m",
        ),
        (damped, "/loads/0/rest_curvature_1_m/signal"),
        (strip(json!([curved(json!(1), json!(1))]), off), "acts across the beam"),
    ] {
        let faults = match case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[]) {
            Err(faults) => format!("{faults:?}"),
            Ok(case) => format!("{:?}", System::new(&case).err()),
        };
        assert!(faults.contains(told), "{faults}");
    }
}
