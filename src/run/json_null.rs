//! Numbers that JSON cannot represent: non-finite values are written as null, and null is read as NaN. A missing number is
//! an error.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer};

/// Reads one number.
pub fn number<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Reads numbers by name.
pub fn by_name<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<String, f64>, D::Error> {
    let all = BTreeMap::<String, Option<f64>>::deserialize(from)?;
    Ok(all.into_iter().map(|(name, x)| (name, x.unwrap_or(f64::NAN))).collect())
}

/// Reads a number with its name, or nothing.
pub fn named<'de, D: Deserializer<'de>>(from: D) -> Result<Option<(String, f64)>, D::Error> {
    let one = Option::<(String, Option<f64>)>::deserialize(from)?;
    Ok(one.map(|(name, x)| (name, x.unwrap_or(f64::NAN))))
}
