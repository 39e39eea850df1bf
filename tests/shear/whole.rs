//! What the equations do together: derivatives, balances, limits, what is told.

use serde_json::{Value, json};
use slcbeam::case::schema::Effect;
use slcbeam::dae::{BeamDae, Dae as _};
use slcbeam::discrete::System;
use slcbeam::error::Error;

use super::balances::close;
use super::differences::worst_difference;
use super::scene::{finished, parse};
use super::{EI, KGA, L, block};

/// Every way in which a beam may move.
fn kinds() -> Vec<Value> {
    let without = |off: &[&str]| {
        let off = off.iter().map(|effect| ((*effect).to_string(), json!("off")));
        let mut effects: serde_json::Map<_, _> = off.collect();
        effects.insert("shear".into(), json!("on"));
        Value::Object(effects)
    };
    vec![
        json!("full"),
        without(&["rotary_inertia"]),
        without(&["axial_inertia"]),
        without(&["solid_inertia"]),
        without(&["finite_rotation"]),
        without(&["finite_rotation", "rotary_inertia"]),
        without(&["finite_rotation", "axial_force_on_bending"]),
        without(&["finite_rotation", "axial_stretch"]),
    ]
}

/// What turns and loads a beam in every way, with or without damping, relaxation, water around it.
fn laden(effects: &Value, full: bool) -> Value {
    let sine = |amplitude: f64, frequency: f64| json!({"sine": {"amplitude": amplitude, "frequency_hz": frequency, "ramp_cycles": 1}});
    let mut case = block(
        KGA,
        &json!({
            "effects": effects,
            "ends": {"root": {"clamped": {"slope_rad": sine(0.2, 9.0), "u1_m": sine(2e-3, 7.0)}},
                     "tip": {"free": {"follower_shear_n": sine(3.0, 6.0), "moment_n_m": sine(0.1, 5.0), "force_x_n": sine(4.0, 8.0)}}},
            "loads": [
                {"moment_z_n": {"signal": sine(3.0, 9.0)}}, {"moment_x_n": {"signal": sine(2.0, 5.0)}},
                {"force_x_n_m": {"signal": sine(40.0, 6.0)}}
            ],
            "attachments": [{"at": 0.62, "stiffness_rotation_n_m_rad": 2.0, "mass_kg": 0.01, "stiffness_x_n_m": 20}],
            "time": {"end_s": 0.15, "output_interval_s": 0.005}
        }),
    );
    if full {
        case["beam"]["damping"] = json!({"bending_time_s": 2e-3, "axial_time_s": 1e-3, "drag_n_s_m2": 2.0});
        case["beam"]["viscoelasticity"] = json!({"prony": [{"modulus_ratio": 0.5, "time_s": 0.02}]});
    }
    case
}

/// Goal: the Jacobian is that of the residual, and a cell brings an angle, with rotary inertia its rate too, in every kinematics.
#[test]
fn unknowns_and_their_jacobian() {
    for effects in kinds() {
        for full in [false, true] {
            let case = laden(&effects, full);
            let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
            let mut without = case.clone();
            without["beam"]
                .as_object_mut()
                .unwrap()
                .shift_remove("shear_stiffness_n");
            if let Some(effects) = without["effects"].as_object_mut() {
                effects.shift_remove("shear");
            }
            let other = System::new(&parse(&without)).unwrap().layout.len;
            let swings = dae.system().model.effects.has(Effect::RotaryInertia);
            let brings = 1 + usize::from(swings) + usize::from(full);
            assert_eq!(dae.len(), other + 10 * brings, "{effects}");
            for (seed, size) in [(1, 0.3), (2, 0.1)] {
                let worst = worst_difference(&mut dae, seed, size);
                assert!(worst < 1e-6, "{effects} {full}: {worst:e}");
            }
        }
    }
}

/// What fourth order goes with, of [`laden`].
fn laden_of_fourth_order(effects: &Value, full: bool) -> Value {
    let mut case = laden(effects, full);
    let own = case.as_object_mut().unwrap();
    own.shift_remove("attachments");
    own["mesh"]["order"] = json!(4);
    own["beam"].as_object_mut().unwrap().shift_remove("viscoelasticity");
    case
}

/// Goal: the Jacobian is that of the residual on meshes of fourth order, in every kinematics, with and without damping.
#[test]
fn the_jacobian_of_fourth_order() {
    for effects in kinds() {
        for full in [false, true] {
            let mut dae = BeamDae::new(System::new(&parse(&laden_of_fourth_order(&effects, full))).unwrap());
            assert!(dae.system().mesh.fourth);
            for (seed, size) in [(1, 0.3), (2, 0.1)] {
                let worst = worst_difference(&mut dae, seed, size);
                assert!(worst < 1e-6, "{effects} {full}: {worst:e}");
            }
        }
    }
}

/// Goal: the same with fluid, whose pressures bend what is damped, of both orders.
#[test]
fn the_jacobian_with_fluid() {
    let ends = json!(["connected", "sealed"]);
    let turbine = json!({"from": {"bladder": 1, "end": "inlet"}, "to": {"bladder": -1, "end": "inlet"}, "conductance": {"m3_s_pa": 5e-10}});
    let mut case = json!({
        "name": "shaken", "preset": "matia-gat-beam", "fluid": {"viscosity_pa_s": 0.05},
        "beam": {"shear_stiffness_n": 91.2, "damping": {"bending_time_s": 2e-3, "axial_time_s": 2e-3}},
        "network": {"chains": [{"bladders": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "ends": ends},
                               {"bladders": [-1, -2, -3, -4, -5, -6, -7, -8, -9, -10], "ends": ends}], "turbines": [turbine]},
        "ends": {"root": {"clamped": {"u1_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 11}}}}, "tip": "free"},
        "time": {"end_s": 1}
    });
    for order in [2, 4] {
        case["mesh"] = json!({"cells_per_segment": order / 2, "order": order});
        for seed in 1..=4 {
            let mut dae = BeamDae::new(System::new(&parse(&case)).unwrap());
            let worst = worst_difference(&mut dae, seed, 0.3);
            assert!(worst < 1e-6, "{order}: {worst:e}");
        }
    }
}

/// Goal: energy, momentum and angular momentum close with everything at once that turns sections, to 1e-6, of both orders.
#[test]
fn balances_close() {
    for effects in kinds() {
        for full in [false, true] {
            if !full && effects != json!("full") {
                continue;
            }
            let (_, summary) = finished(&laden(&effects, full));
            close(&format!("{effects} {full}"), &summary, 1e-6);
            let (_, summary) = finished(&laden_of_fourth_order(&effects, full));
            close(&format!("{effects} {full}, of fourth order"), &summary, 1e-6);
        }
    }
}

/// Goal: what shear changes goes to zero with 1/kGA, in a beam without inertia that is pushed and turned far.
#[test]
fn it_vanishes_as_sections_get_stiff() {
    for effects in [
        json!({"solid_inertia": "off"}),
        json!({"solid_inertia": "off", "finite_rotation": "off"}),
    ] {
        let tip = |shear: Option<f64>| {
            let force = json!({"ramp": {"to": EI / (L * L), "duration_s": 0.1}});
            let mut sets = json!({"effects": effects, "ends": {"root": "clamped", "tip": {"free": {"force_x_n": force, "force_z_n": -10}}}});
            sets["effects"]["shear"] = json!(if shear.is_some() { "on" } else { "auto" });
            finished(&block(shear, &sets)).0.column("tip_u1").unwrap()
        };
        let rigid = tip(None);
        let off = |shear: f64| -> f64 {
            let all = tip(Some(shear)).into_iter().zip(&rigid);
            all.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let errors = [off(100.0 * KGA), off(200.0 * KGA), off(400.0 * KGA)];
        println!("{errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((order - 1.0).abs() < 0.02, "{errors:?}");
        }
    }
}

/// Source: moduli that relax alike make everything creep alike. Goal: under a sudden force the tip of a beam without inertia creeps as one
/// that does not shear, larger by `3 EI/(kGA l²)`, to 1e-6.
#[test]
fn it_relaxes_with_the_rest() {
    let tip = |shear: Option<f64>| {
        let force = json!({"ramp": {"to": 1e-3, "start_s": 0.05, "duration_s": 0}});
        let mut case = block(
            shear,
            &json!({"ends": {"root": "clamped", "tip": {"free": {"force_x_n": force}}}, "effects": {"solid_inertia": "off"},
                "mesh": {"segments": 40, "cells_per_segment": 1}}),
        );
        case["beam"]["viscoelasticity"] = json!({"prony": [{"modulus_ratio": 0.8, "time_s": 0.03}]});
        if shear.is_some() {
            case["effects"]["shear"] = json!("on");
        }
        finished(&case).0.column("tip_u1").unwrap()
    };
    let (with, without) = (tip(Some(KGA)), tip(None));
    let last = with.len() - 1;
    assert!(with[26] > 0.0 && with[last] > 1.7 * with[26]);
    let more = with[last] / without[last];
    // of 40 cells
    assert!((more - 1.0 - 3.0 * EI / (KGA * L * L)).abs() < 4e-4, "{more}");
    for (with, without) in with.iter().zip(&without).skip(26) {
        assert!((with / without / more - 1.0).abs() < 1e-6, "{with} {without}");
    }
}

/// Goal: sections of a beam that is let go bent do not begin to swing by themselves: what rotary inertia stores stays small, and few steps do.
#[test]
fn a_start_sets_no_sections_free() {
    let (memory, summary) = finished(&block(
        KGA,
        &json!({"start": {"u1_m": {"polynomial": {"coefficients": [0, 0, 0.0012, -0.0008, 0.0002]}}}, "solver": {"rtol": 1e-6}}),
    ));
    let (rotary, bending) = (
        memory.column("rotary_energy").unwrap(),
        memory.column("bending_energy").unwrap(),
    );
    let most = |all: &[f64]| all.iter().fold(0.0_f64, |most, one| most.max(*one));
    println!("{} {} {}", most(&rotary), most(&bending), summary.solver.steps);
    assert!(most(&rotary) < 0.1 * most(&bending));
}

/// Goal: the program leaves shear out of a slender beam and keeps it in a short one, and says why; what cannot be is refused by name.
#[test]
fn it_is_chosen_and_refused() {
    let decided = |height: f64, effects: Value| {
        let load = json!({"ramp": {"to": 1e-3, "duration_s": 10}});
        let ends = json!({"root": "clamped", "tip": {"free": {"force_x_n": load}}});
        let mut case = block(
            2.5e7 * height,
            &json!({"ends": ends, "effects": effects, "time": {"end_s": 20}}),
        );
        case["beam"]["height_m"] = json!(height);
        case["beam"]["young_modulus_pa"] = json!(2e9);
        let system = System::new(&parse(&case)).unwrap();
        let decision = system.model.effects.decision(Effect::Shear);
        (decision.on, decision.cause.to_string())
    };
    let short = decided(0.04, json!("auto"));
    let slender = decided(5e-4, json!("auto"));
    println!("{short:?}\n{slender:?}");
    assert!(short.0 && !slender.0);
    assert!(!decided(0.04, json!({"shear": "off"})).0);
    let told = |error: Error| match error {
        Error::Case(fault) => fault
            .violations
            .iter()
            .map(|v| format!("{}: {}", v.pointer, v.what))
            .collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let bent = json!({"u1_m": {"polynomial": {"coefficients": [0, 0, 0.01]}}});
    let mut published = block(
        KGA,
        &json!({"formulation": "published", "effects": {"shear": "on"}, "start": bent}),
    );
    let refused = System::new(&parse(&published)).map(|_| ()).map_err(told).unwrap_err();
    assert_eq!(
        refused,
        ["/effects/shear: shear is on, but the published form has no shear"]
    );
    published["effects"] = json!("full");
    assert!(
        !System::new(&parse(&published))
            .unwrap()
            .model
            .effects
            .has(Effect::Shear)
    );
    let rigid = block(None, &json!({"effects": {"shear": "on"}, "start": bent}));
    let refused = System::new(&parse(&rigid)).map(|_| ()).map_err(told).unwrap_err();
    assert_eq!(
        refused,
        ["/effects/shear: shear is on, but no shear_stiffness_n is given"]
    );
}

/// Goal: a start that stretches the line far more than it shears, so that its normal forces exceed kGA, begins with sections across the line
/// and keeps its energy.
#[test]
fn a_stretched_start_keeps_its_sections() {
    let mut case = block(
        50.0,
        &json!({"start": {"u1_m": {"polynomial": {"coefficients": [0, 0, 0.05]}}}, "time": {"end_s": 2e-4, "output_interval_s": 1e-4}}),
    );
    for (key, value) in [
        ("length_m", 1.0),
        ("height_m", 0.01),
        ("width_m", 0.01),
        ("young_modulus_pa", 1.2e9),
    ] {
        case["beam"][key] = json!(value);
    }
    case["solver"]["rtol"] = json!(1e-7);
    let (memory, summary) = finished(&case);
    // sections across the line are bent by u1'' = 0.1/m
    let bending = 0.5 * 1.0 * 0.1_f64.powi(2);
    let first = memory.column("bending_energy").unwrap()[0];
    assert!((first / bending - 1.0).abs() < 0.1, "{first} {bending}");
    close("a stretched start", &summary, 1e-4);
}
