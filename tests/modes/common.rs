//! Shared cases of the tests.

use std::path::Path;

use serde_json::{Value, json};
use slcbeam::case::{self, Case};
use slcbeam::run::modes::{self, ModeOptions, Modes};

/// A checked case.
pub fn checked(case: &Value) -> Case {
    case::parse(&case.to_string(), Path::new("test.json"), Path::new(""), &[])
        .map_err(|e| format!("{e:?}"))
        .unwrap()
}

/// The slowest modes of a case, with the fluid held and freed, too.
pub fn slowest(case: &Value, count: usize) -> Modes {
    modes::modes(&checked(case), &plan(count)).unwrap()
}

/// The slowest modes.
pub fn plan(count: usize) -> ModeOptions {
    ModeOptions {
        count,
        near_hz: 0.0,
        limits: true,
    }
}

/// The paper's beam with `per_row` bladders in each row, with the total size of the paper's ten. One slope `am` [m^2/(N m)] (of ten) is
/// that of both signs of the moment; areas do not depend on the normal force. Passive up to `am` = 1.9e-5. The network is a placeholder.
pub fn wet(per_row: usize, viscosity: f64, am: f64) -> Value {
    json!({
        "name": "wet",
        "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
                 "axial_stiffness_factor": 0.53, "bending_stiffness_factor": 0.60},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": viscosity},
        "bladders": {
            "per_row": per_row, "length_m": 0.046, "height_m": 0.0078,
            "width_m": 0.0078 * 10.0 / per_row.max(10) as f64, "permeability_m4": 1.55e-12,
            "area_per_pressure_m2_per_pa": 1.75e-10 * 10.0 / per_row as f64,
            "area_per_moment_m2_per_n_m": {"opening": am * 10.0 / per_row as f64, "closing": am * 10.0 / per_row as f64},
            "area_per_force_m2_per_n": {"tension": 0, "compression": 0}
        },
        "tubes": {"length_m": 0.020, "radius_m": 0.001, "permeability_m4": 6.72e-13},
        "network": {},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": {"tube_inertia": "off", "tube_losses": "off"},
        "mesh": {"cells_per_segment": 4, "cells_per_bladder": 1},
        "time": {"end_s": 1.0}
    })
}

/// Each upper bladder joined to the lower one below it: bending drives fluid from one row into the other.
pub fn across(per_row: usize, viscosity: f64, am: f64) -> Value {
    let mut case = wet(per_row, viscosity, am);
    let tube = |j: usize| {
        let j = j as i64;
        json!({"from": {"bladder": j, "end": "outlet"}, "to": {"bladder": -j, "end": "inlet"}})
    };
    case["network"]["tubes"] = (1..=per_row).map(tube).collect();
    case
}

/// Each row is a separate chain, sealed at its ends.
pub fn chains(per_row: usize, viscosity: f64, am: f64) -> Value {
    let mut case = wet(per_row, viscosity, am);
    let row = |sign: i64| (1..=per_row as i64).map(|j| sign * j).collect::<Vec<_>>();
    case["network"] = json!({"chains": [
        {"bladders": row(1), "ends": ["sealed", "sealed"]}, {"bladders": row(-1), "ends": ["sealed", "sealed"]}
    ]});
    case
}
