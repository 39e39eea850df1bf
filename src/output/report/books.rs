//! The energy ledger: what was there, what came in, what went out, what is there now.

use serde_json::{Value, json};

use super::history::History;
use crate::run::summary::Summary;

/// Stored energies, in the order of the columns.
const STORED: [(&str, &str); 5] = [
    ("kinetic_energy", "motion of the beam"),
    ("rotary_energy", "rotation of its sections"),
    ("axial_energy", "stretch"),
    ("bending_energy", "bending"),
    ("bladder_energy", "bladders"),
];

/// What comes in.
const IN: [(&str, &str); 5] = [
    ("work_loads", "work of the loads"),
    ("work_ends", "work of the driven ends"),
    ("work_ports", "work of the ports"),
    ("work_formulation", "added by the published momentum balance"),
    ("work_reciprocity", "added by a coupling without reciprocity"),
];

/// What goes out.
const OUT: [(&str, &str); 5] = [
    ("dissipated_bladders", "lost to flow in the bladders"),
    ("dissipated_tubes", "lost to flow in the tubes"),
    ("dissipated_rectifiers", "lost in check valves"),
    ("dissipated_damping", "lost to damping"),
    ("harvested", "harvested by the turbines"),
];

/// Entries that add up, and the names of the columns that are drawn over time.
pub fn of(summary: &Summary, history: &History) -> Value {
    let energies = &summary.balances.energy_j;
    let at_end = |name: &str| energies.get(name).copied().unwrap_or(0.0);
    let entries = |list: &[(&str, &str)], sign: f64| -> Vec<Value> {
        let known = list
            .iter()
            .filter(|(name, _)| energies.get(*name).is_some_and(|e| *e != 0.0));
        known
            .map(|(name, words)| json!({"name": name, "words": words, "joule": sign * at_end(name)}))
            .collect()
    };
    let sum = |list: &[(&str, &str)]| list.iter().map(|(name, _)| at_end(name)).sum::<f64>();
    let before: Vec<f64> = STORED
        .iter()
        .filter_map(|(name, _)| Some(history.ends(name)?.0))
        .collect();
    let start = (!before.is_empty()).then(|| before.iter().sum::<f64>());
    let stored = sum(&STORED);
    let (came, went) = (sum(&IN), sum(&OUT));
    let expected = start.map(|s| s + came - went);
    let names = |list: &[(&'static str, &str)]| list.iter().map(|e| e.0).collect::<Vec<_>>();
    json!({
        "start": start,
        "in": entries(&IN, 1.0),
        "out": entries(&OUT, -1.0),
        "expected": expected,
        "stored": entries(&STORED, 1.0),
        "now": stored,
        "residual": expected.map(|e| stored - e),
        "relative": finite(summary.balances.energy_residual_relative),
        "columns": {"in": names(&IN), "out": names(&OUT), "stored": names(&STORED)},
        "others": others(summary),
    })
}

fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

/// The other balances, in words; those that do not apply are exactly zero.
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
