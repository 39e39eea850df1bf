//! The beam of most problems: length 1 m, EI 1 N m^2, 1 kg/m, so that computed numbers equal dimensionless ones.

use serde_json::{Value, json};

/// The unit beam with `EA = 1.2e5 axial_factor` N.
pub fn unit_beam(axial_factor: f64) -> Value {
    json!({
        "length_m": 1.0, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1.2e9, "density_kg_m3": 1e4,
        "axial_stiffness_factor": axial_factor
    })
}

/// Load path over 1 s with this tip: without inertia of the solid, every instant is an equilibrium. The tolerance of Newton's iteration is much tighter than that of the error test. With IDA's own
/// 0.33, the remaining error of the iteration is noise to the error test of these purely algebraic equations. The test
/// then keeps the order at 1, with up to 300 times as many steps.
pub fn load_path(beam: Value, cells: usize, tip: Value) -> Value {
    json!({
        "name": "load-path", "beam": beam, "ends": {"root": "clamped", "tip": tip},
        "effects": {"solid_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0, "output_interval_s": 1.0},
        "solver": {"rtol": 1e-6, "nonlinear_coefficient": 1e-4}
    })
}

/// Linear growth: `rate t`.
pub fn growing(rate: f64) -> Value {
    json!({"polynomial": {"coefficients": [0.0, rate]}})
}

/// Motion in time of the unit beam with an unextended axis, started with the transverse displacement `start`, a
/// function of `x/L`. No rotary inertia. The caller sets the ends.
pub fn motion(cells: usize, start: impl Fn(f64) -> f64, end: f64, interval: f64) -> Value {
    let places: Vec<f64> = (0..=cells).map(|i| i as f64 / cells as f64).collect();
    let values: Vec<f64> = places.iter().map(|&x| SMALL * start(x)).collect();
    json!({
        "name": "motion", "beam": unit_beam(1.0), "ends": {"root": "clamped", "tip": "free"},
        "start": {"u1_m": {"table": {"positions": places, "values": values}}},
        "effects": {"solid_inertia": "on", "rotary_inertia": "off"},
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": end, "output_interval_s": interval},
        "solver": {"rtol": 1e-6, "transverse_scale_m": SMALL}
    })
}

/// Amplitude of small motions [m]: nonlinear terms are `EA/EI SMALL^2`, 1e-7 of the linear ones.
pub const SMALL: f64 = 1e-6;
