//! Energies of a synthetic history: which of them the balance supports.

use std::collections::BTreeMap;

use serde_json::json;
use slcbeam::discrete::quantities::{Observable, ObservableRow};
use slcbeam::run::dynamics;
use slcbeam::run::energies::EnergyAccumulator;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{MissingRatio, Quantity};

const COLUMNS: [Observable; 8] = [
    Observable::Time,
    Observable::KineticEnergy,
    Observable::WorkLoads,
    Observable::Harvested,
    Observable::DissipatedTubes,
    Observable::WorkReciprocity,
    Observable::WorkFormulation,
    Observable::EnergyResidual,
];

fn followed(rows: &[[f64; 8]]) -> (EnergyAccumulator, BTreeMap<String, Quantity>) {
    let mut energies = serde_json::to_value(EnergyAccumulator::default()).unwrap();
    energies["window_start"] = 1.0.into();
    energies["turbines"] = true.into();
    let mut energies: EnergyAccumulator = serde_json::from_value(energies).unwrap();
    let mut row = ObservableRow::new(COLUMNS.to_vec(), [0, 0]);
    for values in rows {
        for (column, value) in COLUMNS.into_iter().zip(values) {
            row.set(column, *value);
        }
        energies.take(&row);
    }
    let (first, last) = (&rows[1], &rows[rows.len() - 1]);
    let energy = |k: usize| Quantity {
        last: Some(last[k]),
        window: Some(last[k] - first[k]),
        ..Quantity::default()
    };
    let mut quantities = BTreeMap::from([
        ("input_energy_j".to_string(), energy(2)),
        ("harvested_energy_j".to_string(), energy(3)),
        (
            "efficiency".to_string(),
            Quantity {
                last: Some(last[3] / last[2]),
                window: Some((last[3] - first[3]) / (last[2] - first[2])),
                ..Quantity::default()
            },
        ),
    ]);
    energies.complete(&mut quantities, 1e-6);
    (energies, quantities)
}

/// Goal: stored energy does not count as input or loss. An open balance is judged relative to the figures, not to the stored energy: 1 J of
/// 100 J stored, but a quarter of the 4 J input.
#[test]
fn the_window_counts_what_was_spent() {
    let (energies, all) = followed(&[
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 100.0, 101.0, 0.5, 0.5, 0.0, 0.0, 0.0],
        [2.0, 100.0, 105.0, 1.5, 4.5, 0.0, 0.0, 1.0],
    ]);
    let q = &all["efficiency"];
    assert_eq!(q.window, Some(0.2));
    assert_eq!(q.window_error, Some(0.2));
    assert_eq!(all["input_energy_j"].window_error, Some(0.25));
    assert_eq!(all["input_energy_j"].final_error, Some(1.0 / 105.0));
    let words = energies.warning(&all).expect("a warning");
    let named = "energy put in 4.000 J in the window (balance error 25 %)";
    assert!(words.starts_with("W020") && words.contains(named), "{words}");
    assert!(!words.contains("105.0 J over the run"), "{words}");
}

/// An efficiency above one names the origin of the energy.
#[test]
fn an_efficiency_above_one_is_explained() {
    let start = [0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let (energies, all) = followed(&[start, start, [2.0, 2.0, 1.0, 5.0, 4.0, 0.0, 0.0, 0.0]]);
    assert!(energies.warning(&all).expect("5 of 1 J").contains("stored before"));
    let (energies, all) = followed(&[start, start, [2.0, 10.0, 4.0, 5.0, 4.0, 5.0, 0.0, 0.0]]);
    assert!(energies.warning(&all).expect("5 of 4 J").contains("published"));
    let (energies, all) = followed(&[start, start, [2.0, 10.0, 9.0, 5.0, 4.0, 0.0, 0.0, 0.0]]);
    assert_eq!(energies.warning(&all), None);
}

/// Goal: an efficiency whose energies are numerical error, here of an idle turbine, has a reason instead of a value.
#[test]
fn an_idle_turbine_has_no_efficiency() {
    let row = |sign: i64| json!((1..=10).map(|k| sign * k).collect::<Vec<i64>>());
    let case = json!({
        "name": "idle", "preset": "matia-gat-beam", "bladders": {"coupling": "reciprocal"},
        "network": {
            "chains": [{"bladders": row(1), "ends": ["connected", "sealed"]}, {"bladders": row(-1), "ends": ["connected", "sealed"]}],
            "turbines": [{"name": "t", "from": {"bladder": 1, "end": "inlet"}, "to": {"bladder": -1, "end": "inlet"},
                          "conductance": {"m3_s_pa": 1e-9}, "rectifier": "ideal"}]
        },
        "time": {"end_s": 0.5, "output_interval_s": 0.0025}, "ends": {"root": "clamped", "tip": "free"},
        "fluid": {"viscosity_pa_s": 0.01, "density_kg_m3": 1000, "bulk_modulus_pa": 2e9},
        "loads": [{"gravity": {"x_m_s2": -9.81}}], "start": {"equilibrium": {"loads_at_s": 0}}
    });
    let path = std::path::Path::new("idle.json");
    let case = slcbeam::case::parse(&case.to_string(), path, std::path::Path::new(""), &[]).expect("a case");
    let summary = dynamics::run(&case, &mut Memory::default()).expect("a run").summary;
    let q = summary.quantities["efficiency"];
    assert_eq!(
        (q.last, q.window, q.final_error, q.window_error),
        (None, None, None, None)
    );
    assert_eq!(
        (q.final_absent, q.window_absent),
        (
            Some(MissingRatio::BelowNumericalError),
            Some(MissingRatio::BelowNumericalError)
        )
    );
    assert!(
        !summary.warnings.iter().any(|warning| warning.starts_with("W020")),
        "{:?}",
        summary.warnings
    );
    let words = slcbeam::cli::summary_box::render(&summary, std::path::Path::new("out"), false, false, 100);
    assert!(
        words.contains("no efficiency") && !words.contains("efficiency 7"),
        "{words}"
    );
}
