//! Sections that shear, [E63], against the theories of Timoshenko, Reissner and Haringx.

#[path = "../common/balances.rs"]
mod balances;
#[path = "../common/chance.rs"]
mod chance;
#[path = "../differences/mod.rs"]
mod differences;
mod frequencies;
#[path = "../common/scene.rs"]
mod scene;
mod statics;
mod whole;

use serde_json::{Value, json};

/// Length [m].
const L: f64 = 0.1;
/// Stiffness in bending [N m^2].
const EI: f64 = 2e6 * 0.05 * 0.04 * 0.04 * 0.04 / 12.0;
/// Stiffness along [N].
const EA: f64 = 2e6 * 0.05 * 0.04;
/// Stiffness in shear [N], 5/6 of the area times a third of Young's modulus.
const KGA: f64 = 5.0 / 6.0 * EA / 3.0;
/// Mass per length [kg/m].
const M: f64 = 1000.0 * 0.05 * 0.04;

/// A block of rubber 40 mm high and 50 mm wide with a stiffness in shear, none where it is `null`, and what else a case has.
fn block(shear: impl Into<Option<f64>>, sets: &Value) -> Value {
    let mut case = json!({
        "name": "block",
        "beam": {"length_m": L, "height_m": 0.04, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 1000},
        "ends": {"root": "clamped", "tip": "free"},
        "effects": "full",
        "mesh": {"segments": 10, "cells_per_segment": 1},
        "time": {"end_s": 0.2, "output_interval_s": 0.002},
        "solver": {"rtol": 1e-9}
    });
    if let Some(shear) = shear.into() {
        case["beam"]["shear_stiffness_n"] = json!(shear);
    }
    for (key, value) in sets.as_object().unwrap() {
        case[key] = value.clone();
    }
    case
}

/// The limit of what falls with the square of the cells' length, from two meshes of which the second has twice the cells.
fn limit([coarse, fine]: [f64; 2]) -> f64 {
    fine + (fine - coarse) / 3.0
}
