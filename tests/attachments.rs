//! What is attached to the beam, [E60] and [E61]: point masses, springs and dashpots to ground, forces at places.
//!
//! Sources: Euler-Bernoulli's beam (Blevins 1979, Formulas for Natural Frequency and Mode Shape, chapter 8), whose frequency equations are
//! solved here by bisection; the axial force and the rotary inertia that they leave out are off or made small.

mod differences;

use serde_json::{Value, json};
use slcbeam::case::{self, schema::Case};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;

/// EI = 1 N m², m = 1 kg/m, l = 1 m: a slender section, so that its rotary inertia is 1e-8.
fn slender(ends: Value, attachments: Value, cells: usize, more: Value) -> Case {
    let mut case = json!({
        "name": "attached",
        "beam": {"length_m": 1.0, "height_m": 3.464_101_615_137_754_6e-4, "width_m": 1.0,
                 "young_modulus_pa": 1.0 / (3.464_101_615_137_754_6e-4_f64.powi(3) / 12.0),
                 "density_kg_m3": 1.0 / 3.464_101_615_137_754_6e-4},
        "ends": ends,
        "attachments": attachments,
        "formulation": "conservative",
        "effects": "full",
        "mesh": {"segments": cells, "cells_per_segment": 1},
        "time": {"end_s": 1.0}
    });
    for (key, value) in more.as_object().unwrap() {
        case[key] = value.clone();
    }
    case::parse(&case.to_string(), &[]).unwrap()
}
