//! Simulated value for each measured one, with derivatives with respect to the fitted numbers: IDA's sensitivities of a
//! run, evaluated at the instants of the data [E41], those of equilibria [E43] and of frequency responses [E98].

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use super::abscissa::{AMPLITUDE, Abscissa, DrivenNumber, PHASE};
use super::problem::{FitProblem, Observation};
use crate::case::parameter::with;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::run::dynamics;
use crate::run::equilibrium::{self, EquilibriumOptions};
use crate::run::record::Control;
use crate::run::response::LinearResponse;
use crate::run::response::sensitivity::ResponseJet;
use crate::run::sensitivity::forward::DerivativeParameters;
use crate::run::stop::INTERRUPTED;
use crate::study::analysis::derivatives;
use crate::study::followed::{ColumnRecorder, FollowedRow};
use crate::study::response::derivatives::{at_frequencies, equation_slopes};
use crate::study::sweep::pool;

/// Result of a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// Value for each observation, in its unit.
    pub values: Vec<f64>,
    /// Derivatives with respect to each number, per unit of it.
    pub slopes: DMatrix<f64>,
}

/// Simulates a problem with values of its numbers.
///
/// # Errors
/// The case is not valid with them, or the simulation does not reach the end of the data, for example because of
/// `stop`.
pub fn simulate(
    problem: &FitProblem,
    values: &[f64],
    jobs: usize,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Simulated> {
    let compute = || {
        let found = computed(problem, values, jobs, stop)?;
        Ok((found.values, found.slopes.as_slice().to_vec()))
    };
    let (beside, slopes) = problem.evaluations.try_get(&values, stop, compute)?;
    Ok(Simulated {
        slopes: DMatrix::from_vec(beside.len(), values.len(), slopes),
        values: beside,
    })
}

fn computed(problem: &FitProblem, values: &[f64], jobs: usize, stop: &(dyn Fn() -> bool + Sync)) -> Result<Simulated> {
    let rows = match &problem.abscissa {
        Abscissa::Time(instants) => run(problem, values, instants, stop)?,
        Abscissa::Drives(drives) => rest(problem, values, drives, jobs, stop)?,
        Abscissa::Frequencies(input, frequencies) => respond(problem, values, input, frequencies)?,
    };
    let all = &problem.observations;
    let value = |one: &Observation| {
        let value = rows[one.row].0[one.of];
        match problem.matched[one.of].name.ends_with(&format!(".{PHASE}")) {
            // a phase has no full turns: that nearest to the measured one
            true => value + TAU * ((one.value - value) / TAU).round(),
            false => value,
        }
    };
    Ok(Simulated {
        values: all.iter().map(value).collect(),
        slopes: DMatrix::from_fn(all.len(), values.len(), |i, k| rows[all[i].row].1[k][all[i].of]),
    })
}

fn run(
    problem: &FitProblem,
    values: &[f64],
    instants: &[f64],
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<FollowedRow>> {
    let case = problem.with(values)?;
    // keep the effects of the case itself: the sum of squares must not jump where others would be chosen
    let system = derivatives::alike_or_own(&case, Some(&System::new(&problem.case)?))?;
    let parameters = problem.parameters(values);
    let names: Vec<String> = problem.matched.iter().map(|one| one.name.clone()).collect();
    let by: Vec<&str> = parameters.iter().map(|parameter| parameter.pointer.as_str()).collect();
    let mut recorder = ColumnRecorder::new(&names, &by, problem.rows(), stop);
    let outcome = dynamics::run_at(
        &case,
        system,
        DerivativeParameters::pointers(&parameters),
        instants,
        &mut recorder,
    )?;
    recorder.rows(outcome)
}

/// Computes an equilibrium for every row, up to `jobs` in parallel.
fn rest(
    problem: &FitProblem,
    values: &[f64],
    drives: &[(DrivenNumber, Vec<f64>)],
    jobs: usize,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Vec<FollowedRow>> {
    let numbers: Vec<usize> = (0..problem.rows()).collect();
    let mut rows: Vec<Option<FollowedRow>> = vec![None; numbers.len()];
    pool::each(
        &numbers,
        jobs,
        &|row| Some((row, of_row(problem, values, drives, row, stop))),
        &mut |(row, found)| {
            rows[row] = Some(found?);
            Ok(())
        },
    )?;
    Ok(rows.into_iter().flatten().collect())
}

fn of_row(
    problem: &FitProblem,
    values: &[f64],
    drives: &[(DrivenNumber, Vec<f64>)],
    row: usize,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<FollowedRow> {
    if stop() {
        return Err(Error::Interrupted(INTERRUPTED.into()));
    }
    let driven = drives
        .iter()
        .map(|(drive, values)| (drive.pointer.as_str(), values[row]));
    let changes: Vec<(&str, f64)> = problem.changes(values).chain(driven).collect();
    let case = with(&problem.case, &changes)?;
    let options = EquilibriumOptions {
        points: Some(1),
        ..EquilibriumOptions::at(case.time.end_s)
    };
    let path = equilibrium::follow(&case, &options, &mut |_| match stop() {
        true => Control::Stop(INTERRUPTED.into()),
        false => Control::Continue,
    })?;
    if stop() {
        return Err(Error::Interrupted(INTERRUPTED.into()));
    }
    if let Some(fault) = path.fault {
        return Err(Error::Solver(Box::new(fault)));
    }
    let slopes = equilibrium::differentiate(&case, &options, &path, &problem.parameters(values))?;
    let of = |row: &[f64]| problem.matched.iter().map(|one| row[one.index]).collect::<Vec<f64>>();
    Ok((
        of(&path.last().row),
        slopes.iter().map(|slope| of(&slope.row)).collect(),
    ))
}

/// Solves the linear equations at every frequency.
fn respond(problem: &FitProblem, values: &[f64], input: &str, frequencies: &[f64]) -> Result<Vec<FollowedRow>> {
    let case = problem.with(values)?;
    let outputs = problem.outputs();
    let response = LinearResponse::new(&case, input, &outputs, None)?;
    let slopes = equation_slopes(&case, None, &response, &problem.parameters(values))?;
    let places: Vec<(usize, bool)> = problem
        .matched
        .iter()
        .filter_map(|one| {
            let (output, figure) = one.name.rsplit_once('.')?;
            let place = outputs.iter().position(|own| own == output)?;
            Some((place, figure == AMPLITUDE))
        })
        .collect();
    let row = |jets: &Vec<ResponseJet>| {
        let value = |(place, amplitude): &(usize, bool)| match amplitude {
            true => jets[*place].value.norm(),
            false => jets[*place].value.arg(),
        };
        let slope = |k: usize, (place, amplitude): &(usize, bool)| {
            let relative = jets[*place].slopes[k][0] / jets[*place].value;
            match amplitude {
                true => relative.re * jets[*place].value.norm(),
                false => relative.im,
            }
        };
        let slopes = (0..values.len()).map(|k| places.iter().map(|one| slope(k, one)).collect());
        (places.iter().map(value).collect(), slopes.collect())
    };
    Ok(at_frequencies(&response, frequencies, &slopes)?
        .iter()
        .map(row)
        .collect())
}
