//! Shared cases and paths of the tests.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::equilibrium::{self, EquilibriumOptions, columns, follow, system};
use slcbeam::run::record::Control;

pub fn parse(value: &Value) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), &[]).expect("a valid case")
}

pub fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
    let path = format!("{}/cases/{name}.json", env!("CARGO_MANIFEST_DIR"));
    case::load(path.as_ref(), &sets).expect("a valid case")
}

/// Unit beam of `EA L²/EI = 1.2e5 factor` with conditions at its tip.
pub fn unit(cells: usize, factor: f64, tip: Value) -> Value {
    json!({
        "name": "unit", "ends": {"root": "clamped", "tip": {"free": tip}},
        "beam": {"length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
                 "axial_stiffness_factor": factor},
        "mesh": {"segments": cells, "cells_per_segment": 1}, "time": {"end_s": 1.0}
    })
}

pub fn path_of(case: &Case, options: &EquilibriumOptions) -> equilibrium::Path {
    follow(case, options, &mut |_| Control::Continue).unwrap()
}

/// A path that reaches its end, and a reader of its last state.
pub fn solved(case: &Case) -> (equilibrium::Path, impl Fn(&str) -> f64 + use<>) {
    let at = case.time.end_s;
    let path = path_of(case, &EquilibriumOptions::at(at));
    assert!(path.fault.is_none(), "{:?}", path.fault);
    let (names, row) = (columns(&system(case, at).unwrap()), path.last().row.clone());
    (path, move |name: &str| {
        row[names.iter().position(|c| c.name == name).expect("a column")]
    })
}
