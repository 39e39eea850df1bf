//! The energy ledger: energy at the start, added and removed energies, energy at the end.

use serde_json::{Value, json};

use super::history::ReportHistory;
use crate::discrete::quantities::{Group, Observable};
use crate::run::summary::Summary;

/// Entries of the ledger, and names of the columns drawn over time.
pub fn to_json(summary: &Summary, history: &ReportHistory) -> Value {
    let of = |groups: &[Group]| -> Vec<Observable> { groups.iter().copied().flat_map(Observable::grouped).collect() };
    let stored = of(&[Group::Stored]);
    let comes_in = of(&[Group::PutIn, Group::Added]);
    let goes_out = of(&[Group::Lost, Group::Harvested]);
    let at_end = |one: &Observable| summary.balances.energy_j.get(one.name()).copied().unwrap_or(0.0);
    let entries = |list: &[Observable], sign: f64| -> Vec<Value> {
        let known = list.iter().filter(|one| at_end(one) != 0.0);
        known
            .map(|one| json!({"name": one.name(), "words": one.describe(), "joule": sign * at_end(one)}))
            .collect()
    };
    let sum = |list: &[Observable]| list.iter().map(at_end).sum::<f64>();
    let before: Vec<f64> = stored.iter().filter_map(|one| Some(history.ends(*one)?.0)).collect();
    let start = (!before.is_empty()).then(|| before.iter().sum::<f64>());
    let now = sum(&stored);
    let expected = start.map(|s| s + sum(&comes_in) - sum(&goes_out));
    let names = |group: Group| Observable::grouped(group).map(Observable::name).collect::<Vec<_>>();
    json!({
        "start": start,
        "in": entries(&comes_in, 1.0),
        "out": entries(&goes_out, -1.0),
        "expected": expected,
        "stored": entries(&stored, 1.0),
        "now": now,
        "residual": expected.map(|e| now - e),
        "relative": Some(summary.balances.energy_residual_relative).filter(|x| x.is_finite()),
        "columns": {
            "in": names(Group::PutIn), "added": names(Group::Added), "stored": names(Group::Stored), "lost": names(Group::Lost),
            "harvested": names(Group::Harvested), "open": names(Group::Open),
        },
        "others": others(summary),
    })
}

/// Other balances as text; omits those that are exactly zero because they do not apply.
fn others(summary: &Summary) -> Vec<Value> {
    let b = &summary.balances;
    let all = [
        ("fluid volume", b.volume_residual_relative),
        ("flow through ports, against their law", b.port_flow_residual_relative),
        ("momentum", b.momentum_residual_relative),
        ("angular momentum", b.angular_momentum_residual_relative),
        (
            "reactions, against the sections (the mesh)",
            b.reaction_difference_relative,
        ),
    ];
    let shown = all.into_iter().filter(|(_, x)| *x != 0.0 && x.is_finite());
    shown.map(|(words, x)| json!({"words": words, "relative": x})).collect()
}
