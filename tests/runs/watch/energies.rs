//! Energies of a made-up history: what of them the balance carries.

use std::collections::BTreeMap;

use slcbeam::discrete::quantities::{Observable, Row};
use slcbeam::run::energies::Energies;
use slcbeam::run::summary::Quantity;

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

fn followed(rows: &[[f64; 8]]) -> (Energies, BTreeMap<String, Quantity>) {
    let mut energies = serde_json::to_value(Energies::default()).unwrap();
    energies["window_start"] = 1.0.into();
    energies["turbines"] = true.into();
    let mut energies: Energies = serde_json::from_value(energies).unwrap();
    let mut row = Row::new(COLUMNS.to_vec(), [0, 0]);
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
    energies.complete(&mut quantities);
    (energies, quantities)
}

/// Goal: what is stored does not count as put in or lost, and an open balance is seen relative to the figures, not to what
/// is stored: 1 J of 100 J stored, but a quarter of the 4 J put in.
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
    assert!(words.starts_with("W020") && words.contains("in the window"), "{words}");
    assert!(!words.contains("the energy put in over the run"), "{words}");
}

/// A quotient above one says whose energy it is.
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
