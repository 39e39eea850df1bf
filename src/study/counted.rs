//! Which quantities of a run say something.

use crate::run::summary::{Quantity, Summary};

/// Quantities whose size is below this part of others of their unit are round-off.
const NOTHING: f64 = 1e-6;

/// Largest figure of a quantity, without its sign.
pub fn size(quantity: &Quantity) -> f64 {
    quantity.figures().fold(0.0, |s, (_, x)| s.max(x.abs()))
}

/// The quantities that are more than round-off beside others of their unit, by name.
pub fn counted(summary: &Summary) -> impl Iterator<Item = (&String, &Quantity)> {
    let all = &summary.quantities;
    let unit = |name: &str| name.rsplit('_').next().map(str::to_owned);
    all.iter().filter(move |(name, q)| {
        let alike = all.iter().filter(|(other, _)| unit(other) == unit(name));
        let largest = alike.map(|(_, q)| size(q)).fold(0.0, f64::max);
        size(q) > NOTHING * largest
    })
}
