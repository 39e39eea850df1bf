//! Jumps of the neutral axis along a beam, [E89]: against closed forms, fine meshes, balances and differences.

use serde_json::{Value, json};
use slcbeam::discrete::System;

use crate::eccentric::{at_rest, merge, pressed};
use crate::jacobian::agrees;
use crate::spans::{column, order, parse, run};

/// A rigid root, six segments with an upper row above a neutral axis beside the line, and an uncovered tip.
fn jumps(cells: usize) -> Value {
    let spans = json!([
        {"length_m": 0.02, "rows": "none", "beam": {"young_modulus_pa": 1e7}},
        {"length_m": 0.06, "rows": "upper", "beam": {"neutral_axis_m": -0.004}},
        {"rows": "none"}
    ]);
    let chain = json!({"chains": [{"bladders": [3, 4, 5, 6, 7, 8],
        "ends": [{"pressure_pa": {"ramp": {"to": 20000, "start_s": 0, "duration_s": 0.05, "shape": "smooth"}}}, "sealed"]}]});
    let extra = json!({"network": chain, "spans": spans, "mesh": {"cells_per_segment": cells},
        "loads": [{"gravity": {"x_m_s2": 5.0, "z_m_s2": 3.0}}]});
    pressed(&json!({"reference_axis_m": 0.0}), &json!({}), &extra)
}

/// Goal: a force on the line of a cantilever bends both halves about their own axes, `κ = -d N/EI` and `λ - 1 = N (1/EA + d²/EI)`, on every
/// mesh.
#[test]
fn a_force_bends_both_halves_about_their_axes() {
    for cells in [2, 5] {
        let case = json!({
            "name": "halves", "ends": {"root": "clamped", "tip": {"free": {"force_z_n": 1e-3}}},
            "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
                     "reference_axis_m": 0.0},
            "spans": [{"length_m": 0.5, "beam": {"neutral_axis_m": 0.003}},
                      {"beam": {"young_modulus_pa": 3e8, "neutral_axis_m": -0.002}}],
            "effects": {"finite_rotation": "off", "axial_force_on_bending": "off"},
            "mesh": {"segments": 2, "cells_per_segment": cells}, "time": {"end_s": 1.0}
        });
        let halves = [(1.0_f64, 0.003_f64), (0.25, -0.002)];
        let (force, ea) = (1e-3, 1.2e5);
        let exact = [
            halves.iter().map(|(e, d)| -0.5 * d * force / e).sum::<f64>(),
            halves
                .iter()
                .map(|(e, d)| 0.5 * force * (1.0 / (ea * e) + d * d / e))
                .sum(),
        ];
        let found = at_rest(&case, ["tip_angle", "tip_u3"]);
        println!("{found:?} {exact:?}");
        for (found, exact) in found.into_iter().zip(exact) {
            assert!((found.abs() / exact.abs() - 1.0).abs() < 1e-6, "{found} {exact}");
        }
    }
}

/// Goal: displacements, angle and pressure converge with order two across the jumps.
#[test]
fn jumps_of_the_axis_cost_no_order() {
    let names = ["tip_u1", "tip_u3", "tip_angle", "max_pressure"];
    let of = |cells| {
        let run = run(&jumps(cells));
        names.map(|name| column(&run, name).last().copied().unwrap())
    };
    let fine = of(24);
    let [coarse, middle] = [2, 4].map(of);
    for (k, name) in names.into_iter().enumerate() {
        let errors = [coarse, middle].map(|found| found[k] - fine[k]);
        println!("{name}: {:.4e} {errors:?} order {:.2}", fine[k], order(errors));
        let small = errors[1].abs() < 1e-5 * fine[k].abs();
        assert!(small || order(errors) > 1.8, "{name}: {errors:?}");
    }
}

/// Goal: energy and volume close, and the Jacobian belongs to the residual, in all kinematics, with shear and with a moment at the tip.
#[test]
fn jumps_of_the_axis_conserve_energy() {
    let case = jumps(2);
    let balances = run(&case).1.balances;
    assert!(balances.energy_residual_relative.abs() < 1e-5, "{balances:?}");
    assert!(balances.volume_residual_relative.abs() < 1e-9, "{balances:?}");
    for change in [
        json!({}),
        json!({"finite_rotation": "off"}),
        json!({"finite_rotation": "off", "axial_force_on_bending": "off"}),
        json!({"shear": "on"}),
    ] {
        let mut case = case.clone();
        case["effects"] = json!({});
        merge(
            &mut case,
            &json!({"effects": change, "ends": {"tip": {"free": {"moment_n_m": 1e-3}}}}),
        );
        if change["shear"] == "on" {
            case["beam"]["shear_stiffness_n"] = json!(40.0);
        }
        assert_eq!(System::new(&parse(&case)).unwrap().sections.offset_borders.len(), 2);
        agrees(&parse(&case), &change);
    }
}
