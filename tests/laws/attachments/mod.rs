//! What is attached to the beam, [E49] and [E50]: point masses, springs and dashpots to ground, forces at places; followers, [E68], bodies, [E69], [E70].
//!
//! Sources: Euler-Bernoulli's beam, whose frequency equations (Blevins 1979, Formulas for Natural Frequency and Mode Shape, chapter 8) are
//! solved here by bisection; its static deflections; conservation laws; differences.

mod followers;
mod refused;
mod solids;
mod turns;

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::modes::{self, ModeOptions};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// EI = 1 N m², m = 1 kg/m, l = 1 m, so slender that rotary inertia is 1e-8, as a linear beam.
fn slender(root: Value, tip: Value, attachments: Value, cells: usize) -> Value {
    let height = 3.5e-4_f64;
    json!({
        "name": "attached",
        "beam": {"length_m": 1.0, "height_m": height, "width_m": 1.0, "young_modulus_pa": 12.0 / height.powi(3),
                 "density_kg_m3": 1.0 / height},
        "ends": {"root": root, "tip": tip},
        "attachments": attachments,
        "formulation": "conservative",
        "effects": {"finite_rotation": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0}
    })
}

/// β of the slowest mode, `ω = β²`, with an error of fourth order in the mesh.
fn wave_number(case: &Value) -> f64 {
    let plan = ModeOptions {
        count: 2,
        near_hz: 0.0,
        limits: false,
    };
    let found = modes::modes(&parse(case), &plan).unwrap();
    let slowest = found
        .modes
        .iter()
        .filter(|mode| mode.kind.swings())
        .map(|mode| mode.s.im.abs());
    slowest.fold(f64::INFINITY, f64::min).sqrt()
}

/// From two meshes, second order.
fn extrapolated(measure: impl Fn(usize) -> f64, cells: usize) -> f64 {
    let (coarse, fine) = (measure(cells), measure(2 * cells));
    fine + (fine - coarse) / 3.0
}

fn root_between(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(f(low) * f(high) < 0.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// Compares a free beam whose root is held so, with something attached, to the exact β; two meshes leave an error of b (b h)^4.
fn swings(root: &str, attachment: &Value, exact: f64, tolerance: f64) {
    let of = |cells| wave_number(&slender(json!(root), json!("free"), json!([attachment]), cells));
    let found = extrapolated(of, 24);
    println!("{attachment}: {found} of {exact}, {:.1e}", found / exact - 1.0);
    assert!((found / exact - 1.0).abs() < tolerance);
}

/// Goal: `1 + cosh b cos b + (M/ml) b (cos b sinh b - sin b cosh b) = 0`.
#[test]
fn a_cantilever_with_a_tip_mass_swings_as_slowly_as_it_must() {
    for ratio in [0.1, 1.0, 10.0] {
        let equation = |b: f64| 1.0 + b.cosh() * b.cos() + ratio * b * (b.cos() * b.sinh() - b.sin() * b.cosh());
        let exact = root_between(equation, 0.3, 1.9);
        swings("clamped", &json!({"at": 1.0, "mass_kg": ratio}), exact, 3e-6);
    }
}

/// Goal: pinned with a rotational spring k at the root, free at the tip: `k (1 + cosh b cos b) = b (cosh b sin b - sinh b cos b)`.
#[test]
fn a_rotational_spring_at_a_pinned_root_swings_as_it_must() {
    for k in [0.1, 1.0, 100.0] {
        let equation = |b: f64| k * (1.0 + b.cosh() * b.cos()) - b * (b.cosh() * b.sin() - b.sinh() * b.cos());
        let exact = root_between(equation, 1e-3, 1.9);
        let spring = json!({"at": 0.0, "stiffness_rotation_n_m_rad": k});
        swings("pinned", &spring, exact, 1e-5);
    }
}

/// Goal: a beam pinned at both ends with a stiff spring at mid-length swings as half of it, b = 2π, to second order.
#[test]
fn a_stiff_spring_is_a_pin() {
    // between two nodes as well as at one: 25 and 24 cells
    for cells in [24, 25] {
        let of = |cells| {
            let spring = json!([{"at": 0.5, "stiffness_x_n_m": 1e9}]);
            wave_number(&slender(json!("pinned"), json!("pinned"), spring, cells))
        };
        let exact = std::f64::consts::TAU;
        let (coarse, fine) = (of(cells) / exact - 1.0, of(3 * cells) / exact - 1.0);
        println!("{cells} cells: {coarse:.1e}, thrice as many {fine:.1e}");
        assert!(coarse.abs() < 1e-2 && (5.0..13.0).contains(&(coarse / fine)));
    }
}

/// Deflection of the tip at rest.
fn tip(case: &Value) -> f64 {
    let case = parse(case);
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let names = columns(&system(&case, 1.0).unwrap());
    path.last().row[names.iter().position(|c| c.name == "tip_u1").unwrap()]
}

/// Goal: `u(l) = F a² (3 l - a)/6 EI` of a force between nodes; with a spring at b, that of the beam on one elastic support; with a rotational
/// spring inside. Order 2 in the mesh: 1/81 of the error with nine times as many cells, places between nodes.
#[test]
fn forces_and_springs_between_nodes_are_of_second_order() {
    let (f, a, b) = (1e-3, 0.4, 0.7);
    // compliance of deflection at x by a force at y, x >= y
    let far = |x: f64, y: f64| y * y * (3.0 * x - y) / 6.0;
    let (k, turning) = (20.0, 5.0);
    let supported = far(1.0, a) - far(1.0, b) * k * far(b, a) / (1.0 + k * far(b, b));
    // a couple C at b: slope C b, tip C b (l - b/2); slope at b by the force is F a²/2
    let turned = far(1.0, a) - turning * (0.5 * a * a) / (1.0 + turning * b) * b * (1.0 - 0.5 * b);
    let force = json!({"at": a, "force_x_n": f});
    let cases = [
        ("force", json!([force]), far(1.0, a)),
        ("support", json!([force, {"at": b, "stiffness_x_n_m": k}]), supported),
        (
            "turned",
            json!([force, {"at": b, "stiffness_rotation_n_m_rad": turning}]),
            turned,
        ),
    ];
    for (what, attachments, exact) in cases {
        let error = |cells| {
            let case = slender(json!("clamped"), json!("free"), attachments.clone(), cells);
            tip(&case) / (f * exact) - 1.0
        };
        let (coarse, fine) = (error(11), error(99));
        println!("{what}: {coarse:.1e}, nine times as many cells {fine:.1e}");
        assert!(coarse.abs() < 3e-2 && fine.abs() < 4e-4, "{what}");
    }
}

/// Everything at once: masses, springs, dashpots, forces, gravity, a mass on a driven root and one between nodes.
fn everything(sets: Value) -> Case {
    let mut case = json!({
        "name": "everything",
        "beam": {"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 2e6, "density_kg_m3": 950},
        "ends": {"root": {"pinned": {"u1_m": {"sine": {"amplitude": 2e-3, "frequency_hz": 12, "ramp_cycles": 1}},
                                     "u3_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 9}}}}, "tip": "free"},
        "loads": [{"gravity": {"x_m_s2": 3.0, "z_m_s2": -9.81}},
                  {"body_x_m_s2": {"signal": {"sine": {"amplitude": 5, "frequency_hz": 7}}, "profile": {"polynomial": {"coefficients": [0, 1]}}}}],
        "attachments": [
            {"at": 0.0, "mass_kg": 0.004, "stiffness_rotation_n_m_rad": 0.02},
            {"at": 0.333, "stiffness_x_n_m": 2.0, "damping_x_n_s_m": 0.02, "stiffness_rotation_n_m_rad": 0.01},
            {"at": 0.71, "mass_kg": 0.01, "rotary_inertia_kg_m2": 4e-6, "offset_across_m": 0.012, "offset_along_m": -0.007, "stiffness_z_n_m": 3.0, "damping_z_n_s_m": 0.03,
             "force_x_n": {"sine": {"amplitude": 0.05, "frequency_hz": 5}}, "force_z_n": {"sine": {"amplitude": 0.03, "frequency_hz": 8}}},
            {"at": 0.86, "force_tangential_n": {"sine": {"amplitude": 0.02, "frequency_hz": 6}}, "force_normal_n": {"sine": {"amplitude": 0.01, "frequency_hz": 4}}},
            {"at": 1.0, "mass_kg": 0.005, "rotary_inertia_kg_m2": 2e-6, "offset_along_m": 0.01, "force_tangential_n": -0.02}],
        "formulation": "conservative",
        "effects": "full",
        "mesh": {"segments": 8, "cells_per_segment": 1},
        "time": {"end_s": 0.2, "output_interval_s": 0.01},
        "solver": {"rtol": 1e-9, "max_order": 5}
    });
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    parse(&case)
}

/// Goal: energy, momentum and angular momentum close to the integrator's accuracy, in every kinematics. The published form's work is counted.
#[test]
fn balances_close_with_everything_attached() {
    let no_dashpots = json!([{"at": 0.0, "mass_kg": 0.004, "stiffness_rotation_n_m_rad": 0.02},
        {"at": 0.333, "stiffness_x_n_m": 2.0}, {"at": 0.71, "mass_kg": 0.01, "force_z_n": {"sine": {"amplitude": 0.03, "frequency_hz": 8}}},
        {"at": 0.86, "force_tangential_n": {"sine": {"amplitude": 0.01, "frequency_hz": 6}},
         "force_normal_n": {"sine": {"amplitude": 0.003, "frequency_hz": 4}}},
        {"at": 1.0, "mass_kg": 0.005}]);
    // under its weight it would snap on the soft spring at the root
    let mut stiff = no_dashpots.clone();
    stiff[0]["stiffness_rotation_n_m_rad"] = json!(0.2);
    let mut heavy = stiff.clone();
    heavy[1]["mass_kg"] = json!(0.01);
    heavy[1]["offset_across_m"] = json!(0.01);
    heavy[4]["offset_along_m"] = json!(-0.01);
    let near = json!([
        {"at": 0.06, "mass_kg": 0.004, "rotary_inertia_kg_m2": 4e-6, "offset_across_m": 0.01, "offset_along_m": 0.005},
        {"at": 0.3, "mass_kg": 0.004, "rotary_inertia_kg_m2": 1e-6, "offset_across_m": -0.01}]);
    let ramp =
        |to: f64, start: f64| json!({"ramp": {"to": to, "start_s": start, "duration_s": 0.05, "shape": "linear"}});
    let kicks = json!({"root": {"pinned": {"u1_m": ramp(2e-3, 0.05), "u3_m": ramp(1e-3, 0.03)}}, "tip": "free"});
    let along = json!([{"at": 0.0, "mass_kg": 0.004}, {"at": 0.333, "stiffness_z_n_m": 20.0, "damping_z_n_s_m": 0.02},
        {"at": 0.71, "mass_kg": 0.01, "force_z_n": {"sine": {"amplitude": 0.03, "frequency_hz": 8}}}]);
    let sheared = json!({"length_m": 0.1, "height_m": 0.01, "width_m": 0.02, "young_modulus_pa": 2e6, "density_kg_m3": 950,
        "shear_stiffness_n": 100});
    let cases = [
        ("finite rotation", json!({})),
        ("published", json!({"formulation": "published"})),
        ("small rotation", json!({"effects": {"finite_rotation": "off"}})),
        (
            "linear",
            json!({"effects": {"finite_rotation": "off", "axial_force_on_bending": "off"}}),
        ),
        (
            "without stretch",
            json!({"attachments": no_dashpots, "effects": {"finite_rotation": "off", "axial_stretch": "off"}}),
        ),
        (
            "without axial inertia",
            json!({"attachments": no_dashpots, "effects": {"axial_inertia": "off"}}),
        ),
        (
            "bar",
            json!({"attachments": along, "loads": [{"gravity": {"z_m_s2": -9.81}}], "effects": {"transverse_motion": "off"},
            "ends": {"root": {"pinned": {"u3_m": {"sine": {"amplitude": 1e-3, "frequency_hz": 9}}}}, "tip": "free"}}),
        ),
        ("sheared", json!({"beam": sheared})),
        (
            "sheared, small rotation",
            json!({"beam": sheared, "effects": {"finite_rotation": "off"}}),
        ),
        (
            "kicked",
            json!({"ends": {"root": {"pinned": {"u1_m": {"ramp": {"to": 2e-3, "start_s": 0.05, "duration_s": 0.05, "shape": "linear"}}}}, "tip": "free"}}),
        ),
        ("kicked beside bodies", json!({"attachments": near, "ends": kicks})),
        (
            "kicked beside bodies, small rotation",
            json!({"attachments": near, "ends": kicks, "effects": {"finite_rotation": "off", "rotary_inertia": "off"}}),
        ),
        (
            "at rest",
            json!({"attachments": stiff, "effects": {"solid_inertia": "off"}}),
        ),
        (
            "bodies at rest",
            json!({"attachments": heavy, "effects": {"solid_inertia": "off"}}),
        ),
    ];
    for (what, sets) in cases {
        let case = everything(sets);
        let mut memory = Memory::default();
        let outcome = dynamics::run(&case, &mut memory).unwrap();
        assert_eq!(
            outcome.summary.status,
            Status::Finished,
            "{what}: {:?}",
            outcome.summary.reason
        );
        let b = &outcome.summary.balances;
        println!(
            "{what}: energy {:.1e}, momentum {:?}, angular momentum {:.1e}",
            b.energy_residual_relative, b.momentum_residual_relative, b.angular_momentum_residual_relative
        );
        assert!(b.energy_residual_relative.abs() < 1e-6, "{what}");
        assert!(
            b.momentum_residual_relative < 1e-7 && b.angular_momentum_residual_relative < 1e-7,
            "{what}"
        );
    }
}

/// Goal: the derivatives that Newton's method takes are those of the residual.
#[test]
fn jacobian_agrees_with_differences() {
    for effects in [
        json!("full"),
        json!({"finite_rotation": "off"}),
        json!({"finite_rotation": "off", "axial_force_on_bending": "off"}),
        json!({"axial_inertia": "off"}),
    ] {
        let mut case = json!({"effects": effects});
        if case["effects"]["axial_inertia"] == "off" {
            case["attachments"] =
                json!([{"at": 0.4, "mass_kg": 0.01, "stiffness_x_n_m": 5, "stiffness_rotation_n_m_rad": 0.1}]);
        }
        let mut dae = BeamDae::new(System::new(&everything(case)).unwrap());
        for (seed, size) in [(1, 1.0), (2, 0.1)] {
            let worst = crate::differences::worst_difference(&mut dae, seed, size);
            println!("{effects} {size}: {worst:.1e}");
            assert!(worst < 1e-6);
        }
    }
}
