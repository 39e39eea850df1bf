//! Cases from text, and runs in memory.

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::run::dynamics::{self, Outcome};
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// A beam of 8 cells; root and time are placeholders.
pub const BEAM: &str = r#"{"name": "watched",
  "beam": {"length_m": 0.1, "height_m": 0.0216, "width_m": 0.05, "young_modulus_pa": 2e6, "density_kg_m3": 950,
           "damping": {"bending_time_s": 2e-3, "axial_time_s": 2e-3}},
  "mesh": {"segments": 4, "cells_per_segment": 2},
  "ends": {"root": "clamped", "tip": "free"},
  "time": {"end_s": 1}}"#;

/// Bending stiffness of [`BEAM`] [N m^2].
pub const EI: f64 = 2e6 * 0.05 * 0.0216 * 0.0216 * 0.0216 / 12.0;
/// Half its height [m].
pub const HALF: f64 = 0.0108;

/// A case from its text with changes.
pub fn written(text: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_string()).collect();
    match case::parse(text, Path::new("test.json"), Path::new("cases"), &sets) {
        Ok(case) => case,
        Err(slcbeam::error::Error::Case(fault)) => panic!("{}", case::render(&fault, false, 100)),
        Err(other) => panic!("{other}"),
    }
}

/// A shipped case with changes.
pub fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_string()).collect();
    match case::load(Path::new(&format!("cases/{name}.json")), &sets) {
        Ok(case) => case,
        Err(slcbeam::error::Error::Case(fault)) => panic!("{}", case::render(&fault, false, 100)),
        Err(other) => panic!("{other}"),
    }
}

/// Runs a case to any end, also a failure.
pub fn ended(case: &Case) -> (Outcome, Memory) {
    let mut memory = Memory::default();
    let outcome = dynamics::run(case, &mut memory).expect("a recorder in memory does not fail");
    (outcome, memory)
}

/// Runs a case that must finish.
pub fn finished(case: &Case) -> Summary {
    let (outcome, _) = ended(case);
    let s = outcome.summary;
    assert_eq!(s.status, Status::Finished, "{}: {:?}", s.case, s.reason);
    println!(
        "{}: {} steps; energy {:.1e}, momentum {:.1e}, angular {:.1e}, port flow {:.1e}, reactions {:.1e}; {:?}",
        s.case,
        s.solver.steps,
        s.balances.energy_residual_relative,
        s.balances.momentum_residual_relative,
        s.balances.angular_momentum_residual_relative,
        s.balances.port_flow_residual_relative,
        s.balances.reaction_difference_relative,
        s.warnings
    );
    s
}

/// The warning with the given number, if the run has it.
pub fn warning<'a>(summary: &'a Summary, id: &str) -> Option<&'a str> {
    summary.warnings.iter().map(String::as_str).find(|w| w.starts_with(id))
}

/// The number after `before` in a text.
pub fn number_after(text: &str, before: &str) -> f64 {
    let rest = text
        .split(before)
        .nth(1)
        .unwrap_or_else(|| panic!("no {before:?} in {text}"));
    let end = rest.find([' ', ')', ',', ';']).unwrap_or(rest.len());
    rest[..end]
        .parse()
        .unwrap_or_else(|_| panic!("no number after {before:?} in {text}"))
}
