//! Which quantities of a run say something.

use std::collections::BTreeMap;

use crate::discrete::quantities::Interest;
pub use crate::run::floors::Floors;
use crate::run::floors::NOTHING;
use crate::run::summary::{Quantity, Summary};

/// The quantities that are more than round-off, by name: beside others of their unit, an angle beside displacements over the
/// beam's length; beside what the case is expected to do; energies beside the largest one stored or passed. A ratio of
/// energies counts where both do. Figures that are no numbers always count.
pub fn counted<'a>(summary: &'a Summary, floors: &'a Floors) -> impl Iterator<Item = (&'a String, &'a Quantity)> {
    let energies = summary.balances.energy_j.values();
    let energy = energies.fold(0.0_f64, |largest, e| largest.max(e.abs()));
    among(&summary.quantities, energy, floors)
}

/// The same of quantities beside a largest energy [J].
fn among<'a>(
    all: &'a BTreeMap<String, Quantity>,
    energy: f64,
    floors: &'a Floors,
) -> impl Iterator<Item = (&'a String, &'a Quantity)> {
    let counts = move |name: &str, q: &Quantity| {
        let (unit, own) = floors.weighed(name, q.size());
        let alike = all
            .iter()
            .map(|(other, q)| floors.weighed(other, q.size()))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: what a beam of a metre does by round-off alone does not count, with nothing larger beside it: angles of 1e-19 at
    /// ends that are clamped, 3e-18 J where a millijoule is stored, and an efficiency made of that. What is small because the
    /// case does little, a picometre expected and found, counts; so does what is no number.
    #[test]
    fn round_off_does_not_count() {
        let names = |expected_m: f64, energy: f64, all: &[(&str, f64)]| -> Vec<String> {
            let floors = Floors {
                length: 1.0,
                displacement: 1e-9_f64.min(NOTHING * expected_m),
                pressure: 1e-3,
                ..Floors::default()
            };
            let quantity = |last| Quantity {
                last: Some(last),
                ..Quantity::default()
            };
            let all = all
                .iter()
                .map(|(name, last)| (name.to_string(), quantity(*last)))
                .collect();
            among(&all, energy, &floors).map(|(name, _)| name.clone()).collect()
        };
        let clamped = [("tip_u1_m", 0.0), ("tip_angle_rad", 1e-19), ("max_pressure_pa", 1e-9)];
        assert!(names(1e-3, 1e-3, &clamped).is_empty());
        let energies = [
            ("input_energy_j", 3e-18),
            ("harvested_energy_j", 1e-18),
            ("efficiency", 0.3),
        ];
        assert!(names(1e-3, 1e-3, &energies).is_empty());
        assert_eq!(names(1e-3, 3e-18, &energies).len(), 3);
        assert_eq!(
            names(1e-12, 0.0, &[("tip_u1_m", 1e-12), ("tip_angle_rad", 1e-19)]),
            ["tip_u1_m"]
        );
        assert_eq!(names(1e-3, 0.0, &[("tip_u1_m", f64::NAN)]), ["tip_u1_m"]);
    }
}
