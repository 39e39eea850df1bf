//! Values from presets: they apply wherever the case gives none of its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::faults::{SetValue, is_below};
use super::sets;

/// Sections that a preset contains.
pub const SECTIONS: [&str; 4] = ["beam", "fluid", "bladders", "tubes"];

const MATIA_GAT_BEAM: &str = include_str!("presets/matia-gat-beam.json");

/// Material and sizes to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The beam of the paper (section 3.1): 100 x 21.6 x 50 mm of silicone (2 MPa, 950 kg/m^3) with two rows of ten bladders and
    /// tubes of 2 mm, filled with water. Its coefficients follow modulus and sizes of the case. The coupling is the reciprocal one.
    MatiaGatBeam,
}

impl Preset {
    /// Name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::MatiaGatBeam => "matia-gat-beam",
        }
    }

    /// Values of the preset, in the form of a case.
    pub fn values(self) -> Value {
        let text = match self {
            Self::MatiaGatBeam => MATIA_GAT_BEAM,
        };
        serde_json::from_str(text).unwrap_or_default()
    }
}

/// Adds missing values to a case: those of its section and its fluid (`nearer`) first, then those of its preset. Objects are merged, other
/// values of the case are kept, and `null` removes a value. A cross-section in the case removes the permeability of section and preset.
/// [`super::scaling`] then scales the coefficients to the case's modulus and dimensions.
pub fn apply(case: &mut Value, sets: &[SetValue], nearer: impl IntoIterator<Item = Value>) {
    // A misspelled name is reported when the case is checked; here it counts as valid.
    let preset = case.get("preset").map(|_| Preset::MatiaGatBeam.values());
    let Some(mut brought) = nearer.into_iter().chain(preset).reduce(|mut nearer, further| {
        fill(&mut nearer, further);
        nearer
    }) else {
        without_nulls(case);
        return;
    };
    if case.pointer("/bladders/cross_section").is_some_and(Value::is_object) {
        sets::remove(&mut brought, "/bladders/permeability_m4");
    }
    fill(case, brought);
    for (i, set) in sets.iter().enumerate().filter(|(_, set)| set.node.is_none()) {
        let given_again = sets[i + 1..].iter().any(|later| is_below(&later.pointer, &set.pointer));
        if !given_again {
            sets::remove(case, &set.pointer);
        }
    }
    without_nulls(case);
}

/// Removes permeabilities that are `null`: these are computed from the cross-section.
fn without_nulls(case: &mut Value) {
    let single = case
        .pointer("/network/tubes")
        .and_then(Value::as_array)
        .map_or(0, Vec::len);
    let single = (0..single).map(|i| format!("/network/tubes/{i}/permeability_m4"));
    let shared = ["/bladders/permeability_m4", "/tubes/permeability_m4"].map(str::to_owned);
    for pointer in shared.into_iter().chain(single) {
        if case.pointer(&pointer).is_some_and(Value::is_null) {
            sets::remove(case, &pointer);
        }
    }
}

/// Adds to `value` the members that only `other` has; removes members that are `null`.
fn fill(value: &mut Value, other: Value) {
    let (Value::Object(own), Value::Object(given)) = (value, other) else {
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
        apply(&mut case, &[], []);
        assert_eq!(case["beam"]["length_m"], 0.2);
        assert_eq!(case["beam"]["height_m"], 0.0216);
        assert_eq!(case.get("fluid"), None);
        assert_eq!(case["bladders"]["permeability_m4"], 1.55e-12);
        let tubes = json!({"length_m": 0.02, "radius_m": 2e-3, "permeability_m4": 6.72e-13});
        assert_eq!(case["tubes"], tubes, "sizes take no coefficient away");
    }

    #[test]
    fn a_permeability_is_computed_where_it_is_null_or_a_section_is_given() {
        let mut case = json!({"preset": "matia-gat-beam", "bladders": {"cross_section": {"circle": {"radius_m": 4e-3}}},
            "tubes": {"permeability_m4": null}, "network": {"tubes": [{"permeability_m4": null}]}});
        apply(&mut case, &[], []);
        for section in ["bladders", "tubes"] {
            assert_eq!(case[section].get("permeability_m4"), None, "{section}");
        }
        assert_eq!(case["network"]["tubes"], json!([{}]));
    }

    #[test]
    fn without_a_preset_nothing_changes() {
        let mut case = json!({"beam": {"length_m": 0.2}});
        apply(&mut case, &[], []);
        assert_eq!(case, json!({"beam": {"length_m": 0.2}}));
    }
}
