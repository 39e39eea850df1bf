//! Units of figures, by their names.

/// Suffixes of names with their units, the longer ones first.
const ENDS: [(&str, &str); 21] = [
    ("_frequency_hz", "Hz"),
    ("_bound_hz", "Hz"),
    ("_per_s", "1/s"),
    ("_m^3/s", "m^3/s"),
    ("_m3_s", "m^3/s"),
    ("_m3_per_s", "m^3/s"),
    ("_m_per_s", "m/s"),
    ("_m3", "m^3"),
    ("_per_m", "1/m"),
    ("_n_m", "N m"),
    ("_N m", "N m"),
    ("_rad", "rad"),
    ("_pa", "Pa"),
    ("_hz", "Hz"),
    ("_kg", "kg"),
    ("_j", "J"),
    ("_w", "W"),
    ("_n", "N"),
    ("_N", "N"),
    ("_m", "m"),
    ("_s", "s"),
];

/// Returns the unit with which the name of a figure ends, that of its quantity before its own; `1` if there is none.
pub fn unit(name: &str) -> &'static str {
    let (quantity, figure) = name.split_once('.').unwrap_or((name, ""));
    if figure.ends_with("error") || name.ends_with("_relative") {
        return "1";
    }
    if figure.ends_with("_at_s") {
        return "s";
    }
    if figure.ends_with("_power_w") {
        return "W";
    }
    // of a response: peaks and values at frequencies
    match figure.rsplit_once('.') {
        Some((_, "amplitude")) => return "output/input",
        Some((_, "phase_deg")) => return "deg",
        Some((_, "frequency_hz")) => return "Hz",
        Some((_, "damping_ratio")) => return "1",
        _ => {}
    }
    let of = |text: &str| ENDS.iter().find(|(end, _)| text.ends_with(end)).map(|(_, unit)| *unit);
    let whole = format!("_{figure}");
    of(quantity).or_else(|| of(&whole)).unwrap_or("1")
}

#[cfg(test)]
mod tests {
    use super::unit;

    #[test]
    fn names_end_with_their_units() {
        for (name, of) in [
            ("tip_u1_m.final", "m"),
            ("tip_u1_m.max_abs_at_s", "s"),
            ("tip_u1_m.error", "1"),
            ("harvested_power_w.mean", "W"),
            ("input_energy_j.window_power_w", "W"),
            ("mode_1.frequency_hz", "Hz"),
            ("mode_1.damping_ratio", "1"),
            ("mode_1.growth_per_s", "1/s"),
            ("max_pressure_pa.window_rms", "Pa"),
            ("middle_curvature_per_m.max_abs", "1/m"),
            ("middle_moment_n_m.final", "N m"),
            ("reaction_root_x_N", "N"),
            ("reaction_root_couple_N m", "N m"),
            ("energy_residual_relative", "1"),
            ("period_s", "s"),
            ("stable", "1"),
            ("tip_u1_m.peak_1.frequency_hz", "Hz"),
            ("tip_u1_m.peak_2.damping_ratio", "1"),
            ("tip_u1_m.at_12.5_hz.amplitude", "output/input"),
            ("tip_u1_m.at_12.5_hz.amplitude.error", "1"),
            ("tip_u1_m.at_12.5_hz.phase_deg", "deg"),
        ] {
            assert_eq!(unit(name), of, "{name}");
        }
    }
}
