//! Units at the end of headings, after a space or another sign: `t in ms`, `p / kPa`, `flow, ml/min`.

use super::units::{self, UnitSuffix};

/// Placeholder for the name before a unit.
const ANY: &str = "x_";

/// Unit at the end of a heading, after an underscore, a space or another sign. An end with two possible dimensions has that of the
/// quantity, if its SI unit `si` determines it.
pub fn suffix<'h>(heading: &'h str, si: Option<&str>) -> UnitSuffix<'h> {
    let whole = heading.trim();
    match units::suffix(whole, si) {
        UnitSuffix::None => {}
        UnitSuffix::Known(name, unit) => return UnitSuffix::Known(bare(name), unit),
        unknown @ UnitSuffix::Unknown(..) => return unknown,
    }
    let mut signs = whole
        .char_indices()
        .filter(|(_, sign)| !sign.is_alphanumeric() && !"_^⁻%°".contains(*sign));
    for (at, sign) in signs.clone() {
        let (name, end) = (bare(&whole[..at]), whole[at + sign.len_utf8()..].trim());
        if name.is_empty() || !end.starts_with(|sign: char| sign.is_alphanumeric() || "%°".contains(sign)) {
            continue;
        }
        match of_end(end, si) {
            UnitSuffix::Known(_, unit) => return UnitSuffix::Known(name, unit),
            UnitSuffix::Unknown(_, unit) => return UnitSuffix::Unknown(name, unit),
            UnitSuffix::None => {}
        }
    }
    // the word `in` marks a unit before further words
    for sign in [" in ", "_in_"] {
        let Some((name, rest)) = whole.split_once(sign) else {
            continue;
        };
        let word = rest.split([' ', '_', ',']).next().unwrap_or_default();
        if let (UnitSuffix::Known(_, unit), true) = (of_end(word, si), word.len() > 1) {
            return UnitSuffix::Known(bare(name), unit);
        }
    }
    // a heading that is only a unit; SI units of two letters may also be names
    if let Some(unit) =
        units::bracketed(whole).filter(|unit| whole.len() > 1 && unit.scale != 1.0 && unit.name != "min")
    {
        return UnitSuffix::Known(whole, unit);
    }
    // powers belong to a unit that is unknown
    let power = |sign: char| "^²³⁻".contains(sign);
    let last = signs.rfind(|(at, _)| whole[*at..].contains(power));
    match last {
        Some((at, sign)) if sign.is_whitespace() => UnitSuffix::Unknown(bare(&whole[..at]), whole[at..].trim()),
        _ => UnitSuffix::None,
    }
}

/// Unit that the whole end of a heading names.
fn of_end<'e>(end: &'e str, si: Option<&str>) -> UnitSuffix<'e> {
    if let Some(unit) = units::bracketed(&end.replace(['·', '⋅', '*'], " ")) {
        return match unit.name {
            "1" => UnitSuffix::None,
            _ => UnitSuffix::Known("", unit),
        };
    }
    let key: String = end.chars().filter(|sign| *sign != '^').map(plain).collect();
    let name = format!("{ANY}{}", key.trim_matches('_').replace('%', "percent"));
    match units::suffix(&name, si) {
        UnitSuffix::Known("x", unit) if is_cased_as(end, unit.name) => UnitSuffix::Known("", unit),
        UnitSuffix::Known("x", _) | UnitSuffix::Unknown("x", _) => UnitSuffix::Unknown("", end),
        _ => UnitSuffix::None,
    }
}

/// Converts a sign of a heading to the form of keys.
fn plain(sign: char) -> char {
    match sign {
        'µ' | 'μ' => 'u',
        '²' => '2',
        '³' => '3',
        sign if sign.is_alphanumeric() || sign == '%' => sign,
        _ => '_',
    }
}

/// True if the capitals of a text permit this unit: all letters are small, or all are capitals and no M means m.
fn is_cased_as(text: &str, name: &str) -> bool {
    let small = !text.chars().any(char::is_uppercase);
    let milli_or_mega = text.starts_with('M') && name.starts_with('m');
    let capital = !(milli_or_mega || text.chars().any(char::is_lowercase));
    small || capital
}

/// Removes the signs and the word `in` between a name and its unit.
fn bare(name: &str) -> &str {
    let trimmed = name.trim_end_matches(|sign: char| !sign.is_alphanumeric() && !"])}%°".contains(sign));
    let before = trimmed.strip_suffix("in").filter(|before| before.ends_with([' ', '_']));
    before.map_or(trimmed, bare)
}

#[cfg(test)]
mod tests {
    use super::{UnitSuffix, suffix};

    #[test]
    fn units_stand_behind_blanks_and_other_signs() {
        for (heading, name, unit) in [
            ("t in ms", "t", "ms"),
            ("t_in_ms", "t", "ms"),
            ("t ms", "t", "ms"),
            ("t/ms", "t", "ms"),
            ("t / ms", "t", "ms"),
            ("t-ms", "t", "ms"),
            ("t, ms", "t", "ms"),
            ("t: ms", "t", "ms"),
            ("t.ms", "t", "ms"),
            ("t\u{a0}ms", "t", "ms"),
            ("p in kPa", "p", "kPa"),
            ("p kpa", "p", "kPa"),
            ("p PSI", "p", "psi"),
            ("pressure of bladder 1, in mmHg", "pressure of bladder 1", "mmHg"),
            ("flow ml/min", "flow", "ml/min"),
            ("flow / mL/min", "flow", "ml/min"),
            ("flow in mm³/s", "flow", "mm^3/s"),
            ("flow mm3/s", "flow", "mm^3/s"),
            ("speed m/s", "speed", "m/s"),
            ("moment N mm", "moment", "N mm"),
            ("moment N·mm", "moment", "N mm"),
            ("curvature 1/mm", "curvature", "1/mm"),
            ("angle °", "angle", "deg"),
            ("opening %", "opening", "%"),
            ("volume l", "volume", "l"),
            ("t h", "t", "h"),
            ("x µm", "x", "um"),
            ("pressure in psi gauge", "pressure", "psi"),
            ("ms", "ms", "ms"),
            ("kPa", "kPa", "kPa"),
        ] {
            match suffix(heading, None) {
                UnitSuffix::Known(left, found) => assert_eq!((left, found.name), (name, unit), "{heading}"),
                other => panic!("{heading}: {other:?}"),
            }
        }
    }

    #[test]
    fn what_may_be_a_unit_and_is_not_known_is_no_name() {
        for (heading, name, unit) in [
            ("p mPa", "p", "mPa"),
            ("force MN", "force", "MN"),
            ("p in kilopascals", "p", "kilopascals"),
            ("t milliseconds", "t", "milliseconds"),
            ("t sec", "t", "sec"),
            ("tip inch", "tip", "inch"),
            ("damping N s/m", "damping", "N s/m"),
            ("speed mm s^-1", "speed", "s^-1"),
            ("speed mm s⁻¹", "speed", "s⁻¹"),
        ] {
            let UnitSuffix::Unknown(left, found) = suffix(heading, Some("s")) else {
                panic!("{heading}: {:?}", suffix(heading, Some("s")));
            };
            assert!(left.starts_with(name) && found == unit, "{heading}: {left}, {found}");
        }
        for heading in [
            "bladder 1",
            "tip left",
            "pressure in",
            "p - filtered",
            "t",
            "min",
            "tip_u1.final",
            "x, y",
            "s",
            "",
        ] {
            assert_eq!(suffix(heading, Some("Pa")), UnitSuffix::None, "{heading}");
        }
    }
}
