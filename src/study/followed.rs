//! Columns of a run at chosen instants, with their derivatives.

use crate::error::{Error, Result};
use crate::run::dynamics::Outcome;
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::run::summary::{Status, Summary};

/// A row: the value of each column, and for each parameter the derivatives of all columns.
pub type FollowedRow = (Vec<f64>, Vec<Vec<f64>>);

/// Recorder of chosen columns of a run.
pub struct ColumnRecorder<'a> {
    /// Names of the columns.
    names: &'a [String],
    /// Names of the parameters of the derivatives.
    by: &'a [&'a str],
    /// Number of rows to record; the run may end after the last.
    count: usize,
    /// Stop request, checked at every step.
    stop: &'a dyn Fn() -> bool,
    places: Vec<usize>,
    slopes: Vec<Vec<usize>>,
    rows: Vec<FollowedRow>,
}

impl<'a> ColumnRecorder<'a> {
    /// Records `count` rows of columns, with derivatives.
    pub fn new(names: &'a [String], by: &'a [&'a str], count: usize, stop: &'a dyn Fn() -> bool) -> Self {
        Self {
            names,
            by,
            count,
            stop,
            places: vec![],
            slopes: vec![],
            rows: vec![],
        }
    }

    /// Rows of a completed run.
    ///
    /// # Errors
    /// The run ended before the last row.
    pub fn rows(self, outcome: Outcome) -> Result<Vec<FollowedRow>> {
        if self.rows.len() == self.count && self.rows.iter().all(|row| row.1.len() == self.by.len()) {
            return Ok(self.rows);
        }
        let Summary { status, reason, .. } = outcome.summary;
        let reason = reason.unwrap_or_else(|| "the run ended before the last measurement".into());
        Err(match outcome.fault {
            Some(fault) => Error::Solver(Box::new(fault)),
            None if status == Status::Stopped => Error::Interrupted(reason),
            None => Error::Usage(reason),
        })
    }
}

impl Recorder for ColumnRecorder<'_> {
    fn begin(&mut self, header: &Header) -> Result<()> {
        let missing = |name: &str| Error::Usage(format!("the run has no {name} at these values"));
        for name in self.names {
            let place = header.columns.iter().position(|column| column.name == *name);
            self.places.push(place.ok_or_else(|| missing(name))?);
        }
        for number in self.by {
            let of = |name: &String| {
                let begin = format!("d {name}/d {number} [");
                let place = header.sensitivities.iter().position(|own| own.starts_with(&begin));
                place.ok_or_else(|| missing(&format!("derivative of {name}")))
            };
            self.slopes.push(self.names.iter().map(of).collect::<Result<_>>()?);
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
        Ok(match ((self.stop)(), self.rows.len() < self.count) {
            (true, _) => Control::Stop("interrupted".into()),
            (_, true) => Control::Continue,
            (_, false) => Control::Stop("all measurement times are simulated".into()),
        })
    }
}
