//! Readable names of figures and of numbers of a case.

use super::units::suffixed;

/// Readable name of a figure, without units: `harvested energy, final` for `harvested_energy_j.final`.
pub fn figure_name(figure: &str) -> String {
    let part = |part: &str| suffixed(part).map_or(part, |(name, _)| name).replace('_', " ");
    figure.split('.').map(part).collect::<Vec<_>>().join(", ")
}

/// Endings of keys and their units, the longer ones first.
const ENDS: [(&str, &str); 40] = [
    ("m2_per_n_m", "m^2/(N m)"),
    ("n_m_s_rad", "N m s/rad"),
    ("m2_per_pa", "m^2/Pa"),
    ("m2_per_n", "m^2/N"),
    ("m3_s_pa", "m^3/(s Pa)"),
    ("m3_pa", "m^3/Pa"),
    ("pa_s_m3", "Pa s/m^3"),
    ("n_s2_m3", "N s^2/m^3"),
    ("n_s_m2", "N s/m^2"),
    ("n_s_m", "N s/m"),
    ("n_m2", "N/m^2"),
    ("n_m_rad", "N m/rad"),
    ("kg_m2", "kg m^2"),
    ("rad_s", "rad/s"),
    ("kg_m3", "kg/m^3"),
    ("m3_s", "m^3/s"),
    ("m2_s", "m^2/s"),
    ("m_s2", "m/s^2"),
    ("pa_s", "Pa s"),
    ("per_s", "1/s"),
    ("1_m", "1/m"),
    ("s_m", "s/m"),
    ("m_s", "m/s"),
    ("n_m", "N m"),
    ("kg_m", "kg/m"),
    ("n_s", "N s"),
    ("1_s", "1/s"),
    ("m4", "m^4"),
    ("m3", "m^3"),
    ("m2", "m^2"),
    ("hz", "Hz"),
    ("kg", "kg"),
    ("rad", "rad"),
    ("pa", "Pa"),
    ("c", "°C"),
    ("n", "N"),
    ("m", "m"),
    ("s", "s"),
    ("j", "J"),
    ("w", "W"),
];

/// Keys inside a quantity, whose numbers have the unit of the quantity.
const ALIKE: [&str; 16] = [
    "amplitude",
    "from",
    "to",
    "constant",
    "values",
    "coefficients",
    "tension",
    "compression",
    "opening",
    "closing",
    "sum",
    "start",
    "lowest",
    "highest",
    "output_below",
    "output_above",
];

/// Key without its unit, and the unit in the form of result columns; none without a unit.
pub fn key_unit(key: &str) -> Option<(&str, &'static str)> {
    let (end, unit) = ENDS.iter().find_map(|(end, unit)| {
        let before = key.strip_suffix(end)?;
        (before.is_empty() && end.len() > 2 || before.ends_with('_')).then_some((before, *unit))
    })?;
    // `_n_m` is a force per length or a stiffness unless it is a moment
    let unit = match unit {
        "N m" if end.starts_with("force") || end.contains("stiffness") => "N/m",
        unit => unit,
    };
    Some((end.trim_end_matches('_'), unit))
}

/// True if a key is the index of a list member.
fn is_index(key: &str) -> bool {
    !key.is_empty() && key.bytes().all(|b| b.is_ascii_digit())
}

/// Unit of a number of a case, in the form of result columns, by the key of its quantity: `m^3/(s Pa)`; `1` without a unit.
pub fn pointer_unit(pointer: &str) -> &'static str {
    let mut keys = pointer.rsplit('/').filter(|key| !is_index(key));
    let last = keys.next().unwrap_or_default();
    if let Some((_, unit)) = key_unit(last) {
        return unit;
    }
    if !(ALIKE.contains(&last) || pointer.ends_with(|sign: char| sign.is_ascii_digit())) {
        return "1";
    }
    // factors, such as those of profiles, are fractions of another quantity
    let above = keys.take_while(|key| !["profile", "chains", "links", "setpoint"].contains(key));
    above.filter_map(key_unit).next().map_or("1", |(_, unit)| unit)
}

/// Readable name of a number of a case, without units: `fluid: viscosity` for `/fluid/viscosity_pa_s`.
pub fn pointer_name(pointer: &str) -> String {
    let keys: Vec<&str> = pointer.split('/').skip(1).collect();
    let Some((last, before)) = keys.split_last() else {
        return pointer.into();
    };
    let from = before.iter().rposition(|key| !is_index(key)).unwrap_or(0);
    let part = |key: &&str| key_unit(key).map_or(*key, |(name, _)| name).replace('_', " ");
    let parent = before[from..].iter().map(part).collect::<Vec<_>>().join(" ");
    let own = part(last);
    match (parent.is_empty(), own.is_empty()) {
        (true, _) => own,
        (false, true) => parent,
        (false, false) => format!("{parent}: {own}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{figure_name, key_unit, pointer_name, pointer_unit};
    use crate::case::schema_of_resolved;
    use serde_json::Value;

    /// Goal: axes and titles show names, not pointers and keys.
    #[test]
    fn names_are_read_without_units() {
        assert_eq!(figure_name("harvested_energy_j.final"), "harvested energy, final");
        assert_eq!(
            figure_name("max_pressure_pa.window_max_abs"),
            "max pressure, window max abs"
        );
        assert_eq!(pointer_name("/fluid/viscosity_pa_s"), "fluid: viscosity");
        assert_eq!(pointer_name("/loads/0/force_n"), "loads 0: force");
        assert_eq!(
            pointer_name("/network/permeability_factor"),
            "network: permeability factor"
        );
    }

    /// Goal: axes have the units of their numbers.
    #[test]
    fn numbers_have_units() {
        for (pointer, name, unit) in [
            ("/network/turbines/0/conductance/m3_s_pa", "conductance", "m^3/(s Pa)"),
            (
                "/bladders/area_per_pressure_m2_per_pa",
                "bladders: area per pressure",
                "m^2/Pa",
            ),
            (
                "/bladders/area_per_force_m2_per_n/tension",
                "area per force: tension",
                "m^2/N",
            ),
            ("/attachments/0/stiffness_x_n_m", "attachments 0: stiffness x", "N/m"),
            ("/attachments/0/damping_x_n_s_m", "attachments 0: damping x", "N s/m"),
            ("/loads/0/force_x_n_m/signal/sine/amplitude", "sine: amplitude", "N/m"),
            ("/loads/0/force_x_n_m/profile/sine/amplitude", "sine: amplitude", "1"),
            ("/loads/0/force_x_n_m/signal/sine/frequency_hz", "sine: frequency", "Hz"),
            ("/ends/tip/free/moment_n_m", "free: moment", "N m"),
            ("/network/chains/0/ends/0/pressure_pa/ramp/to", "ramp: to", "Pa"),
            ("/network/chains/0/opening", "chains 0: opening", "1"),
            ("/network/permeability_factor", "network: permeability factor", "1"),
            ("/beam/young_modulus_pa", "beam: young modulus", "Pa"),
        ] {
            assert_eq!(
                (pointer_name(pointer).as_str(), pointer_unit(pointer)),
                (name, unit),
                "{pointer}"
            );
        }
    }

    /// Numbers of a schema: keys with the unit of their description.
    fn numbers(schema: &Value, out: &mut Vec<(String, String)>) {
        for (key, one) in schema["properties"].as_object().into_iter().flatten() {
            let about = one["description"].as_str().unwrap_or_default().replace("\\", "");
            let units = about.split('[').skip(1).filter_map(|part| part.split_once(']'));
            let unit = units
                .map(|(unit, _)| unit)
                .find(|unit| !unit.contains([',', '`']) && !unit.starts_with('0'));
            out.extend(unit.map(|unit| (key.clone(), unit.to_owned())));
        }
        match schema {
            Value::Object(all) => all.values().for_each(|one| numbers(one, out)),
            Value::Array(all) => all.iter().for_each(|one| numbers(one, out)),
            _ => {}
        }
    }

    /// Goal: every key of the schema ends with the unit of its description.
    #[test]
    fn units_of_keys_are_those_of_the_schema() {
        let mut all = vec![];
        numbers(schema_of_resolved(), &mut all);
        assert!(all.len() > 80, "{}", all.len());
        for (key, unit) in all {
            // keys inside one with a unit, and the name of a file
            if ["tension", "compression", "opening", "closing", "csv"].contains(&key.as_str()) {
                continue;
            }
            let found = key_unit(&key).map_or("1", |(_, unit)| unit);
            let unit = if unit == "C" { "°C" } else { &unit };
            assert_eq!(found, unit, "{key}");
        }
    }
}
