//! What holds the beam: columns `reaction_...` and `turned_...` of histories and equilibria.
//!
//! Sources: statics (Newton's laws; Timoshenko & Gere, Mechanics of Materials, tables of beams), and the balance of energy.

use std::f64::consts::TAU;
use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

/// EI = 1 N m², EA = 1e4 N, m = 1 kg/m, l = 1 m.
fn beam(root: Value, tip: Value, more: &Value) -> Case {
    let height = (12.0e-4_f64).sqrt();
    let mut case = json!({
        "name": "held",
        "beam": {"length_m": 1.0, "height_m": height, "width_m": 1.0, "young_modulus_pa": 1e4 / height, "density_kg_m3": 1.0 / height},
        "ends": {"root": root, "tip": tip},
        "formulation": "conservative",
        "effects": "full",
        "mesh": {"segments": 16, "cells_per_segment": 2},
        "time": {"end_s": 1.0}
    });
    for (key, value) in more.as_object().unwrap() {
        case[key] = value.clone();
    }
    case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// Reads a quantity of the equilibrium under the loads at 0 s.
fn at_rest(case: &Case) -> impl Fn(&str) -> f64 + use<> {
    let path = follow(case, &EquilibriumOptions::at(0.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none());
    let row = path.last().row.clone();
    let names: Vec<String> = columns(&system(case, 0.0).unwrap())
        .into_iter()
        .map(|c| c.name)
        .collect();
    move |name| {
        row[names
            .iter()
            .position(|n| n == name)
            .unwrap_or_else(|| panic!("{name} of {names:?}"))]
    }
}

/// Goal: a cantilever that is bent far holds its root with the tip's force and its moment about the root, to what Newton's iteration leaves.
#[test]
fn a_root_holds_what_pulls_at_the_tip() {
    let tip = json!({"free": {"force_x_n": 2.0, "force_z_n": -1.0}});
    let read = at_rest(&beam(json!("clamped"), tip, &json!({})));
    let (x, z) = (read("tip_u1"), 1.0 + read("tip_u3"));
    assert!(x > 0.5, "{x}");
    assert!((read("reaction_root_x") + 2.0).abs() < 1e-9);
    assert!((read("reaction_root_z") - 1.0).abs() < 1e-9);
    let about = z * 2.0 + x;
    assert!(
        (read("reaction_root_couple") + about).abs() < 1e-8,
        "{} {about}",
        read("reaction_root_couple")
    );
}

/// Goal: under an even load clamped ends hold `q l/2` and `q l²/12`, pinned ones `q l/2` and turn by `q l³/(24 EI)`; a prop at the tip of a
/// cantilever `3 q l/8`. The mesh is off by 1e-3 of couples and angles, forces are exact.
#[test]
fn supports_hold_what_the_tables_say() {
    let load = json!({"loads": [{"force_x_n_m": {"signal": 1e-3}}]});
    let read = at_rest(&beam(json!("clamped"), json!("clamped"), &load));
    for end in ["root", "tip"] {
        assert!((read(&format!("reaction_{end}_x")) + 0.5e-3).abs() < 1e-10);
    }
    let couples = ["root", "tip"].map(|end| read(&format!("reaction_{end}_couple")));
    assert!((couples[0] + 1e-3 / 12.0).abs() < 2e-3 * 1e-3 / 12.0, "{couples:?}");
    assert!((couples[0] + couples[1]).abs() < 1e-9 * couples[0].abs(), "{couples:?}");
    let read = at_rest(&beam(json!("pinned"), json!("pinned"), &load));
    assert!((read("reaction_tip_x") + 0.5e-3).abs() < 1e-10);
    assert!(
        (read("turned_root") / (1e-3 / 24.0) - 1.0).abs() < 2e-3,
        "{}",
        read("turned_root")
    );
    let mut prop = load.clone();
    prop["attachments"] = json!([{"at": 1.0, "stiffness_x_n_m": 1e7}]);
    let read = at_rest(&beam(json!("clamped"), json!("free"), &prop));
    let held = read("reaction_attachment_1_x");
    assert!((held / -0.375e-3 - 1.0).abs() < 2e-3, "{held}");
    assert!((held + read("reaction_root_x") + 1e-3).abs() < 1e-9);
}

/// Goal: reduced models hold their ends with the same forces: columns are the same, and what pulls is held.
#[test]
fn reduced_models_hold_as_much() {
    for effects in [
        json!("full"),
        json!({"finite_rotation": "off"}),
        json!({"finite_rotation": "off", "axial_stretch": "off"}),
    ] {
        let tip = json!({"free": {"force_x_n": 2e-3, "force_z_n": -0.1}});
        let read = at_rest(&beam(json!("clamped"), tip, &json!({"effects": effects})));
        assert!((read("reaction_root_x") + 2e-3).abs() < 1e-11, "{effects}");
        assert!(
            (read("reaction_root_z") - 0.1).abs() < 1e-9,
            "{effects}: {}",
            read("reaction_root_z")
        );
        assert!(read("reaction_root_couple") < -2e-3, "{effects}");
    }
    let tip = json!({"free": {"force_z_n": -0.1}});
    let bar = json!({"effects": {"transverse_motion": "off"}});
    let read = at_rest(&beam(json!("clamped"), tip, &bar));
    assert!((read("reaction_root_z") - 0.1).abs() < 1e-9);
    assert!(read("reaction_root_x") == 0.0 && read("reaction_root_couple") == 0.0);
}

/// Goal: the reaction of a shaken root is the force that does its work: `∫ R v dt = W`, to the trapezoid rule over outputs.
#[test]
fn a_shaken_root_works_by_its_reaction() {
    let root = json!({"clamped": {"u1_m": {"sine": {"amplitude": 0.01, "frequency_hz": 2, "ramp_cycles": 1}}}});
    let time = json!({"time": {"end_s": 2.0, "output_interval_s": 5e-4}, "solver": {"rtol": 1e-7}});
    let mut memory = Memory::default();
    let summary = dynamics::run(&beam(root, json!("free"), &time), &mut memory)
        .unwrap()
        .summary;
    assert_eq!(summary.status, Status::Finished);
    let column = |name: &str| memory.column(name).unwrap();
    let (t, force, work) = (column("t"), column("reaction_root_x"), column("work_ends"));
    let velocity = |t: f64| {
        let x = (2.0 * t).min(1.0);
        let (envelope, rate) = (
            x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x),
            60.0 * x * x * (1.0 - x).powi(2),
        );
        let angle = TAU * 2.0 * t;
        0.01 * (envelope * TAU * 2.0 * angle.cos() + rate * angle.sin())
    };
    let mut done = 0.0;
    let mut worst = 0.0_f64;
    let size = work.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    for k in 1..t.len() {
        done += 0.5 * (t[k] - t[k - 1]) * (force[k] * velocity(t[k]) + force[k - 1] * velocity(t[k - 1]));
        worst = worst.max((done - work[k]).abs() / size);
    }
    println!("{worst:e} of {size:e}");
    assert!(worst < 1e-3, "{worst:e}");
}
