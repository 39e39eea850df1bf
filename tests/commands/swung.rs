//! A dry beam and a wet one that a load swings.

use std::path::Path;

use slcbeam::case::{self, Case};

/// A dry cantilever swung by a load on it.
pub const DRY: &str = r#"{
  "name": "dry",
  "beam": {"length_m": 0.1, "height_m": 0.02, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950},
  "loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 10, "frequency_hz": 10, "ramp_cycles": 1}}}}],
  "ends": {"root": "clamped", "tip": "free"},
  "mesh": {"segments": 3},
  "time": {"end_s": 0.15, "output_interval_s": 0.0015}
}"#;

/// Two bladders and a tube in a beam swung by a load.
pub const WET: &str = r#"{
  "name": "wet",
  "beam": {"length_m": 0.1, "height_m": 0.02, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950},
  "fluid": {"density_kg_m3": 1000, "viscosity_pa_s": 1e-3},
  "bladders": {
    "per_row": 1, "length_m": 0.046, "height_m": 0.008, "width_m": 0.008, "permeability_m4": 1.5e-12,
    "area_per_pressure_m2_per_pa": 1.75e-10,
    "area_per_moment_m2_per_n_m": {"opening": 5e-6, "closing": 5e-6},
    "area_per_force_m2_per_n": {"tension": 5e-8, "compression": 5e-8}
  },
  "tubes": {"length_m": 0.02, "radius_m": 0.001},
  "network": {"tubes": [{"from": {"bladder": 1, "end": "outlet"}, "to": {"bladder": -1, "end": "inlet"}}]},
  "loads": [{"force_x_n_m": {"signal": {"sine": {"amplitude": 20, "frequency_hz": 5, "ramp_cycles": 1}}}}],
  "ends": {"root": "clamped", "tip": "free"},
  "time": {"end_s": 0.3, "output_interval_s": 0.003}
}"#;

/// One of them, with numbers set.
pub fn parsed(text: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::parse(text, Path::new("case.json"), Path::new("."), &sets).unwrap()
}
