//! The solid that relaxes: Prony series and loss factors, [E57] [E58].

#[path = "../common/balances.rs"]
mod balances;
mod branches;
#[path = "../common/chance.rs"]
mod chance;
#[path = "../differences/mod.rs"]
mod differences;
#[path = "../common/kinematics.rs"]
mod kinematics;
mod modes;
#[path = "../common/scene.rs"]
mod scene;

use balances::close;
use differences::worst_difference;
use kinematics::reduced;
use scene::{finished, parse};
use serde_json::{Value, json};
use slcbeam::dae::{BeamDae, Dae};
use slcbeam::discrete::System;

/// `EI` and `EA` of the strip in the long term.
const EI: f64 = 1e6 * 0.02 * 0.004 * 0.004 * 0.004 / 12.0;
const EA: f64 = 1e6 * 0.02 * 0.004;
const BRANCHES: [[f64; 2]; 2] = [[0.8, 0.05], [0.4, 0.4]];

fn prony(branches: &[[f64; 2]]) -> Value {
    let one = |b: &[f64; 2]| json!({"modulus_ratio": b[0], "time_s": b[1]});
    json!({"prony": branches.iter().map(one).collect::<Vec<_>>()})
}

/// A strip 0.1 m long that relaxes, with changes.
fn strip(viscoelasticity: Value, sets: Value) -> Value {
    let mut case = json!({
        "name": "strip",
        "beam": {"length_m": 0.1, "height_m": 0.004, "width_m": 0.02, "young_modulus_pa": 1e6, "density_kg_m3": 1000,
                 "viscoelasticity": viscoelasticity},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 10, "cells_per_segment": 1},
        "time": {"end_s": 1.0, "output_interval_s": 0.02},
        "solver": {"rtol": 1e-9}
    });
    if case["beam"]["viscoelasticity"].is_null() {
        case["beam"].as_object_mut().unwrap().remove("viscoelasticity");
    }
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

/// Source: `E(t) = E (1 + Σ g e^(-t/τ))` of a generalised Maxwell solid, strained evenly for a time d: `Σ g e^(-t/τ) (e^(d/τ) - 1) τ/d` is left.
/// Goal: the moment of a beam that is bent, and the normal force of one that is stretched, fall so to 1e-6.
#[test]
fn held_strains_relax_exactly() {
    let d = 0.05;
    let left = |g: f64, tau: f64, t: f64| g * (-t / tau).exp() * (d / tau).exp_m1() * tau / d;
    let relaxed = |t: f64| BRANCHES.iter().map(|[g, tau]| left(*g, *tau, t)).sum::<f64>() + 1.0;
    let step = |to: f64| json!({"ramp": {"to": to, "start_s": 0.1, "duration_s": d, "shape": "linear"}});
    let held = json!({"solid_inertia": "off"});
    let (angle, stretch) = (0.3, 0.01);
    let bent =
        json!({"root": "clamped", "tip": {"conditions": {"force_x_n": 0, "force_z_n": 0, "slope_rad": step(-angle)}}});
    let pulled = json!({"root": "clamped", "tip": {"conditions": {"force_x_n": 0, "u3_m": step(stretch * 0.1), "moment_n_m": 0}}});
    for (ends, column, size) in [
        (bent, "middle_moment", EI * angle / 0.1),
        (pulled, "middle_normal_force", EA * stretch),
    ] {
        let (memory, _) = finished(&strip(
            prony(&BRANCHES),
            json!({"ends": ends, "effects": held, "probes": [{"name": "middle", "at": 0.5}]}),
        ));
        let (times, found) = (memory.column("t").unwrap(), memory.column(column).unwrap());
        for (t, found) in times.into_iter().zip(found).filter(|(t, _)| *t > 0.1501) {
            let exact = size * relaxed(t - 0.1);
            assert!(
                (found.abs() / exact - 1.0).abs() < 1e-6,
                "{column} at {t}: {found} {exact}"
            );
        }
    }
}

/// Source: the rates `κ_k' = (κ - κ_k)/τ_k` with `(1 + Σ g) κ = M/EI + Σ g_k κ_k` integrated by themselves. Goal: a beam under a sudden end
/// moment creeps so, to 1e-6, its end nodes too.
#[test]
fn a_given_moment_creeps_exactly() {
    let moment = 8e-6;
    let ends = json!({"root": "clamped", "tip": {"free": {
        "moment_n_m": {"ramp": {"to": moment, "start_s": 0.1, "duration_s": 0}}}}});
    let (memory, summary) = finished(&strip(
        prony(&BRANCHES),
        json!({"ends": ends, "effects": {"solid_inertia": "off"}}),
    ));
    let (times, angles) = (memory.column("t").unwrap(), memory.column("tip_angle").unwrap());
    let (mut kept, mut at) = ([0.0; 2], 0.1);
    let curvature = |kept: &[f64; 2]| {
        let sums = BRANCHES
            .iter()
            .zip(kept)
            .fold((1.0, moment / EI), |(s, m), ([g, _], k)| (s + g, m + g * k));
        sums.1 / sums.0
    };
    let rates = |kept: [f64; 2]| {
        let now = curvature(&kept);
        [(now - kept[0]) / BRANCHES[0][1], (now - kept[1]) / BRANCHES[1][1]]
    };
    for (t, found) in times.into_iter().zip(angles).filter(|(t, _)| *t > 0.1001) {
        let steps = 200;
        let h = (t - at) / f64::from(steps);
        let moved = |from: [f64; 2], rate: [f64; 2], h: f64| [from[0] + h * rate[0], from[1] + h * rate[1]];
        for _ in 0..steps {
            let a = rates(kept);
            let b = rates(moved(kept, a, 0.5 * h));
            let c = rates(moved(kept, b, 0.5 * h));
            let d = rates(moved(kept, c, h));
            kept = [0, 1].map(|k| kept[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
        }
        at = t;
        let exact = 0.1 * curvature(&kept);
        assert!((found.abs() / exact - 1.0).abs() < 1e-6, "{t}: {found} {exact}");
    }
    println!("{:e}", summary.balances.energy_residual_relative);
    assert!(summary.balances.energy_residual_relative.abs() < 1e-6);
}

/// Goal: as τ goes to zero with g τ fixed the solid is Kelvin and Voigt's, with order one.
#[test]
fn fast_branches_are_kelvin_and_voigts() {
    let kick = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.3]}}});
    let sets = json!({"start": kick, "time": {"end_s": 0.5, "output_interval_s": 0.01}, "solver": {"rtol": 1e-10}});
    let tip = |case: &Value| finished(case).0.column("tip_u1").unwrap();
    let mut damped = strip(Value::Null, sets.clone());
    damped["beam"]["damping"] = json!({"axial_time_s": 2e-3, "bending_time_s": 2e-3});
    let exact = tip(&damped);
    let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let error = |tau: f64| {
        let found = tip(&strip(prony(&[[2e-3 / tau, tau]]), sets.clone()));
        let off = found.iter().zip(&exact).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max) / size
    };
    let (slow, fast) = (error(2e-5), error(5e-6));
    println!("{slow:.1e} {fast:.1e}");
    assert!(fast < 3e-3 && (3.2..4.8).contains(&(slow / fast)), "{slow:e} {fast:e}");
}

/// Goal: energy and momentum close in every kinematics, dry and wet, driven, thrown, turned by an end moment, at rest.
#[test]
fn balances_close() {
    let driven = json!({"root": {"clamped": {"u1_m": {"sine": {"amplitude": 5e-3, "frequency_hz": 6, "ramp_cycles": 1}}}},
        "tip": {"free": {"force_z_n": 0.01, "moment_n_m": {"sine": {"amplitude": 2e-4, "frequency_hz": 3}}}}});
    let held = json!({"root": {"clamped": {"slope_rad": {"ramp": {"to": 0.3, "start_s": 0.2, "duration_s": 0.01}}}}, "tip": "clamped"});
    let thrown = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0.2, 0.5, -1.0]}}});
    let mut cases = reduced(&driven);
    cases.extend([
        (
            "bar",
            json!({"ends": {"root": "clamped", "tip": {"free": {"force_z_n": {"sine": {"amplitude": 1, "frequency_hz": 9}}}}},
                       "effects": {"transverse_motion": "off"}}),
        ),
        ("at rest", json!({"ends": driven, "effects": {"solid_inertia": "off"}})),
        ("turned", json!({"ends": held, "effects": {"solid_inertia": "off"}})),
        (
            "thrown",
            json!({"ends": {"root": "free", "tip": "free"}, "start": thrown}),
        ),
    ]);
    for (what, sets) in cases {
        let (_, summary) = finished(&strip(prony(&BRANCHES), sets));
        close(what, &summary, 1e-6);
    }
    for (what, sets) in [
        ("wet", json!({})),
        ("wet, published", json!({"formulation": "published", "bladders": {}})),
        ("wet, small", json!({"effects": {"finite_rotation": "off"}})),
        ("wet, at rest", json!({"effects": {"solid_inertia": "off"}})),
    ] {
        let mut case = json!({
            "name": "wet", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
            "beam": {"viscoelasticity": prony(&[[0.5, 0.01], [0.5, 0.1]])},
            "network": {"chains": [{"bladders": [1, 2, 3, 4, 5]}, {"bladders": [-1, -2, -3, -4], "ends": [{"pressure_pa": {"ramp": {"to": 2e4, "duration_s": 0.02}}}, "sealed"]}]},
            "ends": {"root": "clamped", "tip": {"free": {"moment_n_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 10}}}}},
            "effects": {"tube_inertia": "off", "tube_losses": "off"},
            "start": {"pressures": [{"bladders": [10], "pressure_pa": 1e4}]},
            "time": {"end_s": 0.1, "output_interval_s": 0.002},
            "solver": {"rtol": 1e-9}
        });
        for (key, value) in sets.as_object().unwrap() {
            case[key] = value.clone();
        }
        let (_, summary) = finished(&case);
        close(what, &summary, 1e-6);
    }
}

/// All effects of a dry beam but these.
fn effects(off: &[&str]) -> Value {
    let all = [
        "transverse_motion",
        "finite_rotation",
        "axial_force_on_bending",
        "axial_stretch",
        "solid_inertia",
        "axial_inertia",
        "rotary_inertia",
    ];
    let choices = all.map(|name| (name.to_string(), json!(if off.contains(&name) { "off" } else { "on" })));
    json!({"effects": choices.into_iter().collect::<serde_json::Map<_, _>>()})
}

/// Goal: a branch brings a curvature a node and a stretch a cell, no more; the Jacobian is that of the residual.
#[test]
fn unknowns_and_their_jacobian() {
    let turned = json!({"root": {"clamped": {"slope_rad": {"sine": {"amplitude": 0.1, "frequency_hz": 5}}}}, "tip": {"free": {"moment_n_m": 1e-4}}});
    for (sets, stretches) in [
        (json!({"ends": turned}), true),
        (json!({"ends": turned, "formulation": "published"}), true),
        (effects(&["finite_rotation"]), true),
        (effects(&["finite_rotation", "axial_stretch", "axial_inertia"]), false),
        (effects(&["solid_inertia", "axial_inertia", "rotary_inertia"]), true),
    ] {
        let of = |viscoelasticity| BeamDae::new(System::new(&parse(&strip(viscoelasticity, sets.clone()))).unwrap());
        let mut dae = of(prony(&BRANCHES));
        let places = 11 + if stretches { 10 } else { 0 };
        assert_eq!(dae.len(), of(Value::Null).len() + 2 * places, "{sets}");
        for (seed, size) in [(1, 0.3), (2, 0.1)] {
            let worst = worst_difference(&mut dae, seed, size);
            assert!(worst < 1e-6, "{sets} {worst:e}");
        }
    }
}

/// Goal: what is held in equilibrium at the start has relaxed, and stays where it is.
#[test]
fn an_equilibrium_has_relaxed() {
    for (formulation, moment) in [("conservative", 2e-4), ("published", 2e-4), ("conservative", 0.0)] {
        let (memory, _) = finished(&strip(
            prony(&BRANCHES),
            json!({"loads": [{"gravity": {"x_m_s2": -3}}], "formulation": formulation,
                "ends": {"root": "clamped", "tip": {"free": {"moment_n_m": moment}}},
                "start": {"equilibrium": {"loads_at_s": 0}}}),
        ));
        let tip = memory.column("tip_u1").unwrap();
        assert!(tip[0].abs() > 1e-3);
        assert!(tip.iter().all(|u| (u / tip[0] - 1.0).abs() < 1e-6), "{tip:?}");
    }
}
