//! Differences of the figures of two runs.

use std::collections::BTreeMap;

use crate::discrete::quantities::Interest;
use crate::run::summary::{Figures, Quantity, Summary, has_unit_of_quantity, largest_error};
use crate::study::significant::{RoundingScales, counted, counted_of_ports, counted_of_probes, weighed};

/// Errors by the name of a quantity, probe or port, relative to its largest figure.
pub type Relative = BTreeMap<String, f64>;

/// Smallest error of a figure, relative to the largest error among the figures of its quantity.
pub const SHARED: f64 = 0.3;

/// Size of a quantity, relative to the largest with its unit, below which an accuracy that is asked for is relative to this part of that
/// one. What remains of energies after a cycle, or of forces at a free end, would need a much finer run.
pub const SMALL: f64 = 0.1;

/// Largest displacements anywhere along the beam, which are no more certain than those at the places that are watched.
const ANYWHERE: [(&str, &[&str]); 2] = [
    ("largest_u1_m", &["tip_u1_m", "midspan_u1_m"]),
    ("largest_u3_m", &["tip_u3_m"]),
];

/// Figures of quantities, probes and ports.
pub fn figures(summary: &Summary) -> Figures {
    let all = summary.quantities.iter().chain(&summary.probes).chain(&summary.ports);
    let of = |q: &Quantity| q.all_figures().map(|(figure, x)| (figure.into(), x)).collect();
    all.map(|(name, q)| (name.clone(), of(q))).collect()
}

/// Absolute error of each figure of a run by its companion, in the unit of the figure; without those that the companion does not have.
pub fn errors(run: &Summary, companion: &Summary) -> Figures {
    differences(&figures(run), &figures(companion))
}

/// Raises errors of energies that count to the residual of the energy balance, which is an error of the time steps: the discrete equations
/// conserve energy.
pub fn raise_to_balance(summary: &Summary, errors: &mut Figures, floors: &RoundingScales) {
    let counted = relative(summary, errors, floors, 0.0);
    for (name, quantity) in summary
        .quantities
        .iter()
        .filter(|(name, _)| counted.contains_key(*name))
    {
        let Some(errors) = errors.get_mut(name) else { continue };
        let open = [
            ("final", quantity.last, quantity.final_error),
            ("window", quantity.window, quantity.window_error),
        ];
        for (figure, value, open) in open {
            if let (Some(error), Some(value), Some(open)) = (errors.get_mut(figure), value, open) {
                *error = error.max(open * value.abs());
            }
        }
    }
}

/// The same of figures.
pub fn differences(run: &Figures, companion: &Figures) -> Figures {
    let of = |(name, own): (&String, &BTreeMap<String, f64>)| {
        let other = companion.get(name)?;
        let apart = |figure: &str| Some((own.get(figure)? - other.get(figure)?).abs()).filter(|e| e.is_finite());
        let of = |figure: &String| Some((figure.clone(), apart(unsigned(figure))?));
        let mut errors: BTreeMap<String, f64> = own.keys().filter_map(of).collect();
        // efficiencies of the run and of the window have unlike denominators
        let of_efficiency = name == Interest::Efficiency.name();
        let size = |figure: &str| match own.get(figure) {
            Some(value) if of_efficiency && *value != 0.0 => value.abs(),
            _ => 1.0,
        };
        let alike = errors.iter().filter(|(figure, _)| has_unit_of_quantity(figure));
        let largest = alike.map(|(figure, error)| error / size(figure)).fold(0.0, f64::max);
        for (figure, error) in errors.iter_mut().filter(|(figure, _)| has_unit_of_quantity(figure)) {
            *error = error.max(SHARED * largest * size(figure));
        }
        Some((name.clone(), errors))
    };
    let mut all: Figures = run.iter().filter_map(of).collect();
    for (anywhere, places) in ANYWHERE {
        let Some(mut errors) = all.remove(anywhere) else {
            continue;
        };
        for (figure, error) in &mut errors {
            let there = places.iter().filter_map(|place| all.get(*place)?.get(figure));
            *error = there.fold(*error, |most, there| most.max(*there));
        }
        all.insert(anywhere.into(), errors);
    }
    all
}

/// The figure without sign that stands for an extreme: the sides of a vibration change places from run to run.
fn unsigned(figure: &str) -> &str {
    match figure {
        "extreme" => "max_abs",
        "window_extreme" => "window_max_abs",
        other => other,
    }
}

/// A summary whose figures are as large as their errors allow: a figure that is next to nothing counts where its error does.
fn with_errors_added(summary: &Summary, errors: &Figures) -> Summary {
    let mut added = summary.clone();
    let Summary {
        quantities,
        probes,
        ports,
        ..
    } = &mut added;
    for (name, quantity) in quantities.iter_mut().chain(probes).chain(ports) {
        let error = errors.get(name).and_then(largest_error).unwrap_or(0.0);
        for figure in [&mut quantity.last, &mut quantity.max_abs].into_iter().flatten() {
            *figure = figure.abs() + error;
        }
    }
    added
}

/// Largest error of each quantity, probe and port that is more than rounding, relative to its size: its largest figure, and at least
/// `small` of the largest with the same unit.
pub fn relative(summary: &Summary, errors: &Figures, floors: &RoundingScales, small: f64) -> Relative {
    let added = &with_errors_added(summary, errors);
    let quantities = counted(added, floors).map(|(name, _)| (name, summary.quantities[name].size()));
    let probes = counted_of_probes(added, floors).map(|(name, _)| (name, summary.probes[name].size()));
    let ports = counted_of_ports(added, floors).map(|name| (name, summary.ports[name].size()));
    let raised = factors_of_sizes(summary, floors, small);
    let largest = |(name, size): (&String, f64)| {
        let raised = raised.get(name.as_str()).copied().unwrap_or(1.0);
        Some((name.clone(), largest_error(errors.get(name)?)? / (size * raised)))
    };
    quantities.chain(probes).chain(ports).filter_map(largest).collect()
}

/// Factors by which `small` of the largest figure with the same unit exceeds the size of smaller ones. Angles count as displacements
/// over the length, moments as forces at the length; an efficiency has the largest factor of its energies.
pub fn factors_of_sizes<'a>(summary: &'a Summary, floors: &RoundingScales, small: f64) -> BTreeMap<&'a str, f64> {
    let Summary {
        quantities,
        probes,
        ports,
        ..
    } = summary;
    let all = quantities.iter().chain(probes).chain(ports);
    let sizes: Vec<(&str, (&str, f64))> = all
        .map(|(name, q)| (name.as_str(), weighed(name, q.size(), floors)))
        .collect();
    let energies = summary.balances.energy_j.values().map(|energy| ("J", energy.abs()));
    let mut largest: BTreeMap<&str, f64> = BTreeMap::new();
    for (unit, size) in sizes.iter().map(|(_, weighed)| *weighed).chain(energies) {
        let most = largest.entry(unit).or_insert(0.0);
        *most = most.max(size);
    }
    let factor = |(unit, size): (&str, f64)| match unit == "1" || size == 0.0 {
        true => 1.0,
        false => (small * largest[unit] / size).max(1.0),
    };
    let mut factors: BTreeMap<&str, f64> = sizes.into_iter().map(|(name, size)| (name, factor(size))).collect();
    let of_energies = [Interest::InputEnergy, Interest::HarvestedEnergy].map(|one| factors.get(one.name()).copied());
    if let Some(efficiency) = factors.get_mut(Interest::Efficiency.name()) {
        *efficiency = of_energies.into_iter().flatten().fold(1.0, f64::max);
    }
    factors
}

/// Errors of a run by their cause, the JSON pointer of a setting, as [`relative`] gives them; empty where no cause is measured.
pub fn relative_by_cause<'a>(summary: &'a Summary, floors: &RoundingScales, small: f64) -> BTreeMap<&'a str, Relative> {
    let causes = summary.companion.iter().flat_map(|companion| &companion.causes);
    let relative = causes.map(|(pointer, errors)| (pointer.as_str(), relative(summary, errors, floors, small)));
    relative.collect()
}
