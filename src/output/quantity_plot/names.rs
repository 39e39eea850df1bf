//! Names of columns as readers of a paper expect them.

use crate::case::readable;
use crate::discrete::quantities::probes::{key, tip_of_beam};
use crate::discrete::quantities::{BeamField, Interest, Observable};
use crate::study::sweep::unit::unit;

/// Parts of a complex number and its measures, as they precede the name of an output.
const PARTS: [&str; 6] = ["real", "imaginary", "amplitude", "phase", "error", "mean power"];

/// Name and unit of a column: `tip deflection u₁` and `m` for the heading `tip_u1 [m]`. A name without a unit may end with it.
pub fn for_readers(name: &str, own_unit: &str) -> (String, String) {
    if let Some(one) = Observable::named(name) {
        return (observable(one), own_unit.into());
    }
    let part = PARTS
        .iter()
        .find_map(|part| Some((part, name.strip_prefix(part)?.strip_prefix(' ')?)))
        .filter(|(_, output)| *output != "part");
    if let Some((part, output)) = part {
        let unit = if own_unit == "deg" { "°" } else { own_unit };
        return (format!("{part} of {}", spoken(output)), unit.into());
    }
    if name.starts_with('/') {
        return (readable::pointer_name(name), readable::pointer_unit(name).into());
    }
    let of = if own_unit == "1" { unit(name) } else { own_unit };
    (spoken(name), of.into())
}

/// Name of a field at an instant.
pub fn field(one: BeamField) -> String {
    match one {
        BeamField::U1 => "displacement u₁".into(),
        BeamField::U3 => "displacement u₃".into(),
        BeamField::V1 => "velocity v₁".into(),
        BeamField::V3 => "velocity v₃".into(),
        other => without_unit(other.name(), other.unit()).replace('_', " "),
    }
}

/// Description of a quantity, with its symbol if its label has one: `tip deflection u₁`.
fn observable(one: Observable) -> String {
    let words = one.describe().trim_start_matches("the ");
    let symbol = one
        .label()
        .rsplit(' ')
        .next()
        .filter(|last| last.starts_with('u') && last.chars().count() == 2);
    symbol.map_or_else(|| words.into(), |symbol| format!("{words} {symbol}"))
}

/// Words of a name: figures after their quantity, indices of displacements lowered.
fn spoken(name: &str) -> String {
    if let Some((beam, what)) = tip_of_beam(name) {
        return format!("{} of {beam}", lowered(&format!("tip {what}")));
    }
    let (quantity, figure) = name.split_once('.').unwrap_or((name, ""));
    let words = match Interest::named(quantity) {
        Some(one) => one.describe().trim_start_matches("the ").into(),
        None => {
            let bare = without_unit(quantity, unit(quantity));
            lowered(&bare.replace("__", " −").replace('_', " "))
        }
    };
    match figure {
        "" => words,
        figure => format!("{words}, {}", without_unit(figure, unit(figure)).replace('_', " ")),
    }
}

/// Name without the unit with which it ends.
fn without_unit(name: &str, unit: &str) -> String {
    let end = key("", unit);
    let bare = name.strip_suffix(&end).filter(|bare| unit != "1" && !bare.is_empty());
    bare.unwrap_or(name).into()
}

fn lowered(text: &str) -> String {
    let words = text.split(' ').map(|word| match word {
        "u1" => "u₁",
        "u3" => "u₃",
        other => other,
    });
    words.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_names_for_readers() {
        let of = |name, unit| {
            let (words, unit) = for_readers(name, unit);
            format!("{words} [{unit}]")
        };
        assert_eq!(of("tip_u1", "m"), "tip deflection u₁ [m]");
        assert_eq!(of("max_pressure", "Pa"), "largest pressure [Pa]");
        assert_eq!(of("middle_u1", "m"), "middle u₁ [m]");
        assert_eq!(of("left.tip_u3", "m"), "tip u₃ of left [m]");
        assert_eq!(of("bladder__3_pressure", "Pa"), "bladder −3 pressure [Pa]");
        assert_eq!(of("/network/chains/0/ends/0/pressure_pa", "1"), "ends 0: pressure [Pa]");
        assert_eq!(of("tip_u1_m.window_max_abs", "1"), "tip deflection, window max abs [m]");
        assert_eq!(of("wave number", "rad/cell"), "wave number [rad/cell]");
        assert_eq!(of("phase tip_u3_m", "deg"), "phase of axial tip displacement [°]");
        assert_eq!(of("imaginary part", "1"), "imaginary part [1]");
    }
}
