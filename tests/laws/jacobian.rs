//! The Jacobian against coloured central differences, at random states on both sides of every kink.
//!
//! Goal: the exact derivatives used by Newton's method belong to the residual that is solved.

use std::fmt::Display;

use crate::differences::worst_difference;
use slcbeam::case::schema::Load;
use slcbeam::case::{self, Case};
use slcbeam::dae::BeamDae;
use slcbeam::discrete::System;
use slcbeam::error::Error;

/// Checks the Jacobian of a case at three random states.
pub fn agrees(case: &Case, what: impl Display) {
    let mut dae = BeamDae::new(System::new(case).unwrap());
    for seed in 1..4 {
        let worst = worst_difference(&mut dae, seed, 0.1);
        assert!(worst < 1e-6, "{what}: {worst:.1e}");
    }
}

#[test]
fn jacobian_agrees_with_coloured_differences_on_every_case() {
    let mut failures = vec![];
    let mut files: Vec<_> = std::fs::read_dir("cases")
        .unwrap()
        .map(|f| f.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "json") && p.file_stem().unwrap() != "schema")
        .collect();
    files.sort();
    assert!(!files.is_empty());
    for path in files {
        for sets in [
            vec![],
            vec!["/formulation=\"conservative\"".to_string()],
            vec!["/formulation=\"published\"".to_string()],
            vec!["/mesh/order=4".to_string()],
            vec!["/mesh/order=4".to_string(), "/formulation=\"conservative\"".to_string()],
        ] {
            let written = case::load(&path, &[]).unwrap();
            let nonlinear = written.bladders.as_ref().is_some_and(|b| b.strain_energy.is_some());
            let unlike = written.bladders.as_ref().is_some_and(|b| !b.lower.is_mirrored());
            let structure = written.is_structure();
            let conservative =
                unlike || structure || written.rotating_frame.is_some() || written.loads.iter().any(Load::is_rest);
            if (nonlinear || conservative) && sets.iter().any(|set| set.contains("published")) {
                continue;
            }
            if structure && sets.iter().any(|set| set.contains("order")) {
                continue;
            }
            let case = case::load(&path, &sets).unwrap();
            let system = match System::new(&case) {
                Err(Error::Case(refused)) if sets.iter().any(|set| set.contains("order")) => {
                    assert!(
                        refused.violations.iter().all(|v| v.pointer == "/mesh/order"),
                        "{refused:?}"
                    );
                    continue;
                }
                system => system.unwrap(),
            };
            let mut dae = BeamDae::new(system);
            // an energy at finite strain is known for states of a certain size
            let part = if nonlinear { 0.1 } else { 1.0 };
            for (seed, size) in [(1, 1.0), (2, 0.3), (3, 0.03)].map(|(seed, size)| (seed, part * size)) {
                let worst = worst_difference(&mut dae, seed, size);
                println!("{} {sets:?} {size}: {worst:.1e}", path.display());
                if worst > 1e-6 {
                    failures.push(format!("{} {sets:?} size {size}: {worst:.2e}", path.display()));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
