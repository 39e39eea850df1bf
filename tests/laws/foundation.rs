//! Elastic foundations, [E84], and distributed loads that turn with the beam: closed forms, integration, balances and differences.

use std::f64::consts::PI;
use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::equilibrium::{EquilibriumOptions, columns, follow, system};
use slcbeam::run::modes::{ModeOptions, modes};
use slcbeam::run::record::{Control, Memory};
use slcbeam::run::summary::Status;

use crate::jacobian::agrees;

pub fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("mine.json"), Path::new(""), &[]).unwrap()
}

/// A beam of unit stiffness, length and mass per length.
pub fn unit(cells: usize, ends: &Value, more: &Value) -> Value {
    let mut case = json!({
        "name": "unit", "ends": ends,
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
                 "axial_stiffness_factor": 1000},
        "mesh": {"segments": cells, "cells_per_segment": 1}, "companion": "off",
        "time": {"end_s": 1.0, "output_interval_s": 0.05}, "solver": {"rtol": 1e-7}
    });
    for (key, value) in more.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

/// Value of a column in the equilibrium under all loads.
pub fn at_rest(case: &Value, name: &str) -> f64 {
    let case = parse(case);
    let path = follow(&case, &EquilibriumOptions::at(1.0), &mut |_| Control::Continue).unwrap();
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let at = columns(&system(&case, 1.0).unwrap())
        .iter()
        .position(|c| c.name == name);
    path.last().row[at.unwrap()]
}

pub fn order(errors: [f64; 2]) -> f64 {
    (errors[0] / errors[1]).abs().log2()
}

/// Pinned at both ends, free along at the tip.
fn pinned() -> Value {
    json!({"root": "pinned", "tip": {"conditions": {"u1_m": 0, "moment_n_m": 0, "force_z_n": 0}}})
}

/// Goal: `u = q sin(π x)/(EI π⁴ + k)` of a pinned beam, with the order of the mesh.
#[test]
fn a_beam_on_a_foundation_bends_as_its_closed_form() {
    let load = json!([{"force_x_n_m": {"signal": 1e-3, "profile": {"sine": {"waves": 0.5}}}}]);
    let exact = 1e-3 / (PI.powi(4) + 400.0);
    for (order_of_mesh, cells, least) in [(2, [20, 40], 1.9), (4, [10, 20], 3.7)] {
        let errors = cells.map(|cells| {
            let more = json!({"loads": load, "foundation": {"stiffness_x_n_m2": 400}, "probes": [{"name": "middle", "at": 0.5}]});
            let mut case = unit(cells, &pinned(), &more);
            case["mesh"]["order"] = json!(order_of_mesh);
            at_rest(&case, "middle_u1") / exact - 1.0
        });
        assert!(
            errors[1].abs() < 2e-3 && order(errors) > least,
            "order {order_of_mesh}: {errors:?}"
        );
    }
}

/// Goal: a uniform foundation raises the square of every frequency by k/m, across and along.
#[test]
fn a_foundation_raises_frequencies_by_its_stiffness_over_the_mass() {
    let plan = ModeOptions {
        count: 6,
        near_hz: 1.0,
        limits: false,
    };
    let squares = |more: &Value| {
        let mut case = unit(20, &json!({"root": "clamped", "tip": "free"}), more);
        case["effects"] = json!({"rotary_inertia": "off"});
        let found = modes(&parse(&case), &plan).unwrap();
        let mut all: Vec<f64> = found
            .modes
            .iter()
            .filter_map(|mode| mode.frequency_hz())
            .map(|f| (2.0 * PI * f).powi(2))
            .collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let (plain, held) = (
        squares(&json!({})),
        squares(&json!({"foundation": {"stiffness_x_n_m2": 50, "stiffness_z_n_m2": 50}})),
    );
    for (a, b) in plain.iter().zip(&held).take(3) {
        assert!((b - a - 50.0).abs() < 1e-5 * b, "{a} {b}");
    }
}

/// Angle of the tip against that of the root under loads per length across and along that turn with the beam, by Runge and Kutta's
/// method from the tip, where all section forces are zero: `N' = V κ - q_t`, `V' = -N κ - q_n`, `M' = -V`, `κ = M/EI`.
fn integrated(normal: f64, tangential: f64) -> f64 {
    let f = |y: [f64; 4]| [y[1] * y[2] - tangential, -y[0] * y[2] - normal, -y[1], y[2]];
    let (mut y, steps) = ([0.0; 4], 2000);
    let h = -1.0 / f64::from(steps);
    for _ in 0..steps {
        let along = |k: [f64; 4], by: f64| std::array::from_fn(|i| y[i] + by * h * k[i]);
        let k1 = f(y);
        let k2 = f(along(k1, 0.5));
        let k3 = f(along(k2, 0.5));
        let k4 = f(along(k3, 1.0));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    y[3]
}

/// Goal: a cantilever under a pressure that turns with it bends as the integrated elastica, with order two.
#[test]
fn a_load_that_turns_bends_as_the_integrated_elastica() {
    for (normal, tangential) in [(6.0, 0.0), (4.0, -3.0)] {
        let exact = integrated(normal, tangential).abs();
        assert!(exact > 0.5, "large rotation: {exact}");
        let errors = [20, 40].map(|cells| {
            let loads =
                json!([{"force_normal_n_m": {"signal": normal}}, {"force_tangential_n_m": {"signal": tangential}}]);
            let case = unit(
                cells,
                &json!({"root": "clamped", "tip": "free"}),
                &json!({"loads": loads}),
            );
            at_rest(&case, "tip_angle").abs() / exact - 1.0
        });
        assert!(
            errors[1].abs() < 1e-3 && order(errors) > 1.8,
            "{normal} {tangential}: {errors:?}"
        );
    }
}

/// Goal: energy and momentum close in motion, and the Jacobian belongs to the residual, for finite and small rotations.
#[test]
fn balances_close_and_the_jacobian_is_that_of_the_residual() {
    let more = json!({
        "loads": [{"force_normal_n_m": {"signal": {"ramp": {"to": 2, "start_s": 0, "duration_s": 0.5, "shape": "smooth"}},
                                          "profile": {"sine": {"waves": 0.5}}}},
                  {"force_tangential_n_m": {"signal": 0.3}}],
        "foundation": {"stiffness_x_n_m2": {"polynomial": {"coefficients": [10, 20]}}, "stiffness_z_n_m2": 30},
        "effects": "full"
    });
    let case = unit(16, &json!({"root": "clamped", "tip": "free"}), &more);
    let summary = dynamics::run(&parse(&case), &mut Memory::default()).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    let balances = &summary.balances;
    for open in [
        balances.energy_residual_relative,
        balances.momentum_residual_relative,
        balances.angular_momentum_residual_relative,
    ] {
        assert!(open.abs() < 1e-4, "{balances:?}");
    }
    for rotation in ["on", "off"] {
        let mut case = case.clone();
        case["effects"] = json!({"finite_rotation": rotation});
        agrees(&parse(&case), rotation);
    }
}
