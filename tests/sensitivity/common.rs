//! Small cases, and runs of them.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::parameter::Parameter;
use slcbeam::case::{self, Case};
use slcbeam::discrete::System;
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

pub fn parse(value: &Value, sets: &[String]) -> Case {
    case::parse(&value.to_string(), Path::new("test.json"), Path::new(""), sets).unwrap_or_else(|e| panic!("{e:?}"))
}

/// A short beam of two segments with some waves in it, or none; tolerances at which differences of runs keep five digits.
pub fn beam(end_s: f64) -> Value {
    json!({
        "name": "short",
        "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
                 "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.6,
                 "damping": {"bending_time_s": 1e-3, "axial_time_s": 1e-3}},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 2, "cells_per_segment": 3, "cells_per_bladder": 2},
        "time": {"end_s": end_s, "output_interval_s": end_s / 40.0, "window_s": end_s / 2.0},
        "solver": {"rtol": 1e-8, "method": "ida", "max_order": 5}
    })
}

/// The same with two bladders a row.
pub fn wet(end_s: f64) -> Value {
    let mut case = beam(end_s);
    case["mesh"] = json!({"cells_per_segment": 3, "cells_per_bladder": 2});
    case["fluid"] = json!({"density_kg_m3": 1000, "viscosity_pa_s": 8.68e-4});
    case["bladders"] = json!({
        "per_row": 2, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
        "area_per_pressure_m2_per_pa": 1.75e-10,
        "area_per_moment_m2_per_n_m": {"opening": 3.75e-6, "closing": 6.54e-6},
        "area_per_force_m2_per_n": {"tension": 3.64e-8, "compression": 6.31e-8},
        "coupling": "reciprocal"
    });
    case["tubes"] = json!({"length_m": 0.02, "radius_m": 0.001, "permeability_m4": 6.72e-13});
    case["network"] = json!({"chains": [{"bladders": [1, 2], "ends": ["sealed", "sealed"]}]});
    case["effects"] = json!({"tube_inertia": "off", "tube_losses": "off"});
    case["start"] =
        json!({"pressures": [{"bladders": [1], "pressure_pa": 1000.0}, {"bladders": [-2], "pressure_pa": 300.0}]});
    case
}

pub fn finished(case: &Case, parameters: &[Parameter]) -> (Memory, Summary) {
    let mut memory = Memory::default();
    let outcome = dynamics::run_with(case, System::new(case).unwrap(), parameters, &mut memory).expect("a run");
    assert_eq!(outcome.summary.status, Status::Finished, "{:?}", outcome.fault);
    (memory, outcome.summary)
}
