//! Values that a case need not repeat: those of a preset stand wherever the case has none of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::faults::{SetValue, is_below};
use super::sets;

/// Sections that a preset brings.
pub const SECTIONS: [&str; 4] = ["beam", "fluid", "bladders", "tubes"];

const MATIA_GAT_BEAM: &str = include_str!("presets/matia-gat-beam.json");

/// Material and sizes to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The beam of the paper (section 3.1): 100 x 21.6 x 50 mm of silicone (2 MPa, 950 kg/m^3) with two rows of ten bladders and
    /// tubes of 2 mm, filled with water. Its coefficients belong to these sizes. The coupling is the reciprocal one.
    MatiaGatBeam,
}

/// Fills in what the case leaves to its preset: objects are merged, everything else that the case has stands, and what it
/// gives as `null` is left out. A permeability is not taken from the preset where the case has a size to compute it from.
pub fn apply(case: &mut Value, sets: &[SetValue]) {
    if case.get("preset").is_none() {
        return;
    }
    // A misspelt name is told when the case is checked; the rest is looked at as if it were right.
    let mut preset: Value = serde_json::from_str(MATIA_GAT_BEAM).unwrap_or_default();
    for (section, sizes) in [
        ("bladders", &["height_m", "width_m", "cross_section"][..]),
        ("tubes", &["radius_m"]),
    ] {
        let own = |key: &&str| case.get(section).and_then(|s| s.get(*key)).is_some();
        if let (true, Some(values)) = (sizes.iter().any(own), preset[section].as_object_mut()) {
            values.shift_remove("permeability_m4");
        }
    }
    fill(case, preset);
    for (i, set) in sets.iter().enumerate().filter(|(_, set)| set.node.is_none()) {
        let given_again = sets[i + 1..].iter().any(|later| is_below(&later.pointer, &set.pointer));
        if !given_again {
            sets::remove(case, &set.pointer);
        }
    }
}

/// Puts into `value` what only `preset` has; members that are `null` go.
fn fill(value: &mut Value, preset: Value) {
    let (Value::Object(own), Value::Object(given)) = (value, preset) else {
        return;
    };
    for (key, given) in given {
        match own.get_mut(&key) {
            Some(Value::Null) => {
                own.shift_remove(&key);
            }
            Some(own) => fill(own, given),
            None => {
                own.insert(key, given);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn what_the_case_has_stands_and_null_leaves_out() {
        let mut case =
            json!({"preset": "matia-gat-beam", "beam": {"length_m": 0.2}, "fluid": null, "tubes": {"radius_m": 2e-3}});
        apply(&mut case, &[]);
        assert_eq!(case["beam"]["length_m"], 0.2);
        assert_eq!(case["beam"]["height_m"], 0.0216);
        assert_eq!(case.get("fluid"), None);
        assert_eq!(case["bladders"]["permeability_m4"], 1.55e-12);
        assert_eq!(case["tubes"], json!({"length_m": 0.02, "radius_m": 2e-3}));
    }

    #[test]
    fn without_a_preset_nothing_changes() {
        let mut case = json!({"beam": {"length_m": 0.2}});
        apply(&mut case, &[]);
        assert_eq!(case, json!({"beam": {"length_m": 0.2}}));
    }
}
