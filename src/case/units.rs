//! Laboratory units and their factors to SI units; units at the end of names: `angle_deg`, `flow_ml_min`.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The SI unit of the same dimension, in the form of result columns; `1` without a dimension.
    pub si: &'static str,
    /// Usual form in a laboratory.
    pub name: &'static str,
    /// Factor to the SI unit.
    pub scale: f64,
}

impl Unit {
    /// Ending of keys of a case with its SI unit: `m3_s`.
    pub fn key(&self) -> String {
        let key = self.si.to_lowercase().replace('^', "").replace([' ', '/'], "_");
        key.trim_start_matches('_').to_owned()
    }

    /// True if a text names the unit, with or without the signs of powers.
    pub fn is_written(&self, text: &str) -> bool {
        self.name == text || self.name.replace('^', "") == text
    }
}

/// SI unit, unit, factor to the SI unit.
const TABLE: [(&str, &str, f64); 79] = [
    ("m", "m", 1.0),
    ("m", "cm", 1e-2),
    ("m", "mm", 1e-3),
    ("m", "um", 1e-6),
    ("m^2", "m^2", 1.0),
    ("m^2", "cm^2", 1e-4),
    ("m^2", "mm^2", 1e-6),
    ("m^4", "m^4", 1.0),
    ("m^4", "mm^4", 1e-12),
    ("s", "s", 1.0),
    ("s", "ms", 1e-3),
    ("s", "us", 1e-6),
    ("s", "min", 60.0),
    ("s", "h", 3600.0),
    ("Pa", "Pa", 1.0),
    ("Pa", "kPa", 1e3),
    ("Pa", "MPa", 1e6),
    ("Pa", "GPa", 1e9),
    ("Pa", "mbar", 1e2),
    ("Pa", "hPa", 1e2),
    ("Pa", "bar", 1e5),
    ("Pa", "psi", 6_894.757_293_168_36),
    ("Pa", "mmHg", 133.322_387_415),
    ("Pa", "torr", 101_325.0 / 760.0),
    ("Pa", "cmH2O", 98.066_5),
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
    ("m^3/s", "mm^3/s", 1e-9),
    ("m^3/s", "l/min", 1e-3 / 60.0),
    ("m^3/s", "ml/s", 1e-6),
    ("m^3/s", "ml/min", 1e-6 / 60.0),
    ("m^3/s", "ml/h", 1e-6 / 3600.0),
    ("m^3/s", "ul/s", 1e-9),
    ("m^3/s", "ul/min", 1e-9 / 60.0),
    ("m^3/s", "ul/h", 1e-9 / 3600.0),
    ("1/m", "1/m", 1.0),
    ("1/m", "1/cm", 1e2),
    ("1/m", "1/mm", 1e3),
    ("m/s", "m/s", 1.0),
    ("m/s", "mm/s", 1e-3),
    ("m/s^2", "m/s^2", 1.0),
    ("rad/s", "rad/s", 1.0),
    ("Hz", "Hz", 1.0),
    ("Hz", "kHz", 1e3),
    ("Hz", "rpm", 1.0 / 60.0),
    ("kg", "kg", 1.0),
    ("kg", "g", 1e-3),
    ("kg/m", "kg/m", 1.0),
    ("kg/m^3", "kg/m^3", 1.0),
    ("kg/m^3", "g/cm^3", 1e3),
    ("Pa s", "Pa s", 1.0),
    ("Pa s", "mPa s", 1e-3),
    ("Pa s", "cP", 1e-3),
    ("1", "%", 1e-2),
    ("1", "1", 1.0),
    ("1/s", "1/s", 1.0),
];

/// Words that are clearly units, but not in the table: a name that ends with one has an unknown unit.
#[rustfmt::skip]
const FOREIGN: [&str; 76] = [
    "inch", "inches", "ft", "yd", "mils", "thou", "nm", "km", "dm", "meter", "meters", "metre", "metres",
    "millimeter", "millimeters", "millimetre", "millimetres", "micron", "microns", "sec", "secs", "msec",
    "usec", "minute", "minutes", "hour", "hours", "hr", "hrs", "ns", "atm", "cmhg", "inhg", "mtorr",
    "mmh2o", "inh2o", "mh2o", "ksi", "psf", "psia", "psig", "barg", "bara", "pascal", "pascals", "degree", "degrees", "radian",
    "radians", "arcmin", "lbf", "lb", "lbs", "kgf", "gf", "ozf", "oz", "dyn", "dyne", "newton", "newtons", "liter", "liters",
    "litre", "litres", "cc", "nl", "dl", "lpm", "slpm", "sccm", "gpm", "cst", "poise", "mg", "kj",
];

/// Words that are units of one dimension, and otherwise may be names: an inlet, a foot, the second of two.
const ELSE_NAMES: [(&str, &str); 6] = [
    ("in", "m"),
    ("foot", "m"),
    ("feet", "m"),
    ("mil", "m"),
    ("second", "s"),
    ("seconds", "s"),
];

/// Prefixes of spelled-out units.
const PREFIXES: [&str; 6] = ["nano", "micro", "milli", "centi", "kilo", "mega"];

/// Beginnings of longer units, such as N s/m, Pa s/m^3 and m^2/Pa, of which the table has only the end.
const BEGUN: [&str; 14] = [
    "kg", "pa", "kpa", "mpa", "gpa", "m2", "m3", "mm2", "mm3", "n_s", "n_m", "pa_s", "mpa_s", "per",
];

/// All units of the table.
pub(super) fn all() -> impl Iterator<Item = Unit> {
    TABLE.into_iter().map(|(si, name, scale)| Unit { si, name, scale })
}

/// Units of one dimension, by its SI unit.
pub fn of_dimension(si: &str) -> impl Iterator<Item = Unit> {
    all().filter(move |unit| unit.si == si)
}

/// Unit of a text between brackets.
pub fn bracketed(text: &str) -> Option<Unit> {
    let plain = text
        .trim()
        .replace(['µ', 'μ'], "u")
        .replace('²', "^2")
        .replace('³', "^3");
    // a liter may have a capital letter, which no other unit has
    let plain = plain.replace('L', "l");
    let plain = match plain.as_str() {
        "°" => "deg",
        "" | "-" | "–" => "1",
        "Torr" => "torr",
        // "in ms" is ms; "in" alone is not an inch
        other => other.strip_prefix("in ").unwrap_or(other).trim_start(),
    };
    all().find(|unit| unit.is_written(plain))
}

/// Endings of names, after an underscore, that denote a unit.
fn ends(unit: Unit) -> impl Iterator<Item = String> {
    let word = unit
        .name
        .to_ascii_lowercase()
        .replace('^', "")
        .replace(' ', "_")
        .replace('%', "percent");
    let per = word
        .strip_prefix("1/")
        .map_or_else(|| word.replace('/', "_per_"), |under| format!("per_{under}"));
    let short = word.replace("1/", "per_").replace('/', "_");
    [per, short].into_iter()
}

/// All endings, computed once: a case may have very many keys without a unit.
static ENDS: LazyLock<Vec<(Unit, String)>> = LazyLock::new(|| {
    let units = all().filter(|unit| !["1", "l", "g", "h"].contains(&unit.name));
    units.flat_map(|unit| ends(unit).map(move |end| (unit, end))).collect()
});

/// Unit at the end of a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnitSuffix<'n> {
    /// The name without the unit, and the unit.
    Known(&'n str, Unit),
    /// The name without its end, and the end, which seems to be a unit but is not in the table.
    Unknown(&'n str, &'n str),
    /// No unit.
    None,
}

/// Unit at the end of a name, in the form of keys: `angle`, degrees of `angle_deg`. An end with two possible dimensions (`_n_m`, `_in`) has
/// that of the quantity, if its SI unit `si` determines it.
pub fn suffix<'n>(name: &'n str, si: Option<&str>) -> UnitSuffix<'n> {
    let lower = name.to_ascii_lowercase();
    let cut = |end: &str| {
        let rest = lower.strip_suffix(end)?.strip_suffix('_')?;
        (!rest.is_empty()).then_some(rest.len())
    };
    // `_1_m` of a curvature is not in meters, and `_n_m` is a moment if the dimension is unknown
    let curvature = cut("1_m").filter(|at| lower[..*at].ends_with("curvature"));
    let found = ENDS
        .iter()
        .filter_map(|(unit, end)| Some((*unit, cut(end)?)))
        .min_by_key(|(unit, at)| {
            let per_length = unit.si == "N/m" && !lower.contains("_per_");
            (*at, si != Some(unit.si), per_length)
        });
    let found = match curvature {
        Some(at) => bracketed("1/m").map(|unit| (unit, at)),
        None => found,
    };
    let Some((unit, at)) = found else {
        let names = ELSE_NAMES.iter().filter(|(_, of)| si == Some(of));
        let named = names.map(|(word, _)| *word).find_map(cut);
        let last = lower.rsplit('_').next().unwrap_or("");
        let whole = PREFIXES.iter().find_map(|prefix| last.strip_prefix(prefix));
        let prefixed = whole.is_some_and(|word| FOREIGN.contains(&word) || ["second", "seconds"].contains(&word));
        let known = FOREIGN.into_iter().find_map(cut);
        let known = known.or_else(|| prefixed.then(|| cut(last)).flatten());
        return match named.or(known) {
            Some(at) => UnitSuffix::Unknown(&name[..at], &name[at + 1..]),
            None => UnitSuffix::None,
        };
    };
    let before = |at: usize| {
        BEGUN.iter().find_map(|word| {
            let rest = lower[..at].strip_suffix(word)?.strip_suffix('_')?;
            (!rest.is_empty()).then_some(rest.len())
        })
    };
    let mut begun = at;
    while let Some(at) = before(begun) {
        begun = at;
    }
    match begun == at {
        true => UnitSuffix::Known(&name[..at], unit),
        false => UnitSuffix::Unknown(&name[..begun], &name[begun + 1..]),
    }
}

/// Name without the unit at its end, and that unit, in the form of keys.
pub fn suffixed(name: &str) -> Option<(&str, Unit)> {
    match suffix(name, None) {
        UnitSuffix::Known(rest, unit) => Some((rest, unit)),
        UnitSuffix::Unknown(..) | UnitSuffix::None => None,
    }
}

/// Unit of the numbers below a JSON pointer, from its keys.
pub fn suffix_of_pointer(pointer: &str) -> UnitSuffix<'_> {
    let per_length = |key: &str| pointer.starts_with("/loads/") || key.starts_with("stiffness_");
    let mut ends = pointer.rsplit('/').map(|key| {
        let si = per_length(key).then_some("N/m");
        suffix(key, si)
    });
    ends.find(|end| *end != UnitSuffix::None).unwrap_or(UnitSuffix::None)
}

/// Unit of the numbers below a JSON pointer, if its keys give a known one.
pub fn of_pointer(pointer: &str) -> Option<Unit> {
    match suffix_of_pointer(pointer) {
        UnitSuffix::Known(_, unit) => Some(unit),
        UnitSuffix::Unknown(..) | UnitSuffix::None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{UnitSuffix, bracketed, of_pointer, suffix, suffixed};

    #[test]
    fn headings_have_units_at_their_ends() {
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
        assert_eq!(suffixed("rest_curvature_1_m").map(|(_, unit)| unit.si), Some("1/m"));
        assert_eq!(suffixed("rho_g_cm3").map(|(_, unit)| unit.scale), Some(1e3));
        assert_eq!(bracketed("°").map(|unit| unit.si), Some("rad"));
        assert_eq!(bracketed("mm3").map(|unit| unit.scale), Some(1e-9));
        assert_eq!(bracketed("furlong"), None);
        assert_eq!(bracketed("in"), None);
        for (text, scale) in [
            ("mmHg", 133.322_387_415),
            ("Torr", 133.322_368),
            ("in ms", 1e-3),
            ("in cmH2O", 98.0665),
        ] {
            let found = bracketed(text).map_or(0.0, |unit| unit.scale);
            assert!((found - scale).abs() < 1e-6 * scale, "{text} {found}");
        }
        assert_eq!(
            of_pointer("/network/chains/0/ends/0/pressure_pa").map(|u| u.si),
            Some("Pa")
        );
        for (pointer, si) in [
            ("/ends/tip/free/force_x_n", Some("N")),
            ("/ends/tip/free/moment_n_m", Some("N m")),
            ("/loads/0/force_x_n_m/signal", Some("N/m")),
            ("/loads/0/body_x_m_s2/signal/product/0", Some("m/s^2")),
            ("/attachments/0/stiffness_x_n_m", Some("N/m")),
            ("/attachments/0/damping_x_n_s_m", None),
            ("/attachments/0/stiffness_rotation_n_m_rad", None),
            ("/network/tubes/0/resistance_pa_s_m3", None),
            ("/beam/density_kg_m3", Some("kg/m^3")),
        ] {
            assert_eq!(of_pointer(pointer).map(|unit| unit.si), si, "{pointer}");
        }
    }

    #[test]
    fn units_that_are_not_known_are_no_part_of_a_name() {
        for (name, rest, unit) in [
            ("tip_in", "tip", "in"),
            ("tip_inch", "tip", "inch"),
            ("p_inHg", "p", "inHg"),
            ("pressure_1_mtorr", "pressure_1", "mtorr"),
            ("angle_degrees", "angle", "degrees"),
            ("rate_kpa_s", "rate", "kpa_s"),
            ("damping_n_s_m", "damping", "n_s_m"),
        ] {
            assert_eq!(suffix(name, Some("m")), UnitSuffix::Unknown(rest, unit), "{name}");
        }
        // an inlet, a place, a word
        for name in [
            "pressure_in",
            "angle_foot",
            "p_second",
            "tip_left",
            "flow_one",
            "degrees",
            "origin",
        ] {
            assert_eq!(suffix(name, Some("Pa")), UnitSuffix::None, "{name}");
        }
        // a force per length, if that is expected
        let of = |name, si| match suffix(name, si) {
            UnitSuffix::Known(_, unit) => (unit.name, unit.scale),
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!(of("q_n_mm", Some("N/m")), ("N/mm", 1e3));
        assert_eq!(of("q_n_mm", None), ("N mm", 1e-3));
    }
}
