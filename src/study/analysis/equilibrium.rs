//! Equilibria under the loads at the end of a case.

use super::derivatives::{GatheredDerivatives, until};
use super::{Analysis, AnalysisOutcome, AnalysisRequest, FoundSlopes, RunCase, StopCheck, accurate, errors};
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Code, Error, Result};
use crate::run::equilibrium::{self, EquilibriumOptions, Path};
use crate::run::record::HistoryColumn;
use crate::run::summary::Status;
use crate::run::{early_warnings, slow_fluid};
use crate::study::refine::{self, meshes, numbers};

/// Least number of points on a path of equilibria, as in the command.
const POINTS: usize = 16;

/// `slcbeam equilibrium`.
pub struct EquilibriumAnalysis;

impl Analysis for EquilibriumAnalysis {
    fn check(&self, case: &Case) -> Result<()> {
        equilibrium::system(case, case.time.end_s).map(|_| ())
    }

    /// Computes the equilibrium under the loads at the end.
    fn figures(&self, case: &Case, ask: AnalysisRequest, stop: StopCheck, _: RunCase) -> Result<AnalysisOutcome> {
        let options = at_the_end(case);
        let mut of = |case: &Case| numbers::of_equilibrium(case, &options);
        let refined = refine::if_asked(case, ask.accuracy, false, &mut of)?;
        let case = refined.as_ref().map_or(case, |(chosen, _)| chosen);
        let path = equilibrium::follow(case, &options, &mut until(stop))?;
        let system = equilibrium::system(case, options.at_s)?;
        let columns = equilibrium::columns(&system);
        let mut found = of_path(&columns, &path);
        let key = |name: &str| {
            let column = columns.iter().find(|column| column.name == name);
            column.map_or_else(|| name.into(), |column| column.key())
        };
        if let Some((_, accuracy)) = &refined {
            accurate(&mut found, accuracy, &key);
        } else if ask.meshes && path.fault.is_none() {
            let here = numbers::of_path(case, &columns, &path)?;
            let by_mesh = meshes::judge(case, &here, &mut of)?.with_effects(case, &here, &mut of)?;
            errors(&mut found, &by_mesh, &key);
        }
        found.warn(&early_warnings::at_rest(case, &system));
        found.warn(slow_fluid::warning(case, &system, options.at_s).as_slice());
        found.warn(&path.warnings());
        Ok(found)
    }

    fn names(&self, case: &Case) -> Result<Vec<String>> {
        let columns = equilibrium::columns(&equilibrium::system(case, case.time.end_s)?);
        let keys = columns.iter().map(|column| column.key());
        Ok(keys.filter(|key| key != "load_factor").collect())
    }

    fn derivatives(&self, case: &Case, parameters: &[Parameter], _: Option<&System>, stop: StopCheck) -> FoundSlopes {
        let options = at_the_end(case);
        let path = equilibrium::follow(case, &options, &mut until(stop))?;
        if let Some(fault) = path.fault {
            return Err(Error::Solver(Box::new(fault)));
        }
        let columns = equilibrium::columns(&equilibrium::system(case, options.at_s)?);
        let slopes = equilibrium::differentiate(case, &options, &path, parameters)?;
        let mut all = GatheredDerivatives::new(parameters.len());
        for (k, one) in slopes.iter().enumerate() {
            for (column, slope) in columns.iter().zip(&one.row) {
                all.put(k, column.key(), *slope);
            }
        }
        Ok((of_path(&columns, &path), all.whole()))
    }

    fn fault(&self) -> Code {
        Code::NoEquilibrium
    }

    fn is_in_time(&self) -> bool {
        false
    }
}

/// Options of the search for the equilibrium under the loads at the end of a case.
fn at_the_end(case: &Case) -> EquilibriumOptions {
    EquilibriumOptions {
        points: Some(POINTS),
        ..EquilibriumOptions::at(case.time.end_s)
    }
}

/// Figures of the last state of a path.
pub fn of_path(columns: &[HistoryColumn], path: &Path) -> AnalysisOutcome {
    let mut found = AnalysisOutcome {
        steps: Some(path.work.iterations),
        ..AnalysisOutcome::finished()
    };
    if let Some(fault) = &path.fault {
        found.status = Status::Failed;
        found.reason = Some(format!("{} {}", fault.code.id(), fault.what));
    }
    if let Some(last) = path.states.last() {
        for (column, value) in columns.iter().zip(&last.row) {
            found.put(column.key(), *value);
        }
        let stability = last.stability.as_ref();
        found.put("stable", stability.map(|s| f64::from(u8::from(s.unstable == 0))));
        found.put("unstable_modes", stability.map(|s| s.unstable as f64));
    }
    found
}
