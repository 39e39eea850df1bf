//! Which quantities of a run say something.

use crate::run::summary::{Quantity, Summary};

/// Quantities whose size is below this part of others of their unit are round-off.
const NOTHING: f64 = 1e-6;

/// Largest figure of a quantity, without its sign.
pub fn size(quantity: &Quantity) -> f64 {
    quantity.figures().fold(0.0, |s, (_, x)| s.max(x.abs()))
}

/// The quantities that are more than round-off beside others of their unit, by name; an angle beside displacements, over the
/// beam's length [m].
pub fn counted(summary: &Summary, length: f64) -> impl Iterator<Item = (&String, &Quantity)> {
    let all = &summary.quantities;
    let weighed = move |name: &str, q: &Quantity| match name.rsplit('_').next().unwrap_or_default() {
        "rad" => ("m".to_string(), size(q) * length),
        unit => (unit.to_string(), size(q)),
    };
    all.iter().filter(move |(name, q)| {
        let (unit, own) = weighed(name, q);
        let alike = all
            .iter()
            .map(|(other, q)| weighed(other, q))
            .filter(|(u, _)| *u == unit);
        own > NOTHING * alike.map(|(_, size)| size).fold(0.0, f64::max)
    })
}
