//! A beam in a fluid, beside `surroundings.rs`: drifting, tumbling, kicked at an angle; what is refused; what is chosen.
//!
//! Sources: a body that drifts with quadratic drag, solved in closed form; conservation laws; the whole model.

use std::f64::consts::FRAC_PI_4;
use std::path::Path;

use crate::balances::close;
use crate::scene::{finished, parse};
use serde_json::{Value, json};
use slcbeam::case;
use slcbeam::discrete::System;
use slcbeam::error::Error;

/// Puts keys of one object into another.
fn with(mut case: Value, sets: &Value) -> Value {
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

const HEIGHT: f64 = 0.01;
const MASS: f64 = 0.19;

/// A cantilever of 0.1 m by 0.02 m by 0.01 m, m = 0.19 kg/m.
fn beam(sets: &Value) -> Value {
    let case = json!({
        "name": "around",
        "beam": {"length_m": 0.1, "height_m": HEIGHT, "width_m": 0.02, "young_modulus_pa": 2e6, "density_kg_m3": 950},
        "ends": {"root": "clamped", "tip": "free"},
        "formulation": "conservative",
        "mesh": {"segments": 8, "cells_per_segment": 1},
        "time": {"end_s": 0.2, "output_interval_s": 0.01},
        "solver": {"rtol": 1e-9, "max_order": 5}
    });
    with(case, sets)
}

/// Goal: what a beam feels is its velocity against the stream: set free in a stream U it drifts as `v = U - U/(1 + t/τ)`,
/// `τ = (m + m_a)/(c U)`, and the energy closes.
#[test]
fn a_free_beam_drifts_with_a_stream() {
    let (density, drag, stream) = (1000.0, 2.0, 0.3);
    let c = 0.5 * drag * density * 0.02;
    let tau = (MASS + FRAC_PI_4 * density * 4e-4) / (c * stream);
    let (memory, summary) = finished(&beam(&json!({
        "surroundings": {"density_kg_m3": density, "drag_coefficient": drag, "stream_x_m_s": stream},
        "ends": {"root": "free", "tip": "free"},
        "time": {"end_s": 5.0 * tau, "output_interval_s": 0.5 * tau}
    })));
    let (t, u) = (memory.column("t").unwrap(), memory.column("tip_u1").unwrap());
    let drifted = |t: f64| stream * (t - tau * (1.0 + t / tau).ln());
    let off = t
        .iter()
        .zip(&u)
        .map(|(&t, u)| (u - drifted(t)).abs() / drifted(5.0 * tau));
    let worst = off.fold(0.0, f64::max);
    let energy = summary.balances.energy_residual_relative;
    println!("drift to {worst:.1e}, energy {energy:.1e}");
    assert!(t.len() > 9 && worst < 1e-6 && energy.abs() < 1e-6);
}

/// A root that is driven both ways, gravity, a stream in both directions that comes and goes.
fn everything(sets: &Value) -> Value {
    let case = beam(&json!({
        "ends": {"root": {"pinned": {"u1_m": {"sine": {"amplitude": 2e-3, "frequency_hz": 12, "ramp_cycles": 1}},
                                     "u3_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 9}}}}, "tip": "free"},
        "loads": [{"gravity": {"x_m_s2": 3.0, "z_m_s2": -9.81}},
                  {"body_x_m_s2": {"signal": {"sine": {"amplitude": 5, "frequency_hz": 7}}, "profile": {"polynomial": {"coefficients": [0, 1]}}}}],
        "surroundings": {"density_kg_m3": 1000, "drag_coefficient": 2,
                         "stream_x_m_s": {"sine": {"amplitude": 0.2, "frequency_hz": 6}}, "stream_z_m_s": 0.1},
        "effects": "full"
    }));
    with(case, sets)
}

/// Goal: energy, momentum and angular momentum close to the integrator's accuracy in still water and in a
/// stream, under a root that is driven both ways and kicked in either, with and without sections that turn.
#[test]
fn balances_close_in_water() {
    let still = json!({"density_kg_m3": 1000, "drag_coefficient": 2});
    let frictionless = json!({"density_kg_m3": 1000});
    let cases = [
        ("stream", json!({})),
        ("still", json!({"surroundings": still})),
        ("no drag", json!({"surroundings": frictionless})),
        ("published", json!({"surroundings": still, "formulation": "published"})),
        (
            "small rotation",
            json!({"surroundings": still, "effects": {"finite_rotation": "off"}}),
        ),
        (
            "linear",
            json!({"effects": {"finite_rotation": "off", "axial_force_on_bending": "off"}}),
        ),
        (
            "without stretch",
            json!({"surroundings": still, "effects": {"finite_rotation": "off", "axial_stretch": "off"}}),
        ),
        (
            "kicked",
            json!({"surroundings": still, "ends": {"root": {"pinned": {"u1_m": {"ramp": {"to": 2e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"}}),
        ),
        (
            "kicked at an angle",
            json!({"surroundings": still, "ends": {"root": {"pinned": {
                "u1_m": {"sine": {"amplitude": 2e-2, "frequency_hz": 5}},
                "u3_m": {"ramp": {"to": 2e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"}}),
        ),
        (
            "kicked in a stream",
            json!({"ends": {"root": {"pinned": {"u1_m": {"ramp": {"to": 2e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"}}),
        ),
        (
            "kicked without rotary inertia",
            json!({"surroundings": still, "effects": {"rotary_inertia": "off"},
                "ends": {"root": {"pinned": {"u1_m": {"ramp": {"to": 2e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"}}),
        ),
        (
            "kicked across only",
            json!({"surroundings": still, "effects": {"rotary_inertia": "off"},
                "ends": {"root": {"conditions": {"u1_m": {"ramp": {"to": 2e-3, "start_s": 0.15, "duration_s": 0.05, "shape": "linear"}},
                    "force_z_n": 0.0, "moment_n_m": 0.01}}, "tip": "free"}}),
        ),
    ];
    for (what, sets) in cases {
        close(what, &finished(&everything(&sets)).1, 1e-7);
    }
}

/// Goal: a beam shot through frictionless water keeps beam's and water's energy together, while it tumbles.
#[test]
fn nothing_is_lost_without_drag() {
    let (memory, summary) = finished(&beam(&json!({
        "surroundings": {"density_kg_m3": 1000},
        "ends": {"root": "free", "tip": "free"},
        "loads": [{"body_x_m_s2": {"signal": {"ramp": {"from": 40, "to": 0, "start_s": 0.05, "duration_s": 0.05}},
                                   "profile": {"polynomial": {"coefficients": [0, 1]}}}}],
        "time": {"end_s": 0.6, "output_interval_s": 0.01}
    })));
    let water = memory.column("surrounding_energy").unwrap();
    let largest = water.iter().copied().fold(0.0, f64::max);
    println!(
        "in water {largest:.2e} J, residual {:.1e}",
        summary.balances.energy_residual_relative
    );
    assert!(largest > 0.0 && summary.balances.energy_residual_relative.abs() < 1e-7);
}

/// Goal: sizes that cannot be, and effects that a stream has no meaning without, are refused where they stand.
#[test]
fn what_cannot_surround_is_refused() {
    for (key, value) in [
        ("density_kg_m3", json!(-1)),
        ("drag_coefficient", json!(-1)),
        ("added_mass_coefficient", json!(-1)),
        ("stream_x_m_s", json!(1e9)),
    ] {
        let mut case = beam(&json!({"surroundings": {"density_kg_m3": 1000, "drag_coefficient": 2}}));
        case["surroundings"][key] = value;
        let error = case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[]).unwrap_err();
        let Error::Case(fault) = &error else {
            panic!("{error:?}")
        };
        let places: Vec<&str> = fault.violations.iter().map(|fault| fault.pointer.as_str()).collect();
        assert_eq!(places, [format!("/surroundings/{key}")]);
    }
    let case = beam(&json!({
        "surroundings": {"density_kg_m3": 1000, "drag_coefficient": 2, "stream_x_m_s": 0.1},
        "effects": {"transverse_motion": "off"}
    }));
    let Err(Error::Case(fault)) = System::new(&parse(&case)) else {
        panic!()
    };
    assert_eq!(fault.violations[0].pointer, "/effects/transverse_motion");
    assert!(fault.violations[0].what.contains("/surroundings"));
    let case = beam(&json!({"surroundings": {"density_kg_m3": 1000}, "effects": {"axial_inertia": "off"}}));
    let Err(Error::Case(fault)) = System::new(&parse(&case)) else {
        panic!()
    };
    assert_eq!(fault.violations[0].pointer, "/effects/axial_inertia");
}

/// Goal: what the program chooses for a beam in water, left to itself, is what the whole model says, to the accuracy asked for.
#[test]
fn what_is_chosen_in_water_is_close_to_everything() {
    let mut case = beam(&json!({
        "surroundings": {"density_kg_m3": 1000, "drag_coefficient": 2},
        "ends": {"root": {"clamped": {"u1_m": {"sine": {"amplitude": 5e-3, "frequency_hz": 2, "ramp_cycles": 1}}}}, "tip": "free"},
        "time": {"end_s": 1.0, "output_interval_s": 0.02}
    }));
    let swing = |case: &Value| finished(case).0.column("tip_u1").unwrap();
    let chosen = swing(&case);
    case["effects"] = json!("full");
    let full = swing(&case);
    let size = full.iter().map(|u| u.abs()).fold(0.0, f64::max);
    let off = chosen.iter().zip(&full).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("largest difference {:.1e} of {size:.2e} m", off / size);
    assert!(size > 3e-3 && off < 1e-2 * size);
}
