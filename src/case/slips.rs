//! Keys with the unit of another key: what was meant, and the number in the unit of the case.

use std::f64::consts::PI;

use serde_json::Value;

use super::wording::nearest;

/// Units as keys end with them, each with its name, the unit that cases have and how many of those it is; `mpa_s` before `mpa`.
const UNITS: [(&str, &str, &str, f64); 31] = [
    ("mpa_s", "mPa s", "pa_s", 1e-3),
    ("cp", "cP", "pa_s", 1e-3),
    ("ul_min", "uL/min", "m3_s", 1e-9 / 60.0),
    ("ml_min", "mL/min", "m3_s", 1e-6 / 60.0),
    ("l_min", "L/min", "m3_s", 1e-3 / 60.0),
    ("ul_s", "uL/s", "m3_s", 1e-9),
    ("ml_s", "mL/s", "m3_s", 1e-6),
    ("mm3_s", "mm^3/s", "m3_s", 1e-9),
    ("g_cm3", "g/cm^3", "kg_m3", 1e3),
    ("mm_s", "mm/s", "m_s", 1e-3),
    ("mm4", "mm^4", "m4", 1e-12),
    ("mm3", "mm^3", "m3", 1e-9),
    ("ml", "mL", "m3", 1e-6),
    ("ul", "uL", "m3", 1e-9),
    ("mm2", "mm^2", "m2", 1e-6),
    ("gpa", "GPa", "pa", 1e9),
    ("mpa", "MPa", "pa", 1e6),
    ("kpa", "kPa", "pa", 1e3),
    ("mbar", "mbar", "pa", 1e2),
    ("bar", "bar", "pa", 1e5),
    ("psi", "psi", "pa", 6_894.757_293_168_36),
    ("mm", "mm", "m", 1e-3),
    ("cm", "cm", "m", 1e-2),
    ("um", "um", "m", 1e-6),
    ("mn", "mN", "n", 1e-3),
    ("ms", "ms", "s", 1e-3),
    ("us", "us", "s", 1e-6),
    ("min", "min", "s", 60.0),
    ("khz", "kHz", "hz", 1e3),
    ("rpm", "rpm", "hz", 1.0 / 60.0),
    ("deg", "deg", "rad", PI / 180.0),
];

/// The key that one with another unit means, and what to write there.
pub fn unit<'n>(key: &str, value: &Value, known: impl Iterator<Item = &'n str> + Clone) -> Option<(String, String)> {
    let key = key.to_lowercase();
    UNITS.iter().find_map(|&(written, name, unit, size)| {
        let stem = key.strip_suffix(written)?.strip_suffix('_')?;
        let meant = format!("{stem}_{unit}");
        let alike = known.clone().filter(|name| unit_of(name, unit));
        let meant = nearest(&meant, alike)?;
        let hint = match value.as_f64() {
            Some(number) => format!(
                "write \"{meant}\": {}, which is {number} {name}",
                number_of(number * size)
            ),
            None => format!("numbers there are {} times those in {name}", number_of(size)),
        };
        Some((meant, hint))
    })
}

/// Whether a key ends with a unit as a word of its own.
fn unit_of(key: &str, unit: &str) -> bool {
    key.strip_suffix(unit).is_some_and(|stem| stem.ends_with('_'))
}

/// A number without the round-off of the product that gave it.
fn number_of(number: f64) -> String {
    let number = format!("{number:.12e}").parse().unwrap_or(number);
    match number.abs() {
        1e-4..1e6 | 0.0 => format!("{number}"),
        _ => format!("{number:e}"),
    }
}
