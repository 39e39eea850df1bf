//! Where the figure at the best is another size than that at the start, or flat.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::*;

/// A cantilever with a force at its tip.
fn cantilever(dir: &TempDir) -> String {
    let case = path(dir, "b.json");
    let text = r#"{"name": "b", "beam": {"length_m": 0.2, "height_m": 0.01, "width_m": 0.03, "young_modulus_pa": 2e6, "density_kg_m3": 1100},
        "ends": {"root": "clamped", "tip": {"free": {"force_x_n": -0.02, "force_z_n": 0.0}}},
        "mesh": {"segments": 8, "cells_per_segment": 1}, "time": {"end_s": 0.1}}"#;
    fs::write(&case, text).expect("a case");
    case
}

/// Source: the energy of a cantilever, F² l³/(6 E I): least where it is shortest, highest, widest and stiffest. Goal: a search goes on
/// where the figure has become small beside that at the start, from there and from elsewhere.
#[test]
fn a_figure_that_shrinks_is_followed_to_its_corner() {
    let dir = tempfile::tempdir().expect("a folder");
    let case = cantilever(&dir);
    let bounds = [
        "young_modulus_pa=1e5:2e7",
        "height_m=0.002:0.03",
        "width_m=0.01:0.1",
        "length_m=0.05:0.5",
    ];
    let bounds = bounds.map(|bound| format!("/beam/{bound}"));
    let mut asked = vec![
        case.as_str(),
        "--command",
        "equilibrium",
        "--minimize",
        "bending_energy_j",
    ];
    bounds.iter().for_each(|bound| asked.extend(["--vary", bound]));
    for starts in ["1", "4"] {
        let found = best(&dir, &[&asked[..], &["--starts", starts]].concat());
        let at: Vec<&Value> = (0..4).map(|k| &found["variables"][k]["at_bound"]).collect();
        assert_eq!(at, ["high", "high", "high", "low"], "{found}");
    }
}

/// Source: the frequency of a beam does not depend on its width. Goal: no number is told within which a flat figure is worse by 1 %.
#[test]
fn a_number_that_does_nothing_has_no_band() {
    let dir = tempfile::tempdir().expect("a folder");
    let case = cantilever(&dir);
    let found = best(
        &dir,
        &[
            &case,
            "--command",
            "modes",
            "--minimize",
            "mode_1.frequency_hz",
            "--vary",
            "/beam/width_m=0.012:0.044",
        ],
    );
    assert_eq!(found["variables"][0]["within_1_percent"], Value::Null, "{found}");
}

/// Source: the frequency of a beam does not depend on its width. Goal: a warning says so, and no bound is told as the best in silence.
#[test]
fn a_figure_that_depends_on_nothing_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    let case = cantilever(&dir);
    let width = ["--vary", "/beam/width_m=0.012:0.044", "--starts", "4"];
    let plain = ["--command", "modes", "--maximize", "mode_1.frequency_hz"];
    let found = best(&dir, &[&[case.as_str()], &plain[..], &width[..]].concat());
    let warnings = found["warnings"].as_array().expect("warnings");
    let told = |what: &Value| {
        what.as_str()
            .is_some_and(|text| text.contains("does not depend on the optimized numbers"))
    };
    assert!(warnings.iter().any(told), "{found}");
}
