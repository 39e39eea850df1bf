//! Solutions of cases given as JSON.

use std::path::Path;

use serde_json::Value;

use crate::case::{self, Case};
use crate::error::{Error, Result};
use crate::run::modes::{self, ModeOptions, Modes};
use crate::run::record::{Control, HistoryColumn, Memory};
use crate::run::{dynamics, equilibrium};

/// Checks a case.
///
/// # Errors
/// A case that is not valid.
pub fn parse(case: &Value) -> Result<Case> {
    case::parse(&case.to_string(), Path::new("verify.json"), Path::new(""), &[])
}

/// Recorded data of a run.
pub struct SolvedRun {
    memory: Memory,
}

/// Checks and runs a case.
///
/// # Errors
/// A case that is not valid, a solver that fails.
pub fn solve(case: &Value) -> Result<SolvedRun> {
    let case = parse(case)?;
    let mut memory = Memory::default();
    let outcome = dynamics::run(&case, &mut memory)?;
    match outcome.fault {
        Some(fault) => Err(Error::Solver(Box::new(fault))),
        None => Ok(SolvedRun { memory }),
    }
}

/// Checks a case and finds its slowest modes.
///
/// # Errors
/// A case that is not valid, eigenvalues that do not converge.
pub fn modes(case: &Value, count: usize) -> Result<Modes> {
    let case = parse(case)?;
    let plan = ModeOptions {
        count,
        near_hz: 0.0,
        limits: false,
    };
    modes::modes(&case, &plan)
}

impl SolvedRun {
    /// Returns a column of the history; empty if there is none of that name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        self.memory.column(name).unwrap_or_default()
    }

    /// Returns the last value of a column; NaN if there is none.
    pub fn last(&self, name: &str) -> f64 {
        self.column(name).last().copied().unwrap_or(f64::NAN)
    }

    /// Returns a field, one array per time; empty if there is none of that name.
    pub fn field(&self, name: &str) -> &[Vec<f64>] {
        self.memory.field(name).unwrap_or_default()
    }
}

/// A load path of equilibria.
pub struct SolvedPath {
    columns: Vec<HistoryColumn>,
    path: equilibrium::Path,
}

/// Checks a case and follows its equilibria from rest to `share` of the loads at the end of its run.
///
/// # Errors
/// A case that is not valid, a path that ends early.
pub fn balance(case: &Value, share: f64) -> Result<SolvedPath> {
    let case = parse(case)?;
    let at_s = case.time.end_s;
    let options = equilibrium::EquilibriumOptions {
        share,
        ..equilibrium::EquilibriumOptions::at(at_s)
    };
    let path = equilibrium::follow(&case, &options, &mut |_| Control::Continue)?;
    match path.fault {
        Some(fault) => Err(Error::Solver(Box::new(fault))),
        None => Ok(SolvedPath {
            columns: equilibrium::columns(&equilibrium::system(&case, at_s)?),
            path,
        }),
    }
}

impl SolvedPath {
    /// Returns a quantity in the last state; NaN if there is none of that name.
    pub fn last(&self, name: &str) -> f64 {
        let column = self.columns.iter().position(|c| c.name == name);
        column.map_or(f64::NAN, |k| self.path.last().row[k])
    }

    /// Share of the loads at the first bifurcation; NaN if there is none.
    pub fn bifurcation(&self) -> f64 {
        let mut events = self.path.events.iter();
        events
            .find(|e| e.kind == equilibrium::EventKind::Bifurcation)
            .map_or(f64::NAN, |e| e.share)
    }
}

/// Computes figures on three meshes of `cells`, `2 cells` and `4 cells`; returns the three values of each figure.
pub fn on_three_meshes<const N: usize>(
    cells: usize,
    values: impl Fn(usize) -> Result<[f64; N]>,
) -> Result<[[f64; 3]; N]> {
    let meshes = [values(cells)?, values(2 * cells)?, values(4 * cells)?];
    Ok(std::array::from_fn(|k| meshes.map(|mesh| mesh[k])))
}
