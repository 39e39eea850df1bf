//! Words that users search for, and the keys that they mean.

/// A word, and the keys related to it.
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
    ("youngs_modulus", &["young_modulus_pa"]),
    ("elastic_modulus", &["young_modulus_pa"]),
    ("dynamic_viscosity", &["viscosity_pa_s"]),
    ("depth", &["height_m"]),
    ("freq", &["frequency_hz"]),
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
    ("payload", &["attachments", "mass_kg"]),
    ("spring", &["attachments", "stiffness_x_n_m"]),
    ("rotation", &["rotating_frame", "angular_velocity_rad_s", "slope_rad"]),
    ("omega", &["angular_velocity_rad_s", "frequency_hz"]),
    ("rotor", &["rotating_frame"]),
    ("spin", &["rotating_frame", "angular_velocity_rad_s"]),
    ("centrifugal", &["rotating_frame"]),
    ("coriolis", &["rotating_frame"]),
    ("wall", &["contacts"]),
    ("obstacle", &["contacts"]),
    ("disc", &["contacts"]),
    ("cylinder", &["contacts"]),
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
    ("t_end", &["end_s"]),
    ("tend", &["end_s"]),
    ("end_time", &["end_s"]),
    ("stop_time", &["end_s"]),
    ("final_time", &["end_s"]),
    ("tolerance", &["rtol"]),
    ("tol", &["rtol"]),
    ("reltol", &["rtol"]),
    ("relative_tolerance", &["rtol"]),
    ("sampling_interval", &["output_interval_s"]),
    ("sample_interval", &["output_interval_s"]),
    ("dt_out", &["output_interval_s"]),
    ("accuracy", &["rtol", "mesh"]),
    ("step", &["output_interval_s", "ramp", "sigmoid"]),
    ("timestep", &["output_interval_s", "max_step_s"]),
    ("resolution", &["cells_per_segment", "cells_per_bladder"]),
    ("element", &["cells_per_segment", "segments"]),
    ("node", &["cells_per_segment", "segments"]),
    ("cell", &["cells_per_segment", "cells_per_bladder"]),
    ("n_elements", &["cells_per_segment", "segments"]),
    ("num_elements", &["cells_per_segment", "segments"]),
    ("number_of_elements", &["cells_per_segment", "segments"]),
    ("n_nodes", &["cells_per_segment", "segments"]),
    ("n_cells", &["cells_per_segment", "cells_per_bladder"]),
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

/// Words that are not keys, and the places of their subjects.
const ELSEWHERE: &[(&str, &str)] = &[
    (
        "frequency",
        "slcbeam modes computes natural frequencies, docs/modes.md; response to a drive near them: docs/frequency-response.md",
    ),
    ("eigenvalue", "slcbeam modes, docs/modes.md"),
    ("eigenfrequency", "slcbeam modes, docs/modes.md"),
    ("resonance", "slcbeam modes and docs/frequency-response.md"),
    ("damping", "slcbeam modes computes damping ratios, docs/modes.md"),
    (
        "buckling",
        "slcbeam equilibrium follows loads to a critical point, docs/equilibrium.md",
    ),
    (
        "stability",
        "docs/stability.md; for cycles slcbeam floquet, docs/stability-maps.md",
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
        "turbines; slcbeam periodic computes energy and power of a cycle, docs/tour-harvester.md",
    ),
    (
        "convergence",
        "--accuracy of a command, and slcbeam study, docs/accuracy.md",
    ),
];

/// Places of the subject of a word that is not a key.
pub fn elsewhere(word: &str) -> Vec<&'static str> {
    let pieces = pieces(word);
    let own = |one: &&(&str, &str)| pieces.iter().any(|piece| piece == one.0);
    ELSEWHERE.iter().filter(own).map(|one| one.1).collect()
}

/// Forms of a word as in the tables: the whole text, and each of its words.
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

/// Symbols that users write for keys; in a result they may mean more.
const SYMBOLS: &[(&str, &[&str])] = &[
    ("e", &["young_modulus_pa"]),
    ("ei", &["bending_stiffness_factor"]),
    ("ea", &["axial_stiffness_factor"]),
    ("rho", &["density_kg_m3"]),
    ("eta", &["viscosity_pa_s"]),
    ("mu", &["viscosity_pa_s"]),
    ("b", &["width_m"]),
    ("h", &["height_m"]),
    ("l", &["length_m"]),
    ("r", &["radius_m"]),
    ("d", &["radius_m"]),
    ("f", &["frequency_hz"]),
    ("p", &["pressure_pa"]),
    ("q", &["flow_m3_s"]),
];

/// Words of other programs and textbooks for which a case has no key, and the alternative.
const INSTEAD: &[(&[&str], &str)] = &[
    (
        &["poisson_ratio", "poissons_ratio", "poisson", "nu"],
        "a beam has no Poisson's ratio: /beam/shear_stiffness_n gives the shear stiffness; a section by its geometry \
         has /section/material/poisson_ratio",
    ),
    (
        &["dt", "time_step", "timestep", "step_size", "delta_t"],
        "steps follow from the tolerance, /solver/rtol; /time/output_interval_s is the interval of output, and /solver/max_step_s is the longest step",
    ),
    (
        &["damping_ratio", "zeta", "xi", "damping_factor"],
        "damping is a time: for a damping ratio zeta of the mode at f Hz, /beam/damping/bending_time_s is zeta/(pi f)",
    ),
    (
        &["rayleigh_alpha", "alpha", "mass_damping"],
        "mass-proportional damping is a drag: /beam/damping/drag_n_s_m2 is alpha times the mass per length",
    ),
    (
        &["rayleigh_beta", "beta", "stiffness_damping"],
        "stiffness-proportional damping is a time: /beam/damping/bending_time_s and axial_time_s are beta",
    ),
    (
        &["shear_modulus", "g_modulus"],
        "/beam/shear_stiffness_n gives the shear stiffness: for a full rectangle, 5/6 of its area times the shear \
         modulus",
    ),
    (
        &["second_moment", "second_moment_of_area", "area_moment"],
        "it follows from /beam/height_m and width_m; /beam/bending_stiffness_factor multiplies it",
    ),
    (
        &["cosine", "cos"],
        "a cosine in time is a sine with \"phase_rad\": 1.5707963 (a quarter of a turn)",
    ),
    (
        &["repeats", "periodic", "loop", "cyclic"],
        "\"repeat\": true in a table repeats it for ever, with the time from its first point to its last as period",
    ),
    (
        &["beams", "rods"],
        "a case has one beam, /beam: give each beam a case of its own; model another body as a load, an end or an \
         attachment",
    ),
    (
        &[
            "taper",
            "tapered",
            "graded",
            "grading",
            "functionally_graded",
            "layers",
            "sections",
            "stations",
        ],
        "/spans give parts of the beam their own sizes, material and bladders: \"spans\": [{\"length_m\": 0.02, \"beam\": \
         {\"young_modulus_pa\": 1e7}}, {}]",
    ),
    (
        &["atol", "abstol", "absolute_tolerance"],
        "there is one tolerance, /solver/rtol, relative to the scale of each unknown",
    ),
];

/// Alternative to a key of this name, if a case has no such key.
pub fn instead(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase();
    let (_, said) = INSTEAD.iter().find(|(words, _)| words.contains(&word.as_str()))?;
    Some(said)
}

/// Keys that a symbol may mean.
pub fn of_symbol(symbol: &str) -> Vec<&'static str> {
    let symbol = symbol.to_lowercase();
    let own = SYMBOLS.iter().filter(|one| one.0 == symbol);
    own.flat_map(|one| one.1.iter().copied()).collect()
}

/// Keys that a text means; if it means none as a whole, those of each of its words.
pub fn keys_meant_by(word: &str) -> Vec<&'static str> {
    let own = of_whole(word);
    if !own.is_empty() {
        return own;
    }
    unique(pieces(word).iter().flat_map(keys))
}

fn unique(keys: impl Iterator<Item = &'static str>) -> Vec<&'static str> {
    keys.fold(vec![], |mut all, key| {
        if !all.contains(&key) {
            all.push(key);
        }
        all
    })
}

/// Keys that a text means as a whole; spaces and `_` are equivalent.
pub fn of_whole(word: &str) -> Vec<&'static str> {
    unique(pieces(word).iter().take(2).flat_map(keys))
}

fn keys(piece: &String) -> impl Iterator<Item = &'static str> + use<'_> {
    let own = MEANT.iter().filter(move |one| one.0 == *piece);
    own.flat_map(|one| one.1.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::meanings;

    /// Goal: every word leads to existing keys of a case.
    #[test]
    fn words_lead_to_keys() {
        let all = meanings();
        let known = |name: &str| all.iter().any(|meaning| meaning.name == name);
        for (_, said) in super::INSTEAD {
            let pointers = said.split([' ', ',', ':', ';']).filter(|word| word.starts_with('/'));
            for pointer in pointers {
                let key = pointer.rsplit('/').next().unwrap_or_default();
                assert!(known(key), "{pointer}");
            }
        }
        for (word, keys) in MEANT.iter().chain(SYMBOLS) {
            for key in *keys {
                assert!(known(key), "{word}: {key}");
            }
        }
    }
}
