//! Figures of probes as limits and as what is sought.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::*;

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.01;
const WIDTH: f64 = 0.1;
const LIMIT: f64 = 1e6;

/// A steel cantilever with a force on its tip, at rest from the beginning, and probes at its root and in its middle.
fn cantilever(dir: &TempDir) -> String {
    let case = json!({
        "name": "stressed",
        "beam": {"length_m": LENGTH, "height_m": HEIGHT, "width_m": WIDTH, "young_modulus_pa": 2e11, "density_kg_m3": 7800.0,
                 "damping": {"bending_time_s": 1e-3}},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": 0.5}}},
        "probes": [{"name": "root", "at": 0}, {"name": "middle", "at": 0.5}],
        "mesh": {"segments": 20, "cells_per_segment": 1, "order": 4},
        "start": {"equilibrium": {}},
        "effects": "full",
        "time": {"end_s": 0.01}
    });
    let path = path(dir, "stressed.json");
    fs::write(&path, case.to_string()).expect("written");
    path
}

const FORCE: &str = "/ends/tip/free/force_x_n=0.1:10";

/// Source: `σ = 6 F l/(b h²)` at the root, `u = F l³/3EI` at the tip. Goal: the largest force under a limit of the stress is the one that reaches it,
/// the limit is active, and what it costs is `du/dσ`; of equilibria and of runs.
#[test]
fn a_stress_limits_the_force() {
    let force = LIMIT * WIDTH * HEIGHT.powi(2) / (6.0 * LENGTH);
    let cost = LENGTH.powi(2) * 2.0 / (3.0 * 2e11 * HEIGHT);
    let cases: [(&str, &str, &str, &[&str], f64); 3] = [
        ("equilibrium", "root_stress_lower_pa<=1e6", "tip_u1_m", &[], 1e-3),
        (
            "run",
            "root_stress_lower_pa.max_abs<=1e6",
            "tip_u1_m.max_abs",
            &[],
            2e-3,
        ),
        (
            "equilibrium",
            "root_stress_upper_pa>=-1e6",
            "middle_u1_m",
            &["--starts", "2"],
            5e-3,
        ),
    ];
    for (command, limit, figure, more, tolerance) in cases {
        let dir = tempfile::tempdir().expect("a folder");
        let case = cantilever(&dir);
        let asked = [
            &case,
            "--vary",
            FORCE,
            "--maximize",
            figure,
            "--subject-to",
            limit,
            "--command",
            command,
        ];
        let found: Value = best(&dir, &[&asked[..], more].concat());
        let value = number(&found["variables"][0]["value"]);
        assert!(
            (value / force - 1.0).abs() < tolerance,
            "{limit}: {value}, not {force}: {found}"
        );
        let held = &found["limits"][0];
        assert_eq!(held["reached"], true, "{found}");
        if more.is_empty() {
            assert_eq!(found["derivatives"], "exact");
            assert!((number(&held["gain"]) / cost - 1.0).abs() < 5e-3, "{held}: {cost}");
        }
    }
}

/// Goal: a figure of a probe is what is sought, over a cycle too: the least stress in the middle.
#[test]
fn a_stress_is_sought() {
    let dir = tempfile::tempdir().expect("a folder");
    let case = cantilever(&dir);
    let sine = r#"/ends/tip/free/force_x_n={"sine": {"amplitude": 0.5, "frequency_hz": 2}}"#;
    for (command, set) in [("run", "/name=\"still\"".to_owned()), ("periodic", sine.to_owned())] {
        let asked = [
            &*case,
            "--set",
            &set,
            "--vary",
            "/beam/height_m=0.008:0.012",
            "--minimize",
            "middle_stress_lower_pa.window_max_abs",
            "--subject-to",
            "middle_strain_upper.window_max_abs<=1",
            "--command",
            command,
        ];
        let found = best(&dir, &asked);
        let height = number(&found["variables"][0]["value"]);
        assert!((height - 0.012).abs() < 1e-6, "{command}: {found}");
    }
}
