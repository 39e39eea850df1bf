//! Monitoring of a run: its warnings, error bars and extrema, apart from its results.

mod energies;
mod error_bands;
mod error_bars;
mod probes;
#[path = "../common/scene.rs"]
mod scene;
mod step_response;
mod stuck;
mod told;
mod unphysical;
mod watch;
mod waves;

use std::path::Path;

use slcbeam::case::{self, Case};
use slcbeam::run::dynamics;
use slcbeam::run::record::Memory;
use slcbeam::run::summary::{Status, Summary};

/// A shipped case with changes.
fn shipped(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|s| s.to_string()).collect();
    case::load(Path::new(&format!("cases/{name}.json")), &sets).unwrap()
}

/// Runs a case to its end.
fn run(case: &Case) -> Summary {
    let summary = dynamics::run(case, &mut Memory::default()).unwrap().summary;
    assert_eq!(summary.status, Status::Finished, "{:?}", summary.reason);
    summary
}
