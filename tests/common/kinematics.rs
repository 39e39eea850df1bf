//! What may be left out of the motion of a beam.

use serde_json::{Value, json};

/// Scenes with these ends, in the published form and with less and less of the motion.
pub fn reduced(ends: &Value) -> Vec<(&'static str, Value)> {
    let without = |off: &[&str]| {
        let off = off.iter().map(|effect| ((*effect).to_string(), json!("off")));
        json!({"ends": ends, "effects": off.collect::<serde_json::Map<_, _>>()})
    };
    vec![
        ("driven", json!({"ends": ends})),
        ("published", json!({"ends": ends, "formulation": "published"})),
        ("small", without(&["finite_rotation"])),
        ("linear", without(&["finite_rotation", "axial_force_on_bending"])),
        ("inextensible", without(&["finite_rotation", "axial_stretch"])),
        ("frame", without(&["finite_rotation", "axial_inertia"])),
    ]
}
