//! The program, cases, and data with noise.

use std::fs;

use serde_json::Value;
use slcbeam::case::parameter::with;
use slcbeam::case::{self, Case};
use slcbeam::numerics::normal;
use slcbeam::numerics::rng::Rng;
use slcbeam::run::equilibrium::{self, EquilibriumOptions};
use slcbeam::run::record::{Control, Memory};
use slcbeam::study::data::{DataTable, Match};
use slcbeam::study::fit::fit;
use slcbeam::study::fit::problem::{FitProblem, FitRequest};
use slcbeam::study::fit::robust::LossFunction;
use slcbeam::study::search_bounds::ParameterBounds;
use tempfile::TempDir;

pub use crate::program::say;

pub const PUMP: &str = "/network/chains/0/ends/0/pressure_pa";
pub const YOUNG: &str = "/beam/young_modulus_pa";
pub const OPENING: &str = "/bladders/area_per_moment_m2_per_n_m/opening";
pub const FORCE: &str = "/ends/tip/free/force_x_n";

pub fn well(arguments: &[&str]) -> String {
    let said = say(arguments);
    assert_eq!(said.code, 0, "{}\n{}", said.out, said.err);
    said.out
}

/// The result that a command prints.
pub fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&well(&[arguments, &["--json", "--quiet"]].concat())).expect("JSON")
}

pub fn path(dir: &TempDir, name: &str) -> String {
    dir.path().join(name).display().to_string()
}

pub fn file(dir: &TempDir, name: &str, text: &str) -> String {
    let path = path(dir, name);
    fs::write(&path, text).expect("written");
    path
}

pub fn load(name: &str, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    case::load(name.as_ref(), &sets).expect("a case")
}

/// A source of normal deviations.
pub fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut chance = Rng::new(seed, 7);
    move || normal::quantile(chance.share())
}

/// A quantity of the equilibrium with these numbers.
pub fn at_rest(case: &Case, changes: &[(&str, f64)], quantity: &str) -> f64 {
    let case = with(case, changes).expect("a case");
    let options = EquilibriumOptions::at(case.time.end_s);
    let path = equilibrium::follow(&case, &options, &mut |_| Control::Continue).expect("a path");
    assert!(path.fault.is_none());
    let columns = equilibrium::columns(&equilibrium::system(&case, options.at_s).expect("a system"));
    let place = columns
        .iter()
        .position(|column| column.name == quantity)
        .expect("a quantity");
    path.last().row[place]
}

/// Histories of a run.
pub fn run(case: &Case, changes: &[(&str, f64)]) -> Memory {
    let case = with(case, changes).expect("a case");
    let mut memory = Memory::default();
    slcbeam::run::dynamics::run(&case, &mut memory).expect("a run");
    memory
}

/// A number of a result.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Whether the estimate of a number lies within its interval, and how far from the truth in standard errors.
pub fn off(fit: &Value, number_of: usize, truth: f64) -> f64 {
    let one = &fit["parameters"][number_of];
    (number(&one["value"]) - truth).abs() / number(&one["standard_error"])
}

/// Fits two numbers to data, and counts which intervals of 95 % hold the truth.
pub fn count_held(case: &Case, asked: &FitRequest, data: &str, truth: [f64; 2], held: &mut [u32; 2]) {
    let table = DataTable::parse("data.csv".as_ref(), data).expect("a table");
    let problem = FitProblem::new(case, &table, asked).expect("a problem");
    let found = fit(&problem, asked, ("data.csv", 0), &|| false, &|_, _| {})
        .expect("a fit")
        .fit;
    for (k, held) in held.iter_mut().enumerate() {
        let [low, high] = found.parameters[k].interval_95.expect("an interval");
        *held += u32::from((low..=high).contains(&truth[k]));
    }
}

/// What is asked of a fit by squares, from one start: numbers between bounds, and columns that are matched.
pub fn by_squares(spans: &[(&str, f64, f64)], matches: &[&str]) -> FitRequest {
    let span = |(pointer, low, high): &(&str, f64, f64)| ParameterBounds {
        pointer: (*pointer).into(),
        low: *low,
        high: *high,
    };
    FitRequest {
        spans: spans.iter().map(span).collect(),
        matches: matches
            .iter()
            .map(|text| Match::parse(text).expect("a match"))
            .collect(),
        time: None,
        drives: vec![],
        input: None,
        noise: vec![],
        loss: LossFunction::Squares,
        starts: 1,
        jobs: 1,
    }
}
