//! A beam that swings against stops.

use serde_json::json;
use slcbeam::case::Case;
use slcbeam::discrete::System;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};
use slcbeam::study::companion;

use super::{beam, parse, run};

/// Goal: a beam let swing against a stop keeps its energy, without damping and friction, whatever strikes; the balance closes as the
/// tolerance says, by each kind of method.
#[test]
fn striking_a_stop_keeps_energy() {
    let stop = json!([{"name": "stop", "point_m": [-0.01, 1], "normal": [1, 0], "at": 1, "stiffness_n_m": 1e4, "reach_m": 0, "smoothing_m": 1e-4}]);
    for method in ["ida", "esdirk46"] {
        let mut open = vec![];
        for rtol in [1e-5, 1e-7] {
            let mut case = beam(json!("clamped"), json!("free"), stop.clone());
            case["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.6]}}});
            case["effects"] = json!("full");
            case["solver"] = json!({"rtol": rtol, "method": method});
            case["time"] = json!({"end_s": 2.0, "output_interval_s": 1e-3});
            let (memory, summary) = run(&case);
            let total: Vec<f64> = [
                "kinetic_energy",
                "rotary_energy",
                "axial_energy",
                "bending_energy",
                "contact_energy",
            ]
            .iter()
            .map(|name| memory.column(name).unwrap())
            .reduce(|a, b| a.iter().zip(&b).map(|(a, b)| a + b).collect())
            .unwrap();
            let drift = total.iter().map(|e| (e / total[0] - 1.0).abs()).fold(0.0, f64::max);
            let struck = memory.column("contact_stop_normal_force").unwrap();
            assert!(struck.iter().any(|f| *f > 1.0), "never struck");
            println!(
                "{method} {rtol:e}: {drift:e} {:e}",
                summary.balances.energy_residual_relative
            );
            open.push(drift);
        }
        assert!(open[1] < 1e-4 && open[1] < 0.3 * open[0], "{method}: {open:?}");
    }
}

/// Goal: at speed, a hard wall, loose tolerances, many bounces between two walls, with damping and friction: runs end, and what the balance
/// of energy leaves open is what the tolerance explains.
#[test]
fn hard_strikes_end() {
    for (stiffness, smoothing) in [(1e4, 1e-3), (1e6, 1e-5)] {
        for lossy in [false, true] {
            for (method, rtol, most) in [("ida", 1e-3, 0.1), ("esdirk46", 1e-3, 0.1), ("auto", 1e-5, 1e-2)] {
                let wall = |name: &str, x: f64| {
                    let mut wall = json!({"name": name, "point_m": [x, 0], "normal": [-x.signum(), 0.05], "stiffness_pa": stiffness, "reach_m": 0, "smoothing_m": smoothing});
                    if lossy {
                        wall["damping_s_m"] = json!(0.3);
                        wall["friction_coefficient"] = json!(0.3);
                        wall["friction_velocity_m_s"] = json!(1e-2);
                    }
                    wall
                };
                let mut case = beam(
                    json!("free"),
                    json!("free"),
                    json!([wall("below", -0.06), wall("above", 0.06)]),
                );
                case["start"] = json!({"u1_rate_m_s": {"polynomial": {"coefficients": [3, -4]}}, "u3_rate_m_s": 0.5});
                case["effects"] = json!("full");
                case["solver"] = json!({"rtol": rtol, "method": method});
                case["time"] = json!({"end_s": 0.2, "output_interval_s": 1e-3});
                let (memory, summary) = run(&case);
                let open = summary.balances.energy_residual_relative.abs();
                let walls = ["below", "above"].map(|name| memory.column(&format!("contact_{name}_depth")).unwrap());
                assert!(walls.iter().flatten().any(|depth| *depth > 0.0), "never struck");
                println!(
                    "{stiffness:e} {lossy} {method} {rtol:e}: {open:e}, {} steps",
                    summary.solver.steps
                );
                assert!(open < most, "{stiffness:e} {lossy} {method} {rtol:e}: {open:e}");
            }
        }
    }
}

/// A cantilever of silicone with an initial velocity, without damping but for `damping` [s], that swings against a stop at its tip.
fn struck(damping: f64, cells: usize, (method, rtol): (&str, f64)) -> Case {
    parse(&json!({
        "name": "struck",
        "beam": {"length_m": 0.2, "height_m": 0.01, "width_m": 0.03, "young_modulus_pa": 2e6, "density_kg_m3": 1100,
                 "damping": {"bending_time_s": damping}},
        "ends": {"root": "clamped", "tip": "free"},
        "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.2]}}},
        "mesh": {"segments": 10, "cells_per_segment": cells},
        "solver": {"method": method, "rtol": rtol},
        "contacts": [{"name": "stop", "point_m": [-0.012, 0.2], "normal": [1, 0], "at": 1, "stiffness_n_m": 2e4, "smoothing_m": 1e-4}],
        "time": {"end_s": 2, "output_interval_s": 0.005}
    }))
}

/// Source: runs at a tolerance of 1e-8. Goal: where 22 strikes of a beam that vibrates multiply errors by thousands, W021 names the tip and its bars
/// cover the error of the steps. A beam whose vibrations decay between strikes is not reported.
#[test]
fn strikes_that_multiply_errors_are_reported() {
    let run = |case: &Case| {
        let system = System::new(case).expect("a system");
        let outcome = companion::run(case, system, &[], &mut Memory::default()).expect("a run");
        assert_eq!(outcome.summary.status, Status::Finished);
        outcome.summary
    };
    let told = |summary: &Summary| {
        summary
            .warnings
            .iter()
            .any(|w| w.starts_with("W021") && w.contains("tip_u1_m"))
    };
    let reference = run(&struck(0.0, 4, ("esdirk46", 1e-8)));
    for (method, rtol) in [("trbdf2", 1e-6), ("ida", 1e-6)] {
        let summary = run(&struck(0.0, 4, (method, rtol)));
        let [value, right] = [&summary, &reference].map(|s| s.quantities["tip_u1_m"].last.expect("a tip"));
        let bar = summary.error("tip_u1_m", "final").expect("a bar");
        println!("{method} {rtol:e}: {value:.3e} ± {bar:.1e}, right {right:.3e}");
        assert!(
            3.0 * bar > (value - right).abs() && told(&summary),
            "{:?}",
            summary.warnings
        );
    }
    let damped = run(&struck(2e-3, 4, ("esdirk46", 1e-6)));
    assert!(!told(&damped), "{:?}", damped.warnings);
}
