//! Text of a load path.

use super::LoadPath;
use crate::discrete::quantities::probes::{is_stress, tip_of_beam};
use crate::discrete::quantities::{Group, Observable};
use crate::output::columns::{self, aligned, if_any, joined, warnings};
use crate::output::numbers::{counted, quantity, significant, with_error};
use crate::run::equilibrium::EquilibriumState;
use crate::run::record::HistoryColumn;
use crate::study::refine::meshes::Meshes;

/// Largest number of rows in the table.
const ROWS: usize = 12;
/// Largest number of derivatives listed.
const DERIVATIVES: usize = 60;
/// Fraction of the largest value in a unit below which values are round-off.
const ROUND_OFF: f64 = 1e-12;
/// Largest pressure [Pa] and force [N] that count as zero.
const NO_PRESSURE: f64 = 1e-9;
const NO_FORCE: f64 = 1e-15;

/// Table of the path, its events, the last state, and derivatives.
pub fn describe(found: &LoadPath) -> String {
    let path = found.path;
    if path.states.is_empty() {
        return String::new();
    }
    let mut text = table(found);
    for event in &path.events {
        text.push_str(&format!(
            "at {}: {}\n",
            found.options.place(event.stage, &significant(event.share, 6)),
            event.describe()
        ));
    }
    if let Some(words) = found.meshes.and_then(Meshes::describe) {
        text.push_str(&format!("\n{}{words}\n", last_with_errors(found)));
    }
    text += &warnings(found.warnings);
    if let Some(last) = path.states.last() {
        let stability = match &last.stability {
            None => "stability unknown".into(),
            Some(s) if s.unstable == 0 => "stable".into(),
            Some(s) => format!("unstable in {}", counted(s.unstable as u64, "way")),
        };
        text.push_str(&format!(
            "\n{}, {stability}: {}, {}, {} in all\n",
            reached(found, last),
            counted(path.states.len() as u64, "state"),
            counted(path.work.iterations, "Newton step"),
            quantity(found.wall_s, "s", 3),
        ));
    }
    if path.fault.is_none() && loads_nothing(found) {
        let at = significant(found.options.at_s, 6);
        text.push_str(&format!(
            "nothing acts at t = {at} s: {} and bladders are as they are made\n",
            if found.case.is_structure() { "structure" } else { "beam" }
        ));
    }
    for s in found.sensitivities {
        text.push_str(&format!(
            "\nderivatives by {} = {}\n",
            s.parameter.pointer,
            significant(s.parameter.value, 6)
        ));
        let derivatives = found.columns.iter().zip(&s.row).skip(1);
        let line = |(column, derivative): (&HistoryColumn, &f64)| {
            let by_share = 0.01 * s.parameter.value * derivative;
            let counts = by_share.abs() > floor(found, column.unit);
            let (derivative, by_share) = if counts { (*derivative, by_share) } else { (0.0, 0.0) };
            let (derivative, by_share) = (significant(derivative, 6), significant(by_share, 4));
            let words = format!("{0} per unit, {by_share} {0} per 1 %", column.unit);
            // omits bladders that do not change
            let changes = !is_bladder(column) || derivative != "0";
            changes.then(|| [String::new(), column.name.clone(), derivative, words])
        };
        let mut lines: Vec<_> = derivatives.filter_map(line).collect();
        let more = lines.len().saturating_sub(DERIVATIVES);
        lines.truncate(DERIVATIVES);
        text += &aligned(&lines, &[1, 3]);
        text += &if_any(more, |n| format!("  and {n} more in equilibrium.json\n"));
    }
    if let Some(accuracy) = found.accuracy {
        text.push('\n');
        text.push_str(&crate::output::accuracy::describe(accuracy));
    }
    text
}

/// Tip and pressures of the last state with their errors.
fn last_with_errors(found: &LoadPath) -> String {
    let row = found.path.states.last().map_or(&[][..], |state| &state.row);
    let error = |column: &HistoryColumn| found.meshes?.errors.get(&column.name).copied();
    let texts = found.columns.iter().zip(row).skip(1).filter_map(|(column, value)| {
        let shown = counts(found, column) && value.abs() > floor(found, column.unit);
        let error = error(column).filter(|_| shown)?;
        Some(format!("{} {}", column.name, with_error(*value, error, column.unit)))
    });
    match joined(texts, " · ") {
        all if all.is_empty() => all,
        all => format!("last state: {all}\n"),
    }
}

/// Largest number of beams of a structure whose tips are in the table.
const BEAMS: usize = 3;

/// True for quantities of the tip, in a structure of the tips of the first beams, and pressures.
fn counts(found: &LoadPath, column: &HistoryColumn) -> bool {
    let beams = &found.case.beams;
    if let Some((beam, what)) = tip_of_beam(&column.name) {
        let shown = beams.iter().take(BEAMS).any(|one| one.name == beam);
        return shown && ["u1", "u3", "angle"].contains(&what);
    }
    let group = Observable::named(&column.name).map(Observable::group);
    group == Some(Group::Pressure) || (group == Some(Group::Tip) && beams.is_empty())
}

/// Loads of the last state.
fn reached(found: &LoadPath, last: &EquilibriumState) -> String {
    let (share, at) = (significant(last.share, 6), |t: &f64| significant(*t, 6));
    let via: Vec<String> = found.options.via_s.iter().map(at).collect();
    if via.is_empty() {
        return format!("{share} of the loads at t = {} s", at(&found.options.at_s));
    }
    let stages = via.iter().cloned().chain([at(&found.options.at_s)]);
    let stages = stages.collect::<Vec<_>>().join(" s, ");
    format!(
        "{share} of stage {}, the loads at t = {stages} s one after the other",
        last.stage + 1
    )
}

/// Some of the states, the last among them.
fn table(found: &LoadPath) -> String {
    let shown = |(k, column): &(usize, &HistoryColumn)| *k == 0 || counts(found, column);
    let columns: Vec<_> = found.columns.iter().enumerate().filter(shown).collect();
    let states = &found.path.states;
    let every = states.len().div_ceil(ROWS).max(1);
    let mut shown: Vec<&EquilibriumState> = states.iter().rev().step_by(every).collect();
    shown.reverse();
    let headings: String = columns
        .iter()
        .map(|(_, c)| format!("{} [{}] | ", c.name, c.unit))
        .collect();
    let lines = shown.iter().map(|state| {
        let unstable = state.stability.as_ref().map_or("–".into(), |s| s.unstable.to_string());
        let numbers = columns.iter().map(|(k, column)| {
            let value = state.row[*k];
            let counts = *k == 0 || value.abs() > floor(found, column.unit);
            significant(if counts { value } else { 0.0 }, 6)
        });
        numbers.chain([unstable]).collect::<Vec<_>>()
    });
    columns::table(&format!("{headings}unstable"), lines)
}

/// True for the pressure of one bladder.
fn is_bladder(column: &HistoryColumn) -> bool {
    column.name.starts_with("bladder_") && column.unit == "Pa"
}

/// Round-off limit in a unit: a fraction of the largest value of all states, and at least a constant per unit.
fn floor(found: &LoadPath, unit: &str) -> f64 {
    let least = match unit {
        "m" => 0.01 * ROUND_OFF * found.case.beam.length_m,
        "rad" => 0.01 * ROUND_OFF,
        "Pa" => NO_PRESSURE,
        "N" => NO_FORCE,
        _ => 0.0,
    };
    // stresses of the solid share the unit of pressures, but are no measure of them
    let alike = |k: &usize| found.columns[*k].unit == unit && !is_stress(&found.columns[*k].name);
    let rows = found.path.states.iter().map(|state| &state.row);
    let all = rows.flat_map(|row| (1..row.len()).filter(alike).map(|k| ROUND_OFF * row[k].abs()));
    all.fold(least, f64::max)
}

/// True if no state has a displacement, angle, pressure or force.
fn loads_nothing(found: &LoadPath) -> bool {
    ["m", "rad", "Pa", "N"].iter().all(|unit| {
        let least = floor(found, unit);
        let columns = found.columns.iter().enumerate().skip(1);
        let mut alike = columns.filter(|(_, column)| column.unit == *unit && !is_stress(&column.name));
        alike.all(|(k, _)| found.path.states.iter().all(|state| state.row[k].abs() <= least))
    })
}
