//! Words that people look for, and the keys that they mean.

/// A word or its beginning, and keys that have to do with it.
const MEANT: &[(&str, &[&str])] = &[
    (
        "resistance",
        &[
            "permeability_m4",
            "resistance_pa_s_m3",
            "conductance",
            "forward_conductance_m3_s_pa",
            "loss_coefficient",
        ],
    ),
    (
        "stiffness",
        &[
            "young_modulus_pa",
            "bending_stiffness_factor",
            "axial_stiffness_factor",
            "area_per_pressure_m2_per_pa",
        ],
    ),
    ("modulus", &["young_modulus_pa"]),
    ("young", &["young_modulus_pa"]),
    ("elasticity", &["young_modulus_pa", "viscoelasticity"]),
    ("compliance", &["area_per_pressure_m2_per_pa", "compliance_m3_pa"]),
    ("friction", &["permeability_m4", "contacts", "unsteady_friction"]),
    (
        "damping",
        &["damping", "viscoelasticity", "axial_time_s", "bending_time_s"],
    ),
    ("pump", &["pump", "pressure_pa", "flow_m3_s"]),
    ("syringe", &["volume_m3"]),
    ("valve", &["opening", "check_valve"]),
    ("pressure", &["pressure_pa"]),
    ("flow", &["flow_m3_s"]),
    ("inflow", &["flow_m3_s"]),
    ("volume", &["volume_m3"]),
    ("force", &["loads", "force_x_n", "force_x_n_m", "attachments"]),
    ("load", &["loads", "attachments"]),
    ("point_load", &["attachments", "force_x_n"]),
    ("weight", &["gravity", "attachments"]),
    ("mass", &["attachments", "mass_kg", "density_kg_m3"]),
    ("spring", &["attachments", "stiffness_x_n_m"]),
    ("wall", &["contacts"]),
    ("obstacle", &["contacts"]),
    ("clamp", &["clamped", "ends"]),
    ("boundary", &["ends"]),
    ("support", &["ends", "attachments"]),
    ("shaking", &["u1_m", "u3_m", "clamped"]),
    ("excitation", &["u1_m", "u3_m", "loads"]),
    ("frequency", &["frequency_hz"]),
    ("amplitude", &["amplitude"]),
    ("signal", &["sine", "ramp", "table"]),
    ("material", &["young_modulus_pa", "density_kg_m3", "preset"]),
    ("poisson", &["young_modulus_pa", "section"]),
    ("viscosity", &["viscosity_pa_s"]),
    ("density", &["density_kg_m3"]),
    ("length", &["length_m"]),
    ("thickness", &["height_m"]),
    ("height", &["height_m"]),
    ("width", &["width_m"]),
    ("diameter", &["radius_m"]),
    ("radius", &["radius_m"]),
    ("duration", &["end_s", "duration_s"]),
    ("tolerance", &["rtol"]),
    ("accuracy", &["rtol", "mesh"]),
    ("step", &["output_interval_s", "ramp", "sigmoid"]),
    ("timestep", &["output_interval_s", "max_step_s"]),
    ("resolution", &["cells_per_segment", "cells_per_bladder"]),
    ("element", &["cells_per_segment", "segments"]),
    ("node", &["cells_per_segment", "segments"]),
    ("sensor", &["probes"]),
    ("gauge", &["probes"]),
    ("channel", &["bladders", "tubes"]),
    ("chamber", &["bladders"]),
    ("pipe", &["tubes"]),
    ("tank", &["accumulators"]),
    ("reservoir", &["accumulators", "pressure_pa"]),
    ("water", &["fluid", "surroundings"]),
    ("air", &["fluid", "compressibility"]),
    ("gas", &["fluid", "compressibility"]),
    ("harvester", &["turbines"]),
    ("generator", &["turbines"]),
    ("hinge", &["pinned", "ends"]),
    ("wiring", &["network", "chains"]),
    ("coefficient", &["bladders", "section"]),
    ("bending", &["bending_stiffness_factor", "height_m"]),
    ("serpentine", &["chains", "bladders"]),
    ("torque", &["moment_x_n", "moment_z_n", "ends"]),
    ("moment", &["moment_x_n", "moment_z_n", "ends"]),
];

/// Words that are no keys, and where what they mean is found.
const ELSEWHERE: &[(&str, &str)] = &[
    (
        "frequency",
        "slcbeam modes tells natural frequencies, docs/modes.md; what a drive does near them, docs/frequency-response.md",
    ),
    ("eigenvalue", "slcbeam modes, docs/modes.md"),
    ("eigenfrequency", "slcbeam modes, docs/modes.md"),
    ("resonance", "slcbeam modes and docs/frequency-response.md"),
    ("damping", "slcbeam modes tells damping ratios, docs/modes.md"),
    (
        "buckling",
        "slcbeam equilibrium follows loads to where a state gives way, docs/equilibrium.md",
    ),
    (
        "stability",
        "docs/stability.md; of cycles slcbeam floquet, docs/stability-maps.md",
    ),
    ("multiplier", "slcbeam floquet, docs/stability-maps.md"),
    ("uncertainty", "--uncertain of a command, docs/uncertainty.md"),
    ("sensitivity", "--sensitivity of a command, docs/sensitivity.md"),
    (
        "rise_time",
        "/step_response, and rise_time_s in summary.json, docs/data.md",
    ),
    (
        "pressure_drop",
        "tube_resistance_pa_s_m3 times the flow; docs/model.md, section 6",
    ),
    ("calibration", "slcbeam fit, docs/fit.md"),
    ("optimisation", "slcbeam optimize, docs/optimize.md"),
    ("optimization", "slcbeam optimize, docs/optimize.md"),
    (
        "harvest",
        "turbines; slcbeam periodic tells energy and power of a cycle, docs/tour-harvester.md",
    ),
    (
        "convergence",
        "--accuracy of a command, and slcbeam study, docs/accuracy.md",
    ),
];

/// Where what a word means is found, if it is no key.
pub fn elsewhere(word: &str) -> Vec<&'static str> {
    let pieces = pieces(word);
    let own = |one: &&(&str, &str)| pieces.iter().any(|piece| piece == one.0);
    ELSEWHERE.iter().filter(own).map(|one| one.1).collect()
}

/// A word as the tables have it, and where it is of several, each of these.
fn pieces(word: &str) -> Vec<String> {
    let whole = word.to_lowercase().replace([' ', '-'], "_");
    let plain = |text: &str| {
        let text = text
            .strip_suffix("'s")
            .or_else(|| text.strip_suffix("’s"))
            .unwrap_or(text);
        text.strip_suffix('s').unwrap_or(text).to_owned()
    };
    let parts = whole.split('_').map(plain);
    let mut all = vec![whole.clone(), plain(&whole)];
    all.extend(parts);
    all
}

/// Keys that a word means; of several words the whole, or else what each means.
pub fn of(word: &str) -> Vec<&'static str> {
    let keys = |piece: &String| {
        MEANT
            .iter()
            .filter(|one| one.0 == *piece)
            .flat_map(|one| one.1.iter().copied())
            .collect::<Vec<_>>()
    };
    let pieces = pieces(word);
    let (whole, parts) = pieces.split_at(2);
    let mut own: Vec<&'static str> = whole.iter().flat_map(keys).collect();
    own.dedup();
    if !own.is_empty() {
        return own;
    }
    parts.iter().flat_map(keys).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::meanings;

    /// Goal: what a word leads to is a key of a case, and no word is one.
    #[test]
    fn words_lead_to_keys() {
        let all = meanings();
        let known = |name: &str| all.iter().any(|meaning| meaning.name == name);
        for (word, keys) in MEANT {
            for key in *keys {
                assert!(known(key), "{word}: {key}");
            }
        }
    }
}
