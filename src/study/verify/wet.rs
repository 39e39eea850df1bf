//! Bladders on a beam that they do not bend: area depends on pressure alone, so the network is independent of the beam.

use serde_json::{Value, json};

/// Compliance `a_p l_b` of a bladder [m^3/Pa].
pub const COMPLIANCE: f64 = 1.75e-10 * 0.046;
/// Resistance `μ l_b/q1b` of a bladder from inlet to outlet [Pa s/m^3].
pub const BLADDER: f64 = 8.68e-4 * 0.046 / 1.55e-12;
/// Resistance `μ l_c/q1c` of a tube [Pa s/m^3].
pub const TUBE: f64 = 8.68e-4 * 0.020 / 6.72e-13;
/// Length of a tube [m].
pub const TUBE_LENGTH: f64 = 0.020;
/// Viscosity [Pa s].
pub const VISCOSITY: f64 = 8.68e-4;

/// `per_row` bladders in each row, each of them one volume between two half resistances, joined by `network`. The solid
/// has no inertia and no load.
pub fn case(per_row: usize, network: Value, end: f64, interval: f64) -> Value {
    json!({
        "name": "network",
        "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950},
        "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": VISCOSITY},
        "bladders": {
            "per_row": per_row, "length_m": 0.046, "height_m": 0.0078, "width_m": 0.0078, "permeability_m4": 1.55e-12,
            "area_per_pressure_m2_per_pa": 1.75e-10,
            "area_per_moment_m2_per_n_m": {"opening": 0, "closing": 0},
            "area_per_force_m2_per_n": {"tension": 0, "compression": 0},
            "coupling": {"published": {"slope_per_pressure_rad": 0, "length_per_pressure_m": 0}}
        },
        "tubes": {"length_m": TUBE_LENGTH, "radius_m": 0.001, "permeability_m4": 6.72e-13},
        "network": network,
        "ends": {"root": "clamped", "tip": "free"},
        "effects": {"solid_inertia": "off", "tube_inertia": "off", "tube_losses": "off"},
        "mesh": {"cells_per_segment": 1, "cells_per_bladder": 1},
        "time": {"end_s": end, "output_interval_s": interval},
        "solver": {"rtol": 1e-9}
    })
}

/// Initial pressures of bladders `1..`.
pub fn pressures(values: impl Iterator<Item = f64>) -> Value {
    (1..)
        .zip(values)
        .map(|(bladder, p)| json!({"bladders": [bladder], "pressure_pa": p}))
        .collect()
}
