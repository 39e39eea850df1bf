//! Numbers given as texts with a unit, and their conversion to the unit of the key.

use std::f64::consts::{PI, TAU};

use super::parse::common_mistakes::loose;
use super::unit_mistakes::number_of;
use super::units::{self, Unit, UnitSuffix};
use super::wording::short;

/// Longest text [bytes] that is read as a number with a unit.
const LONGEST: usize = 60;

/// Standard gravity [m/s^2].
pub const GRAVITY: f64 = 9.806_65;

/// Units that headings of tables do not accept, because some are ambiguous there: SI unit, spellings, factor to the SI unit.
const OTHERS: [(&str, &[&str], f64); 37] = [
    ("m", &["in", "inch", "inches", "\""], 0.0254),
    ("m", &["ft", "foot", "feet"], 0.3048),
    ("m", &["yd"], 0.9144),
    ("m", &["mil", "mils", "thou"], 2.54e-5),
    ("m", &["nm"], 1e-9),
    ("m", &["km"], 1e3),
    ("m", &["dm"], 0.1),
    ("m", &["meter", "meters", "metre", "metres"], 1.0),
    ("m", &["millimeter", "millimeters", "millimetre", "millimetres"], 1e-3),
    ("m", &["micron", "microns"], 1e-6),
    ("s", &["sec", "secs", "second", "seconds"], 1.0),
    ("s", &["msec"], 1e-3),
    ("s", &["usec"], 1e-6),
    ("s", &["ns"], 1e-9),
    ("s", &["minute", "minutes"], 60.0),
    ("s", &["hr", "hrs", "hour", "hours"], 3600.0),
    ("Pa", &["pascal", "pascals"], 1.0),
    ("Pa", &["atm"], 101_325.0),
    ("Pa", &["torr", "mmhg"], 133.322),
    ("Pa", &["inhg"], 3386.39),
    ("Pa", &["cmh2o"], 98.0665),
    ("Pa", &["mmh2o"], 9.806_65),
    ("Pa", &["inh2o"], 249.089),
    ("Pa", &["ksi"], 6.894_757_293_168_36e6),
    ("Pa", &["psf"], 47.880_26),
    ("rad", &["degree", "degrees"], PI / 180.0),
    ("rad", &["radian", "radians"], 1.0),
    ("rad", &["arcmin"], PI / 10_800.0),
    ("N", &["newton", "newtons"], 1.0),
    ("N", &["lbf"], 4.448_221_615_260_5),
    ("N", &["kgf", "kp"], GRAVITY),
    ("N", &["gf"], 1e-3 * GRAVITY),
    ("N", &["dyn", "dyne"], 1e-5),
    ("kg", &["lb", "lbs"], 0.453_592_37),
    ("kg", &["oz"], 0.028_349_523_125),
    ("kg", &["mg"], 1e-6),
    ("Pa s", &["poise"], 0.1),
];

/// Further such units, of volume and flow.
const LIQUIDS: [(&str, &[&str], f64); 6] = [
    ("m^3", &["cc"], 1e-6),
    ("m^3", &["nl"], 1e-12),
    ("m^3", &["liter", "liters", "litre", "litres"], 1e-3),
    ("m^3/s", &["lpm"], 1e-3 / 60.0),
    ("m^3/s", &["gpm"], 6.309_02e-5),
    ("m^3/s", &["m3/h"], 1.0 / 3600.0),
];

/// SI unit and factor of a unit that the table of units lacks, by its spelling.
pub(super) fn other(word: &str) -> Option<(&'static str, f64)> {
    let word = word.to_lowercase();
    let mut all = OTHERS.iter().chain(&LIQUIDS);
    let (si, _, scale) = all.find(|(_, words, _)| words.contains(&word.as_str()))?;
    Some((*si, *scale))
}

/// Possible values of the number at the beginning of a text, and the unit behind it. Ambiguous commas give several values.
fn split(text: &str) -> Option<(Vec<f64>, &str)> {
    let text = text.trim();
    if text.len() > LONGEST || !text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
        return None;
    }
    // a number alone, such as 1e-6, has no unit
    if text.parse::<f64>().is_ok() {
        return None;
    }
    let mut ends = (1..text.len()).rev().filter(|end| text.is_char_boundary(*end));
    let (number, unit) = ends.find_map(|end| {
        let (number, unit) = text.split_at(end);
        let number = number.trim_end();
        let loose = || loose(number).iter().filter_map(|one| one.parse().ok()).collect();
        let readings: Vec<f64> = number.parse::<f64>().map_or_else(|_| loose(), |one| vec![one]);
        (!readings.is_empty() && readings.iter().all(|x| x.is_finite())).then_some((readings, unit.trim()))
    })?;
    // the exponent of a number with a comma is not a unit
    let power = unit.len() > 1 && unit.starts_with(['e', 'E']) && unit[1..].parse::<i32>().is_ok();
    (!power && unit.starts_with(|c: char| c.is_alphabetic() || "%°\"".contains(c))).then_some((number, unit))
}

/// Normalizes the spelling of a unit: micro sign, superscripts, and separators.
fn squeezed(unit: &str) -> String {
    let plain = unit.replace(['µ', 'μ'], "u").replace('²', "2").replace('³', "3");
    plain.chars().filter(|c| !" ^·*.".contains(*c)).collect()
}

/// True if two spellings name one unit. Case matters only in single letters and in an initial `m` or `M` (milli or mega).
fn alike(written: &str, name: &str) -> bool {
    if written == name || written.replace('L', "l") == name {
        return true;
    }
    let first = |text: &str| text.chars().next();
    let prefix = first(written) != first(name) && first(name).is_some_and(|c| "mM".contains(c));
    written.len() > 1 && !prefix && written.eq_ignore_ascii_case(name)
}

/// Factor from a written unit to the SI unit `si`; otherwise the SI unit of its own dimension, if known.
fn size(written: &str, si: &str) -> Result<f64, Option<&'static str>> {
    let word = match squeezed(written) {
        degree if degree == "°" => "deg".to_owned(),
        other => other,
    };
    match (si, word.as_str()) {
        ("m/s^2", "g") => return Ok(GRAVITY),
        ("Hz", "rad/s") => return Ok(1.0 / TAU),
        ("Hz", "1/s") => return Ok(1.0),
        ("Pa", "mPa") => return Ok(1e-3),
        _ => {}
    }
    let of = |unit: &Unit| alike(&word, &squeezed(unit.name));
    if let Some(unit) = units::of_dimension(si).find(of) {
        return Ok(unit.scale);
    }
    match other(&word) {
        Some((own, scale)) if own == si => Ok(scale),
        Some((own, _)) => Err(Some(own)),
        None => Err(units::all().find(of).map(|unit| unit.si)),
    }
}

/// Meaning of a number with a unit at a pointer.
#[derive(Clone, Debug, PartialEq)]
pub enum UnitContext {
    /// The number, converted to the unit of the key, and that unit.
    Number(String, String),
    /// No valid number, for this reason.
    Not(String),
}

/// Interprets a text at a pointer; none if the text is not a number with a unit.
pub fn at(pointer: &str, text: &str) -> Option<UnitContext> {
    let (readings, unit) = split(text)?;
    let &[number] = &readings[..] else {
        let all: Vec<String> = readings
            .iter()
            .map(|one| format!("{} {unit}", number_of(*one)))
            .collect();
        return Some(UnitContext::Not(format!(
            "{} is ambiguous: {}. Write the intended number",
            short(text.trim()),
            all.join(" or ")
        )));
    };
    let same = |of: String| UnitContext::Number(number_of(number), of);
    if pointer.ends_with("/temperature_c") && ["°C", "degC", "C"].contains(&unit) {
        return Some(same("°C".into()));
    }
    Some(match units::suffix_of_pointer(pointer) {
        UnitSuffix::Known(_, of) => match size(unit, of.si) {
            Ok(scale) => UnitContext::Number(number_of(number * scale / of.scale), of.name.into()),
            Err(Some(_)) => UnitContext::Not(format!(
                "{} is a unit of another quantity; the number here is in {}",
                short(unit),
                of.name
            )),
            Err(None) => UnitContext::Not(format!(
                "the unit {} is not known; the number here is in {}",
                short(unit),
                of.name
            )),
        },
        UnitSuffix::Unknown(_, end)
            if squeezed(unit)
                .replace('/', "")
                .eq_ignore_ascii_case(&end.replace('_', "")) =>
        {
            same(unit.into())
        }
        UnitSuffix::Unknown(_, end) => UnitContext::Not(format!(
            "the number here is in {end}, the unit at the end of the key, not in {}",
            short(unit)
        )),
        UnitSuffix::None => match size(unit, "1") {
            Ok(scale) => UnitContext::Number(number_of(number * scale), "1".into()),
            Err(_) => UnitContext::Not(format!("the number here has no unit, but {} is given", short(unit))),
        },
    })
}

/// Advice about a text at a pointer, if it is a number with a unit.
pub fn remedy(pointer: &str, text: &str) -> Option<String> {
    Some(match at(pointer, text)? {
        UnitContext::Number(number, _) => format!(
            "{} is {number} here: write the number alone, the key has the unit",
            short(text.trim())
        ),
        UnitContext::Not(why) => why,
    })
}

/// Advice about numbers with units in the value of an option, separated by `,` and `:`: the option with bare numbers, or the reason why
/// there is none.
pub fn rewritten(option: &str, pointer: &str, spec: &str) -> Option<String> {
    if spec.len() > 20 * LONGEST {
        return None;
    }
    let mut readings = vec![];
    let mut new = String::new();
    let mut before = "";
    for part in spec.split_inclusive([',', ':']) {
        let own = part.trim_end_matches([',', ':']);
        if let Some(joined) = thousands(before, own) {
            return Some(format!(
                "commas separate values here: write {joined} if {}{} is one number",
                before.trim(),
                own.trim()
            ));
        }
        before = part;
        match at(pointer, own) {
            None => new += part,
            Some(UnitContext::Not(why)) => return Some(why),
            Some(UnitContext::Number(number, _)) => {
                readings.push(format!("{} is {number} here", own.trim()));
                new += &number;
                new += &part[own.len()..];
            }
        }
    }
    (!readings.is_empty()).then(|| format!("{}: {option} '{pointer}={new}'", readings.join(", ")))
}

/// Joins two parts that a thousands comma has separated, such as `60,` and `000 Pa`.
fn thousands(before: &str, part: &str) -> Option<String> {
    let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
    let (first, rest) = (before.strip_suffix(',')?.trim(), part.trim());
    let whole = (1..=3).contains(&first.len()) && digits(first) == first.len();
    let unit = digits(rest) == 3 && rest[3..].trim_start().starts_with(char::is_alphabetic);
    (whole && unit).then(|| format!("{first}{rest}"))
}

#[cfg(test)]
mod tests {
    use super::{UnitContext, at, rewritten};

    /// Goal: an ambiguous thousands comma is reported instead of read as a decimal comma.
    #[test]
    fn commas_between_thousands_are_reported() {
        let pointer = "/network/chains/0/ends/0/pressure_pa";
        let Some(UnitContext::Not(what)) = at(pointer, "60,000 Pa") else {
            panic!("no number")
        };
        assert!(what.contains("60 Pa or 60000 Pa"), "{what}");
        assert_eq!(
            at(pointer, "1,234,567 Pa"),
            Some(UnitContext::Number("1.234567e6".into(), "Pa".into()))
        );
        assert_eq!(at("/beam/young_modulus_pa", "1,5e6"), None);
        let text = rewritten("--vary", pointer, "60,000 Pa").expect("a remedy");
        assert!(text.contains("write 60000 Pa if 60,000 Pa is one number"), "{text}");
        let text = rewritten("--vary", pointer, "20,000 Pa:80,000 Pa").expect("a remedy");
        assert!(text.contains("20000 Pa"), "{text}");
    }

    #[test]
    fn numbers_with_units_are_those_of_the_key() {
        for (pointer, text, number) in [
            ("/network/chains/0/ends/0/pressure_pa", "60kPa", "60000"),
            ("/network/chains/0/ends/0/pressure_pa/ramp/to", "60 kpa", "60000"),
            ("/beam/young_modulus_pa", "2MPa", "2e6"),
            ("/time/end_s", "500ms", "0.5"),
            ("/beam/length_m", "10cm", "0.1"),
            ("/beam/length_m", "1.5 inch", "0.0381"),
            ("/fluid/viscosity_pa_s", "1 mPa·s", "0.001"),
            ("/fluid/viscosity_pa_s", "0.5Pas", "0.5"),
            ("/network/ports/0/flow_m3_s", "6 mL/min", "1e-7"),
            ("/loads/0/gravity/x_m_s2", "1 g", "9.80665"),
            ("/attachments/0/mass_kg", "5 g", "0.005"),
            ("/solver/rtol", "1%", "0.01"),
            ("/attachments/0/damping_x_n_s_m", "5 N s/m", "5"),
            ("/fluid/temperature_c", "20 °C", "20"),
            ("/beam/young_modulus_pa", "0,5 MPa", "500000"),
            // millipascals, not megapascals
            ("/beam/young_modulus_pa", "2 mPa", "0.002"),
        ] {
            let Some(UnitContext::Number(found, _)) = at(pointer, text) else {
                panic!("{pointer}: {text}")
            };
            assert_eq!(found, number, "{pointer}: {text}");
        }
        for (pointer, text) in [
            ("/beam/length_m", "60 kPa"),
            ("/beam/length_m", "6 furlongs"),
            ("/beam/length_m", "3 Mm"),
            ("/solver/rtol", "1 mm"),
        ] {
            assert!(matches!(at(pointer, text), Some(UnitContext::Not(_))), "{text}");
        }
        for text in ["60", "sealed", "1e3", "5e5", "1E-6", "1e400", "", "1:2", "-", "2/3"] {
            assert_eq!(at("/beam/length_m", text), None, "{text}");
        }
    }
}
