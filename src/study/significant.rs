//! Quantities of a run that exceed rounding errors.

use crate::discrete::quantities::Interest;
use crate::run::ports::unit;
use crate::run::rounding_scales::NOTHING;
pub use crate::run::rounding_scales::RoundingScales;
use crate::run::summary::{Quantity, Summary};
use crate::study::sweep::unit as figures;

/// Names of flows and pressures of ports and accumulators that exceed rounding errors. Compares with others of the same unit, and pressures
/// also with the expected scale of the case.
pub fn counted_of_ports<'a>(summary: &'a Summary, floors: &RoundingScales) -> impl Iterator<Item = &'a String> {
    let floor = floors.pressure;
    let largest = move |of: &str| {
        let alike = summary.ports.iter().filter(|(name, _)| unit(name) == of);
        alike.map(|(_, q)| q.size()).fold(0.0, f64::max)
    };
    let counts = move |(name, q): &(&'a String, &'a Quantity)| {
        let of = unit(name);
        let least = if of == "Pa" { floor } else { 0.0 };
        q.size() > (NOTHING * largest(of)).max(least) || q.figures().any(|(_, x)| !x.is_finite())
    };
    summary.ports.iter().filter(counts).map(|(name, _)| name)
}

/// Quantities of probes that exceed rounding errors. Compares with others of the same unit, and displacements, angles and pressures also
/// with the expected scale of the case.
pub fn counted_of_probes<'a>(
    summary: &'a Summary,
    floors: &'a RoundingScales,
) -> impl Iterator<Item = (&'a String, &'a Quantity)> {
    let largest = move |of: &str| {
        let alike = summary.probes.iter().filter(|(name, _)| figures::unit(name) == of);
        alike.map(|(_, q)| q.size()).fold(0.0, f64::max)
    };
    let counts = move |(name, q): &(&'a String, &'a Quantity)| {
        let unit = figures::unit(name);
        let floor = match unit {
            "rad" => floors.displacement / floors.length,
            unit => floors.of_unit(unit, 0.0),
        };
        q.size() > (NOTHING * largest(unit)).max(floor)
    };
    summary.probes.iter().filter(counts)
}

/// Unit and magnitude in which a quantity is compared with others: an angle as displacement at the length, a moment as force there.
pub fn weighed(name: &str, size: f64, floors: &RoundingScales) -> (&'static str, f64) {
    match figures::unit(name) {
        "rad" => ("m", size * floors.length),
        "N m" => ("N", size / floors.length),
        unit => (unit, size),
    }
}

/// Quantities that exceed rounding errors, with their names. Compares with others of the same unit, angles with displacements over the
/// beam's length, and energies with the largest one stored or passed. A further limit is the expected scale of the case. A ratio of
/// energies counts if both energies do. Non-finite figures always count.
pub fn counted<'a>(
    summary: &'a Summary,
    floors: &'a RoundingScales,
) -> impl Iterator<Item = (&'a String, &'a Quantity)> {
    let energies = summary.balances.energy_j.values();
    let energy = energies.fold(0.0_f64, |largest, e| largest.max(e.abs()));
    let all = &summary.quantities;
    let counts = move |name: &str, q: &Quantity| {
        let (unit, own) = weighed(name, q.size(), floors);
        let alike = all
            .iter()
            .map(|(other, q)| weighed(other, q.size(), floors))
            .filter(|(u, _)| *u == unit);
        let largest = NOTHING * alike.map(|(_, size)| size).fold(0.0, f64::max);
        own > largest.max(floors.of_unit(unit, energy)) || q.figures().any(|(_, x)| !x.is_finite())
    };
    all.iter().filter(move |(name, q)| {
        let parts: &[Interest] = match Interest::named(name) {
            Some(Interest::Efficiency) => &[Interest::InputEnergy, Interest::HarvestedEnergy],
            _ => &[],
        };
        let part_counts = |part: &Interest| all.get(part.name()).is_none_or(|q| counts(part.name(), q));
        counts(name, q) && parts.iter().all(part_counts)
    })
}
