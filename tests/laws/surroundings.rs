//! A fluid around the beam: added mass, drag, stream, buoyancy, [E47] [E53].

use crate::balances::close;
use crate::kinematics::reduced;
use crate::scene::{finished, parse};
use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::Control;

/// A silicone strip 0.1 m long, 5 mm high, 50 mm wide, with changes.
fn strip(sets: Value) -> Value {
    let mut case = json!({
        "name": "strip",
        "beam": {"length_m": 0.1, "height_m": 0.005, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 1100},
        "surroundings": {"density_kg_m3": 1000, "drag_coefficient": 2.0},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 12, "cells_per_segment": 1},
        "time": {"end_s": 0.2, "output_interval_s": 0.002},
        "solver": {"rtol": 1e-9, "max_order": 5}
    });
    for (key, value) in sets.as_object().unwrap() {
        match value {
            Value::Null => case.as_object_mut().unwrap().remove(key),
            value => case.as_object_mut().unwrap().insert(key.clone(), value.clone()),
        };
    }
    case
}

/// Source: inertia across grows from m to m + m_a, `m_a = π ρ w²/4` of a blade. Goal: every bending frequency falls by √(1 + m_a/m) exactly, those
/// along stay.
#[test]
fn frequencies_fall_with_the_added_mass() {
    let frequencies = |surroundings: Value| -> Vec<[f64; 2]> {
        let case = parse(&strip(
            json!({"surroundings": surroundings, "effects": {"rotary_inertia": "off"}}),
        ));
        let plan = ModeOptions {
            count: 9,
            near_hz: 0.0,
            limits: false,
        };
        let found = modes::modes(&case, &plan).unwrap();
        found.modes.iter().map(|m| [m.s.im, m.shape.transverse()]).collect()
    };
    let (wet, dry) = (frequencies(json!({"density_kg_m3": 1000})), frequencies(Value::Null));
    let ratio = 0.25 * std::f64::consts::PI * 1000.0 * 0.05 * 0.05 / (1100.0 * 0.05 * 0.005);
    let of = |all: &[[f64; 2]], across: bool| -> Vec<f64> {
        all.iter().filter(|m| (m[1] > 0.5) == across).map(|m| m[0]).collect()
    };
    let (across, along) = ((of(&wet, true), of(&dry, true)), (of(&wet, false), of(&dry, false)));
    assert!(across.1.len() > 4 && !along.1.is_empty() && !along.0.is_empty());
    for (wet, dry) in across.0.iter().zip(&across.1) {
        assert!((dry / wet / (1.0 + ratio).sqrt() - 1.0).abs() < 1e-8, "{dry} {wet}");
    }
    assert!((along.0[0] / along.1[0] - 1.0).abs() < 1e-9);
}

/// Source: `(m + m_a) v' = (m - ρ A) g - c v²`, from rest `x = (M/c) ln cosh(√(W c) t/M)`. Goal: a free strip falls flat through water so, to
/// 1e-6.
#[test]
fn a_strip_falls_through_water() {
    let (memory, _) = finished(&strip(json!({
        "ends": {"root": "free", "tip": "free"}, "loads": [{"gravity": {"x_m_s2": -9.81}}],
        "time": {"end_s": 2.0, "output_interval_s": 0.02}
    })));
    let (m, displaced) = (1100.0 * 0.05 * 0.005, 1000.0 * 0.05 * 0.005);
    let mass = m + 0.25 * std::f64::consts::PI * 1000.0 * 0.05 * 0.05;
    let (weight, drag) = ((m - displaced) * 9.81, 0.5 * 2.0 * 1000.0 * 0.05);
    let (times, fallen) = (memory.column("t").unwrap(), memory.column("tip_u1").unwrap());
    let size = mass / drag * ((weight * drag).sqrt() * 2.0 / mass).cosh().ln();
    for (t, x) in times.into_iter().zip(fallen) {
        let exact = -mass / drag * ((weight * drag).sqrt() * t / mass).cosh().ln();
        assert!((x - exact).abs() < 1e-6 * size, "t = {t}: {x} {exact}");
    }
}

/// Source: `u = q l⁴/8EI`, `q = C_d ρ w U²/2` of a slow stream across, and buoyancy of a strip as heavy as the water. Goal: to second order in the
/// mesh; no weight is left.
#[test]
fn a_stream_bends_and_water_carries() {
    let tip = |sets: Value| {
        let case = parse(&strip(sets));
        let path = follow(&case, &EquilibriumOptions::at(0.0), &mut |_| Control::Continue).unwrap();
        assert!(path.fault.is_none(), "{:?}", path.fault);
        let names = columns(&system(&case, 0.0).unwrap());
        path.last().row[names.iter().position(|c| c.name == "tip_u1").unwrap()]
    };
    let bent = |cells: usize| {
        let stream = json!({"density_kg_m3": 1000, "drag_coefficient": 2.0, "stream_x_m_s": 0.005});
        tip(json!({"surroundings": stream, "mesh": {"segments": cells, "cells_per_segment": 1}}))
    };
    let (q, ei) = (
        0.5 * 2.0 * 1000.0 * 0.05 * 0.005 * 0.005,
        2e6 * 0.05 * 0.005_f64.powi(3) / 12.0,
    );
    let exact = q * 0.1_f64.powi(4) / (8.0 * ei);
    let (coarse, fine) = (bent(10) / exact - 1.0, bent(30) / exact - 1.0);
    println!("{coarse:.1e} {fine:.1e}");
    assert!(
        coarse.abs() < 1e-2 && (6.0..12.0).contains(&(coarse / fine)),
        "{coarse:e} {fine:e}"
    );
    let weight = json!([{"gravity": {"x_m_s2": -9.81}}]);
    let afloat = tip(json!({"surroundings": {"density_kg_m3": 1100}, "loads": weight}));
    assert!(afloat.abs() < 1e-12, "{afloat:e}");
}

/// Goal: energy, momentum and angular momentum close in every kinematics, at rest and in a stream, driven, kicked, free.
#[test]
fn balances_close_in_water() {
    let driven = json!({"root": {"clamped": {"u1_m": {"sine": {"amplitude": 5e-3, "frequency_hz": 6, "ramp_cycles": 1}}}}, "tip": "free"});
    let kicked = json!({"root": {"clamped": {"u1_m": {"ramp": {"to": 4e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"});
    let stream = json!({"density_kg_m3": 1000, "drag_coefficient": 2.0, "stream_x_m_s": {"sine": {"amplitude": 0.3, "frequency_hz": 5}},
                        "stream_z_m_s": 0.4});
    let thrown = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0.2, 0.5, -1.0]}}});
    let mut cases = reduced(&driven);
    cases.extend([
        ("stream", json!({"ends": driven, "surroundings": stream})),
        ("kicked", json!({"ends": kicked})),
        ("kicked in a stream", json!({"ends": kicked, "surroundings": stream})),
        (
            "thrown",
            json!({"ends": {"root": "free", "tip": "free"}, "start": thrown}),
        ),
        (
            "at rest",
            json!({"surroundings": stream, "effects": {"solid_inertia": "off"}}),
        ),
    ]);
    for (what, sets) in cases {
        let mut case = strip(sets);
        case["loads"] = json!([{"gravity": {"x_m_s2": 3.0, "z_m_s2": -9.81}}]);
        let (_, summary) = finished(&case);
        close(what, &summary, 1e-6);
    }
}

/// Goal: the Jacobian is that of the residual; there are no unknowns more.
#[test]
fn unknowns_and_their_jacobian() {
    let stream = json!({"density_kg_m3": 1000, "drag_coefficient": 2.0, "stream_x_m_s": 0.3, "stream_z_m_s": 0.4});
    for surroundings in [json!({"density_kg_m3": 1000, "drag_coefficient": 1.0}), stream] {
        for effects in [json!("full"), json!({"finite_rotation": "off"})] {
            let of = |around: &Value| {
                BeamDae::new(
                    System::new(&parse(&strip(
                        json!({"surroundings": around, "effects": effects, "loads": [{"gravity": {"x_m_s2": 1.0}}]}),
                    )))
                    .unwrap(),
                )
            };
            let mut dae = of(&surroundings);
            assert_eq!(dae.len(), of(&Value::Null).len());
            for (seed, size) in [(1, 1.0), (2, 0.1)] {
                let worst = crate::differences::worst_difference(&mut dae, seed, size);
                assert!(worst < 1e-6, "{worst:e}");
            }
        }
    }
}

/// Source: a change of frame: a fin as heavy as the water it displaces, heaved by X(t) in still water, moves against its root as one that is held
/// in water that swings by -X(t). Goal: so to 1e-6, with drag and added mass; without drag it moves too.
#[test]
fn water_that_swings_moves_a_fin_as_its_heaved_root_does() {
    let (a, f) = (3e-3, 2.0);
    let omega = std::f64::consts::TAU * f;
    let heave =
        json!({"sum": [a, {"sine": {"amplitude": -a, "frequency_hz": f, "phase_rad": std::f64::consts::FRAC_PI_2}}]});
    let swing = json!({"sine": {"amplitude": -a * omega, "frequency_hz": f}});
    for drag in [2.0, 0.0] {
        let water = json!({"density_kg_m3": 1100, "drag_coefficient": drag});
        let mut swinging = water.clone();
        swinging["stream_x_m_s"] = swing.clone();
        let heaved = json!({"root": {"clamped": {"u1_m": heave}}, "tip": "free"});
        let tip = |sets: Value| {
            let memory = finished(&strip(sets)).0;
            (memory.column("t").unwrap(), memory.column("tip_u1").unwrap())
        };
        let (times, moved) = tip(json!({"surroundings": water, "ends": heaved}));
        let (_, swung) = tip(json!({"surroundings": swinging}));
        let size = swung.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        assert!(size > 1e-4, "{size:e}");
        for ((t, moved), swung) in times.iter().zip(&moved).zip(&swung) {
            let root = a * (1.0 - (omega * t).cos());
            assert!(
                (moved - root - swung).abs() < 1e-6 * size,
                "t = {t}: {} {swung}",
                moved - root
            );
        }
    }
}
