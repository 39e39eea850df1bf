//! Names of columns as readers of a paper expect them.

use crate::discrete::quantities::probes::{key, tip_of_beam};
use crate::discrete::quantities::{BeamField, Interest, Observable};
use crate::study::sweep::unit::unit;

/// Name and unit of a column: `tip deflection u₁` and `m` for the heading `tip_u1 [m]`. A name without a unit may end with it.
pub fn readable(name: &str, own_unit: &str) -> (String, String) {
    if let Some(one) = Observable::named(name) {
        return (observable(one), own_unit.into());
    }
    let of = if own_unit == "1" { unit(name) } else { own_unit };
    let bare = match own_unit {
        "1" => without_unit(name, of),
        _ => name.to_string(),
    };
    (spoken(&bare), of.into())
}

/// Name of a field at an instant.
pub fn field(one: BeamField) -> String {
    let symbol = match one {
        BeamField::U1 => " u₁",
        BeamField::U3 => " u₃",
        _ => "",
    };
    let words = one.about().split(',').next().unwrap_or_default();
    format!("{words}{symbol}")
}

/// Description of a quantity, with its symbol if its label has one: `tip deflection u₁`.
fn observable(one: Observable) -> String {
    let words = one.describe().trim_start_matches("the ");
    let symbol = one.label().rsplit(' ').next().filter(|last| last.starts_with('u') && last.chars().count() == 2);
    symbol.map_or_else(|| words.into(), |symbol| format!("{words} {symbol}"))
}

/// Words of a name: the last key of a pointer, figures after their quantity, indices of displacements lowered.
fn spoken(name: &str) -> String {
    let last = name.rsplit('/').find(|part| !part.is_empty() && part.parse::<usize>().is_err());
    let name = last.unwrap_or(name);
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
            let (words, unit) = readable(name, unit);
            format!("{words} [{unit}]")
        };
        assert_eq!(of("tip_u1", "m"), "tip deflection u₁ [m]");
        assert_eq!(of("max_pressure", "Pa"), "largest pressure [Pa]");
        assert_eq!(of("middle_u1", "m"), "middle u₁ [m]");
        assert_eq!(of("left.tip_u3", "m"), "tip u₃ of left [m]");
        assert_eq!(of("bladder__3_pressure", "Pa"), "bladder −3 pressure [Pa]");
        assert_eq!(of("/network/chains/0/ends/0/pressure_pa", "1"), "pressure [Pa]");
        assert_eq!(of("tip_u1_m.window_max_abs", "1"), "tip deflection, window max abs [m]");
        assert_eq!(of("wave number", "rad/cell"), "wave number [rad/cell]");
    }
}
