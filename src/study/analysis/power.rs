//! What a cycle puts in and harvests: energies, mean powers, the efficiency, each with how far its balance is open and what meshes do.

use std::collections::BTreeMap;

use super::Found;
use crate::discrete::quantities::Interest;
use crate::run::summary::Quantity;

/// Energies whose mean powers over a cycle are told.
pub const POWERS: [(Interest, &str); 2] = [
    (Interest::HarvestedEnergy, "harvested_power_w.mean"),
    (Interest::InputEnergy, "input_power_w.mean"),
];

/// A figure of the energy of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// As the table of a sweep names it.
    pub name: String,
    /// What it is, in words.
    pub words: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Over the period.
    pub value: f64,
    /// How far the balance is open beside it, relative; in the table `NAME_error`.
    pub open: Option<f64>,
}

impl Figure {
    /// The name of how far its balance is open.
    pub fn open_name(&self) -> String {
        format!("{}_error", self.name)
    }
}

/// What there is to tell of the energies over a period [s], those of turbines where a case has some.
pub fn figures(quantities: &BTreeMap<String, Quantity>, period: f64) -> Vec<Figure> {
    let mut all = vec![];
    let words = [
        (Interest::InputEnergy, "put in over the cycle", "mean power put in"),
        (Interest::HarvestedEnergy, "harvested", "mean power"),
        (Interest::Efficiency, "efficiency", ""),
    ];
    for (one, words, of_power) in words {
        let Some((q, value)) = quantities.get(one.name()).and_then(|q| Some((q, q.window?))) else {
            continue;
        };
        all.push(Figure {
            name: format!("{}.window", one.name()),
            words,
            unit: one.unit(),
            value,
            open: q.window_error,
        });
        if let Some((_, name)) = POWERS.iter().find(|(energy, _)| *energy == one) {
            all.push(Figure {
                name: (*name).into(),
                words: of_power,
                unit: "W",
                value: value / period,
                open: q.window_error,
            });
        }
    }
    all
}

/// The energy over the period that a mean power is made of, by the name of the figure: their relative errors are the same.
pub fn energy_of(power: &str) -> Option<String> {
    let (energy, _) = POWERS.iter().find(|(_, name)| *name == power)?;
    Some(format!("{}.window", energy.name()))
}

/// Gives mean powers the errors of their energies, once these have them.
pub(super) fn share_errors(found: &mut Found) {
    for (_, power) in POWERS {
        let error = energy_of(power).and_then(|energy| found.figure(&format!("{energy}.error")));
        found.put(format!("{power}.error"), error);
    }
}
