//! Keys with a unit that the case does not use: the intended key, and the number in its unit.

use std::f64::consts::TAU;

use serde_json::Value;

use super::amounts::{self, GRAVITY};
use super::units::{self, Unit, UnitSuffix};
use super::wording::nearest;
use crate::error::numbers;

/// Units of which an object rarely has more than one key; that key is intended whatever the name.
const RARE: [&str; 4] = ["rad", "pa_s", "hz", "kg_m3"];

/// The key that is intended by one with another unit, and the text to write there.
pub fn unit<'n>(key: &str, value: &Value, known: impl Iterator<Item = &'n str> + Clone) -> Option<(String, String)> {
    let key = key.to_lowercase();
    if !key.contains('_') && key != "omega" {
        return None;
    }
    let of = |unit: &str| {
        let end = format!("_{unit}");
        known.clone().filter(move |name| name.ends_with(&end))
    };
    // multiples of gravity, angular frequencies, viscosities over density
    if let Some(meant) = key
        .strip_suffix("_g")
        .and_then(|stem| nearest(&format!("{stem}_m_s2"), of("m_s2")))
    {
        let hint = conversion(&meant, value, GRAVITY, "g");
        return Some((meant, hint));
    }
    let turning = key == "omega" || key.starts_with("omega_") || key.ends_with("_rad_s");
    let mut frequency = known.clone().filter(|name| turning && *name == "frequency_hz");
    if let Some(meant) = frequency.next() {
        return Some((meant.to_owned(), conversion(meant, value, 1.0 / TAU, "rad/s")));
    }
    let mut rotation = known.clone().filter(|name| *name == "angular_velocity_rad_s");
    let speeds = [
        ("rpm", "rpm", TAU / 60.0),
        ("hz", "Hz", TAU),
        ("deg_s", "deg/s", TAU / 360.0),
    ];
    let speed = speeds.into_iter().find(|(end, ..)| key.ends_with(&format!("_{end}")));
    if let Some((meant, (_, name, size))) = rotation.next().zip(speed) {
        return Some((meant.to_owned(), conversion(meant, value, size, name)));
    }
    if let Some(meant) = key
        .strip_suffix("_cst")
        .and_then(|stem| nearest(&format!("{stem}_pa_s"), of("pa_s")))
    {
        let hint = "cSt is a unit of kinematic viscosity: multiply by 1e-6 and density_kg_m3 to obtain Pa s";
        return Some((meant, hint.to_owned()));
    }
    let of_table = [None, Some("N/m")].into_iter().find_map(|si| {
        let UnitSuffix::Known(stem, unit) = units::suffix(&key, si) else {
            return None;
        };
        let end = unit.key();
        let meant = nearest(&format!("{stem}_{end}"), of(&end)).or_else(|| {
            let mut all = of(&end);
            let only = all
                .next()
                .filter(|_| all.next().is_none() && RARE.contains(&end.as_str()));
            only.map(str::to_owned)
        })?;
        // the same unit is no mistake
        (unit.scale != 1.0).then(|| {
            let hint = conversion(&meant, value, unit.scale, unit.name);
            (meant, hint)
        })
    });
    of_table.or_else(|| {
        let (stem, word) = key.rsplit_once('_')?;
        let (si, scale) = match word {
            "g" => ("kg", 1e-3),
            "l" => ("m^3", 1e-3),
            "h" => ("s", 3600.0),
            _ => amounts::other(word)?,
        };
        let end = Unit { si, name: si, scale }.key();
        let meant = nearest(&format!("{stem}_{end}"), of(&end))?;
        let hint = conversion(&meant, value, scale, word);
        Some((meant, hint))
    })
}

/// Text for a key: the number in its unit, or the factor of its numbers.
fn conversion(meant: &str, value: &Value, size: f64, name: &str) -> String {
    match value.as_f64() {
        Some(number) => format!(
            "write \"{meant}\": {}, which is {number} {name}",
            number_of(number * size)
        ),
        None => format!("numbers there are {} times those in {name}", number_of(size)),
    }
}

/// Formats a number without the rounding error of the product that gave it.
pub(super) fn number_of(number: f64) -> String {
    let number = numbers::rounded(number, 13);
    match number.abs() {
        1e-4..1e6 | 0.0 => format!("{number}"),
        _ => format!("{number:e}"),
    }
}
