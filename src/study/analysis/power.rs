//! Energy figures of a cycle: energies, mean powers and efficiency, each with the residual of its balance and the error
//! of the mesh.

use std::collections::BTreeMap;

use super::AnalysisOutcome;
use crate::discrete::quantities::Interest;
use crate::run::summary::Quantity;

/// Energies whose mean powers over a cycle are reported, with the names of these powers.
pub const POWERS: [(Interest, &str); 2] = [
    (Interest::HarvestedEnergy, "harvested_power_w.mean"),
    (Interest::InputEnergy, "input_power_w.mean"),
];

/// A figure of the energy of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct CycleFigure {
    /// Name in the table of a sweep.
    pub name: String,
    /// Description.
    pub words: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Value over the period.
    pub value: f64,
    /// Relative residual of its balance; in the table `NAME_error`.
    pub open: Option<f64>,
}

impl CycleFigure {
    /// Returns the name of the residual of its balance.
    pub fn open_name(&self) -> String {
        format!("{}_error", self.name)
    }
}

/// Returns the energy figures over a period [s], those of turbines if the case has some.
pub fn figures(quantities: &BTreeMap<String, Quantity>, period: f64) -> Vec<CycleFigure> {
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
        all.push(CycleFigure {
            name: format!("{}.window", one.name()),
            words,
            unit: one.unit(),
            value,
            open: q.window_error,
        });
        if let Some((_, name)) = POWERS.iter().find(|(energy, _)| *energy == one) {
            all.push(CycleFigure {
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

/// Name of the energy over the period from which a mean power is computed; both have the same relative error.
pub fn energy_of(power: &str) -> Option<String> {
    let (energy, _) = POWERS.iter().find(|(_, name)| *name == power)?;
    Some(format!("{}.window", energy.name()))
}

/// Copies the relative errors of energies to their mean powers, after the former are known.
pub(super) fn share_errors(found: &mut AnalysisOutcome) {
    for (_, power) in POWERS {
        let error = energy_of(power).and_then(|energy| found.figure(&format!("{energy}.error")));
        found.put(format!("{power}.error"), error);
    }
}
