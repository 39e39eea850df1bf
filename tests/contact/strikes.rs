//! A beam that swings against stops.

use serde_json::{Value, json};
use slcbeam::run::record::Memory;

use super::{beam, run};

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
fn struck(damping: f64, stiffness: f64, cells: usize, (method, rtol): (&str, f64)) -> Value {
    json!({
        "name": "struck",
        "beam": {"length_m": 0.2, "height_m": 0.01, "width_m": 0.03, "young_modulus_pa": 2e6, "density_kg_m3": 1100,
                 "damping": {"bending_time_s": damping}},
        "ends": {"root": "clamped", "tip": "free"},
        "start": {"u1_rate_m_s": {"polynomial": {"coefficients": [0, 0, 0.2]}}},
        "mesh": {"segments": 20, "cells_per_segment": cells},
        "solver": {"method": method, "rtol": rtol},
        "contacts": [{"name": "stop", "point_m": [-0.012, 0.2], "normal": [1, 0], "at": 1, "stiffness_n_m": stiffness, "smoothing_m": 1e-4}],
        "time": {"end_s": 2, "output_interval_s": 0.005}
    })
}

/// Largest difference of the deflections of the tip in the last 0.4 s, over the largest deflection.
fn apart_at_the_end(a: &Memory, b: &Memory) -> f64 {
    let [a, b] = [a, b].map(|memory| memory.column("tip_u1").unwrap());
    let late = a.len() - 80;
    let size = b.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    let apart = a[late..].iter().zip(&b[late..]).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max) / size
}

/// Source: runs at a tolerance of 1e-8 and on a mesh twice as fine. Goal: where 22 strikes of a beam that vibrates multiply errors by thousands, the
/// run reports it with W021, and its estimate is no less than a third of the truth, of steps and of the mesh. A beam whose vibrations decay between
/// strikes is not reported. The estimate was 0.5 %, with errors of 30 %.
#[test]
fn strikes_that_multiply_errors_are_reported() {
    let reference = run(&struck(0.0, 2e4, 4, ("esdirk46", 1e-8)));
    let finer = run(&struck(0.0, 2e4, 8, ("esdirk46", 1e-7)));
    for (method, rtol) in [("trbdf2", 1e-6), ("ida", 1e-6), ("esdirk46", 1e-7)] {
        let (memory, summary) = run(&struck(0.0, 2e4, 4, (method, rtol)));
        let [steps, mesh] = [&reference, &finer].map(|(other, _)| apart_at_the_end(&memory, other));
        let told = summary.warnings.iter().find(|w| w.starts_with("W021"));
        let estimate = &summary.estimate.as_ref().unwrap().quantities["tip_u1_m"];
        println!(
            "{method} {rtol:e}: true {steps:.1e} {mesh:.1e}, estimated {:?} {:?}",
            estimate.time, estimate.space
        );
        assert!(3.0 * estimate.time.unwrap() > steps && 3.0 * estimate.space.unwrap() > mesh);
        assert!(
            told.is_some_and(|told| told.contains("strikes against walls multiply errors")),
            "{told:?}"
        );
    }
    let (memory, summary) = run(&struck(2e-3, 2e4, 4, ("esdirk46", 1e-7)));
    let (finer, _) = run(&struck(2e-3, 2e4, 8, ("esdirk46", 1e-7)));
    let truth = apart_at_the_end(&memory, &finer);
    let estimate = summary.estimate.as_ref().unwrap().quantities["tip_u1_m"].total.unwrap();
    println!("damped: true {truth:.1e}, estimated {estimate:.1e}");
    assert!(truth < 5e-3 && estimate < 0.02, "{truth:e} {estimate:e}");
    assert!(
        !summary.warnings.iter().any(|w| w.starts_with("W021")),
        "{:?}",
        summary.warnings
    );
}

/// Source: a run on a mesh twice as fine. Goal: the error of the mesh of a beam that strikes a soft stop, multiplied by strikes, is estimated within a
/// factor of 5; it was estimated as 1 %, and is 30 %.
#[test]
fn strikes_multiply_errors_of_the_mesh() {
    let [(memory, summary), (finer, _)] = [4, 8].map(|cells| run(&struck(0.0, 500.0, cells, ("esdirk46", 1e-7))));
    let truth = apart_at_the_end(&memory, &finer);
    let estimate = summary.estimate.as_ref().unwrap().quantities["tip_u1_m"].space.unwrap();
    println!("true {truth:.1e}, estimated {estimate:.1e}");
    assert!(
        truth > 0.1 && estimate > 0.2 * truth && estimate < 5.0 * truth,
        "{truth:e} {estimate:e}"
    );
}
