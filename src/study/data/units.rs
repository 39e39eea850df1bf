//! Units of a laboratory and what each is in SI units; how headings tell theirs: `angle_deg`, `pressure [kPa]`, `volume (ml)`.

use std::f64::consts::PI;

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The SI unit of the same dimension, as columns of results have it; `1` where there is none.
    pub si: &'static str,
    /// As a laboratory writes it.
    pub name: &'static str,
    /// How many of the SI unit it is.
    pub scale: f64,
}

impl Unit {
    /// Whether a text names it, with or without the signs of powers.
    pub fn is_written(&self, text: &str) -> bool {
        self.name == text || self.name.replace('^', "") == text
    }
}

/// SI unit, unit, how many of the one the other is.
const TABLE: [(&str, &str, f64); 60] = [
    ("m", "m", 1.0),
    ("m", "cm", 1e-2),
    ("m", "mm", 1e-3),
    ("m", "um", 1e-6),
    ("s", "s", 1.0),
    ("s", "ms", 1e-3),
    ("s", "us", 1e-6),
    ("s", "min", 60.0),
    ("s", "h", 3600.0),
    ("Pa", "Pa", 1.0),
    ("Pa", "kPa", 1e3),
    ("Pa", "MPa", 1e6),
    ("Pa", "mbar", 1e2),
    ("Pa", "hPa", 1e2),
    ("Pa", "bar", 1e5),
    ("Pa", "psi", 6_894.757_293),
    ("rad", "rad", 1.0),
    ("rad", "mrad", 1e-3),
    ("rad", "deg", PI / 180.0),
    ("N", "N", 1.0),
    ("N", "mN", 1e-3),
    ("N", "kN", 1e3),
    ("N m", "N m", 1.0),
    ("N m", "mN m", 1e-3),
    ("N m", "N cm", 1e-2),
    ("N m", "N mm", 1e-3),
    ("N/m", "N/m", 1.0),
    ("N/m", "N/mm", 1e3),
    ("J", "J", 1.0),
    ("J", "mJ", 1e-3),
    ("J", "uJ", 1e-6),
    ("W", "W", 1.0),
    ("W", "mW", 1e-3),
    ("W", "uW", 1e-6),
    ("m^3", "m^3", 1.0),
    ("m^3", "l", 1e-3),
    ("m^3", "ml", 1e-6),
    ("m^3", "ul", 1e-9),
    ("m^3", "cm^3", 1e-6),
    ("m^3", "mm^3", 1e-9),
    ("m^3/s", "m^3/s", 1.0),
    ("m^3/s", "l/min", 1e-3 / 60.0),
    ("m^3/s", "ml/s", 1e-6),
    ("m^3/s", "ml/min", 1e-6 / 60.0),
    ("m^3/s", "ul/s", 1e-9),
    ("m^3/s", "ul/min", 1e-9 / 60.0),
    ("1/m", "1/m", 1.0),
    ("1/m", "1/cm", 1e2),
    ("1/m", "1/mm", 1e3),
    ("m/s", "m/s", 1.0),
    ("m/s", "mm/s", 1e-3),
    ("m/s^2", "m/s^2", 1.0),
    ("rad/s", "rad/s", 1.0),
    ("Hz", "Hz", 1.0),
    ("kg", "kg", 1.0),
    ("kg", "g", 1e-3),
    ("Pa s", "Pa s", 1.0),
    ("Pa s", "mPa s", 1e-3),
    ("1", "%", 1e-2),
    ("1", "1", 1.0),
];

/// All of them.
fn all() -> impl Iterator<Item = Unit> {
    TABLE.into_iter().map(|(si, name, scale)| Unit { si, name, scale })
}

/// Those of one dimension, by its SI unit.
pub fn of_dimension(si: &str) -> impl Iterator<Item = Unit> {
    all().filter(move |unit| unit.si == si)
}

/// The unit of a text between brackets.
pub fn bracketed(text: &str) -> Option<Unit> {
    let plain = text
        .trim()
        .replace(['µ', 'μ'], "u")
        .replace('²', "^2")
        .replace('³', "^3");
    let plain = match plain.as_str() {
        "°" => "deg",
        "" | "-" | "–" => "1",
        other => other,
    };
    all().find(|unit| unit.is_written(plain))
}

/// A name as keys have it without the unit that it ends with, and that unit: `angle`, degrees of `angle_deg`.
pub fn suffixed(name: &str) -> Option<(&str, Unit)> {
    let lower = name.to_ascii_lowercase();
    let ends = all()
        .filter(|unit| !["1", "l", "g", "h"].contains(&unit.name))
        .flat_map(|unit| {
            let word = unit
                .name
                .to_ascii_lowercase()
                .replace('^', "")
                .replace(' ', "_")
                .replace('%', "percent");
            let per = word
                .strip_prefix("1/")
                .map_or_else(|| word.replace('/', "_per_"), |under| format!("per_{under}"));
            // `_n_mm` is a moment
            let short = if unit.name.starts_with("N/") {
                per.clone()
            } else {
                word.replace("1/", "per_").replace('/', "_")
            };
            [per, short].map(|end| (unit, format!("_{end}")))
        });
    let found = ends.filter(|(_, end)| lower.ends_with(end.as_str()) && lower.len() > end.len());
    let (unit, end) = found.max_by_key(|(_, end)| end.len())?;
    let rest = name.get(..name.len() - end.len())?;
    // `_m2_per_pa` is no pressure
    (!rest.to_ascii_lowercase().ends_with("_per")).then_some((rest, unit))
}

/// The unit in which the numbers below a JSON pointer are, as far as its keys tell.
pub fn of_pointer(pointer: &str) -> Option<Unit> {
    pointer.rsplit('/').find_map(|key| Some(suffixed(key)?.1))
}

#[cfg(test)]
mod tests {
    use super::{bracketed, of_pointer, suffixed};

    #[test]
    fn headings_tell_their_units() {
        for (name, rest, unit, scale) in [
            ("angle_deg", "angle", "rad", std::f64::consts::PI / 180.0),
            ("tip_u1_m", "tip_u1", "m", 1.0),
            ("pressure_kPa", "pressure", "Pa", 1e3),
            ("moment_n_mm", "moment", "N m", 1e-3),
            ("flow_ml_min", "flow", "m^3/s", 1e-6 / 60.0),
            ("flow_m3_per_s", "flow", "m^3/s", 1.0),
            ("curvature_per_m", "curvature", "1/m", 1.0),
        ] {
            let (left, found) = suffixed(name).expect(name);
            assert_eq!((left, found.si, found.scale), (rest, unit, scale), "{name}");
        }
        for name in ["angle", "u1", "deg", "area_m2_per_pa", "first_l"] {
            assert!(suffixed(name).is_none(), "{name}");
        }
        assert_eq!(bracketed("°").map(|unit| unit.si), Some("rad"));
        assert_eq!(bracketed("mm3").map(|unit| unit.scale), Some(1e-9));
        assert_eq!(bracketed("furlong"), None);
        assert_eq!(
            of_pointer("/network/chains/0/ends/0/pressure_pa").map(|u| u.si),
            Some("Pa")
        );
        assert_eq!(of_pointer("/ends/tip/free/force_x_n").map(|u| u.si), Some("N"));
    }
}
