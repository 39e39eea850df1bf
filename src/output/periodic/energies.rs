//! Energies, mean powers and the efficiency of cycles, with their errors.

use std::collections::BTreeMap;

use crate::output::columns::bracketed;
use crate::output::numbers::{percent, quantity, significant};
use crate::results::cycles::CyclePath;
use crate::results::run::Quantity;
use crate::study::analysis::power::{self, CycleFigure};
use crate::study::stability::CycleMember;

/// Energy figures of the cycle of one value.
pub fn energies(member: &CycleMember) -> Vec<CycleFigure> {
    power::figures(&member.quantities, member.floquet.period_s)
}

/// Names of the columns: every figure of a cycle, followed by its error.
pub fn columns(found: &CyclePath) -> Vec<String> {
    let all = found.members.first().map_or(vec![], energies);
    all.iter().flat_map(|f| [f.name.clone(), f.open_name()]).collect()
}

/// A figure or its error, by the name of its column.
pub fn column(figures: &[CycleFigure], name: &str) -> Option<f64> {
    figures.iter().find_map(|f| match name == f.name {
        true => Some(f.value),
        false => f.open.filter(|_| name == f.open_name()),
    })
}

/// Figures shown if turbines harvest: energy, mean power, efficiency; empty without turbines.
pub fn harvested(found: &CyclePath) -> Vec<CycleFigure> {
    let all = found.members.first().map_or(vec![], energies);
    let put_in = |f: &CycleFigure| f.name.starts_with("input");
    all.into_iter().filter(|f| !put_in(f)).collect()
}

/// Headings of figures, with units.
pub fn headings(shown: &[CycleFigure]) -> impl Iterator<Item = String> + use<'_> {
    shown.iter().map(|f| match f.unit {
        "1" => f.words.into(),
        unit => format!("{} [{unit}]", f.words),
    })
}

/// Values of figures in one cycle, with errors.
pub fn shown(member: &CycleMember, shown: &[CycleFigure]) -> Vec<String> {
    let figures = energies(member);
    let cell = |name: &str| {
        let f = figures.iter().find(|f| f.name == name)?;
        let value = match f.unit {
            "1" => percent(f.value),
            _ => significant(f.value, 4),
        };
        Some(value + &f.open.map_or(String::new(), |e| format!(" ± {}", percent(e))))
    };
    shown.iter().map(|f| cell(&f.name).unwrap_or("–".into())).collect()
}

/// Lines of text about one cycle: each figure with its value, the open part of its energy balance, and its estimated error.
pub fn lines(
    quantities: &BTreeMap<String, Quantity>,
    period: f64,
    error: &dyn Fn(&str) -> Option<f64>,
) -> Vec<[String; 2]> {
    let all = power::figures(quantities, period);
    // the input is listed as an energy; its mean power is in the table of a sweep
    let listed = all.iter().filter(|f| !f.name.starts_with("input_power"));
    let line = |f: &CycleFigure| {
        let value = match f.unit {
            "1" => percent(f.value),
            unit => quantity(f.value, unit, 4),
        };
        let of = power::energy_of(&f.name).unwrap_or(f.name.clone());
        let open = f.open.map(|e| format!("residual of the energy balance {}", percent(e)));
        let error = error(&of).map(|e| format!("estimated error {}", percent(e)));
        [f.words.into(), value + &bracketed(open.into_iter().chain(error), "; ")]
    };
    listed.map(line).collect()
}
