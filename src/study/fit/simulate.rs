//! What a case gives beside each measured value, with its derivatives by the numbers that are sought: IDA's sensitivities of a run, read off
//! at the instants of the data [E41], and those of equilibria [E43].

use nalgebra::DMatrix;

use super::problem::{Abscissa, Drive, Problem};
use crate::case::parameter::with;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::run::dynamics;
use crate::run::equilibrium::{self, Options};
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::study::slopes;
use crate::study::sweep::pool;

/// What a case gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulated {
    /// Beside each observation, in its unit.
    pub values: Vec<f64>,
    /// Derivatives by each number, per unit of it.
    pub slopes: DMatrix<f64>,
}

/// A row: a value of each matched column, and derivatives by each number.
type Row = (Vec<f64>, Vec<Vec<f64>>);

/// Simulates a problem with values of its numbers.
///
/// # Errors
/// The case is none with them, or is not simulated to the end of the data.
pub fn simulate(problem: &Problem, values: &[f64], jobs: usize) -> Result<Simulated> {
    let rows = match &problem.abscissa {
        Abscissa::Time(instants) => run(problem, values, instants)?,
        Abscissa::Drives(drives) => rest(problem, values, drives, jobs)?,
    };
    let all = &problem.observations;
    let value = |one: &super::problem::Observation| rows[one.row].0[one.of];
    Ok(Simulated {
        values: all.iter().map(value).collect(),
        slopes: DMatrix::from_fn(all.len(), values.len(), |i, k| rows[all[i].row].1[k][all[i].of]),
    })
}

fn run(problem: &Problem, values: &[f64], instants: &[f64]) -> Result<Vec<Row>> {
    let case = problem.with(values)?;
    // effects stay those of the case itself: a sum of squares must not jump where another would be chosen
    let system = slopes::alike_or_own(&case, Some(&System::new(&problem.case)?))?;
    let parameters = problem.parameters(values);
    let mut recorder = Rows {
        problem,
        places: vec![],
        slopes: vec![],
        rows: vec![],
    };
    let outcome = dynamics::run_at(&case, system, &parameters, instants, &mut recorder)?;
    let rows = recorder.rows;
    if rows.len() == instants.len() && rows.iter().all(|row| !row.1.is_empty()) {
        return Ok(rows);
    }
    Err(match outcome.fault {
        Some(fault) => Error::Solver(Box::new(fault)),
        None => Error::Usage(
            outcome
                .summary
                .reason
                .unwrap_or_else(|| "the run ended before the data".into()),
        ),
    })
}

/// Keeps the rows of a run.
struct Rows<'a> {
    problem: &'a Problem,
    places: Vec<usize>,
    slopes: Vec<Vec<usize>>,
    rows: Vec<Row>,
}

impl Recorder for Rows<'_> {
    fn begin(&mut self, header: &Header) -> Result<()> {
        let missing = |name: &str| Error::Usage(format!("the run has no {name} with these numbers"));
        for one in &self.problem.matched {
            let place = header.columns.iter().position(|column| column.name == one.name);
            self.places.push(place.ok_or_else(|| missing(&one.name))?);
        }
        for span in &self.problem.spans {
            let of = |name: &str| {
                let begin = format!("d {name}/d {} [", span.pointer);
                let place = header.sensitivities.iter().position(|own| own.starts_with(&begin));
                place.ok_or_else(|| missing(&format!("derivative of {name}")))
            };
            let places = self.problem.matched.iter().map(|one| of(&one.name));
            self.slopes.push(places.collect::<Result<_>>()?);
        }
        Ok(())
    }

    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.rows.push((self.places.iter().map(|k| row[*k]).collect(), vec![]));
        Ok(())
    }

    fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        let of = |places: &Vec<usize>| places.iter().map(|k| row[*k]).collect();
        if let Some(last) = self.rows.last_mut() {
            last.1 = self.slopes.iter().map(of).collect();
        }
        Ok(())
    }

    fn fields(&mut self, _: f64, _: &[&[f64]]) -> Result<()> {
        Ok(())
    }

    fn progress(&mut self, _: &Progress) -> Result<Control> {
        Ok(match self.rows.len() < self.problem.rows() {
            true => Control::Continue,
            false => Control::Stop("all instants of the data are passed".into()),
        })
    }
}

/// Every row an equilibrium of its own; as many at once as there are jobs.
fn rest(problem: &Problem, values: &[f64], drives: &[(Drive, Vec<f64>)], jobs: usize) -> Result<Vec<Row>> {
    let numbers: Vec<usize> = (0..problem.rows()).collect();
    let mut rows: Vec<Option<Row>> = vec![None; numbers.len()];
    pool::each(
        &numbers,
        jobs,
        &|row| Some((row, of_row(problem, values, drives, row))),
        &mut |(row, found)| {
            rows[row] = Some(found?);
            Ok(())
        },
    )?;
    Ok(rows.into_iter().flatten().collect())
}

fn of_row(problem: &Problem, values: &[f64], drives: &[(Drive, Vec<f64>)], row: usize) -> Result<Row> {
    let driven = drives
        .iter()
        .map(|(drive, values)| (drive.pointer.as_str(), values[row]));
    let changes: Vec<(&str, f64)> = problem.changes(values).chain(driven).collect();
    let case = with(&problem.case, &changes)?;
    let options = Options {
        points: Some(1),
        ..Options::at(case.time.end_s)
    };
    let path = equilibrium::follow(&case, &options, &mut |_| Control::Continue)?;
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
