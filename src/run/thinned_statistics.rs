//! Statistics over thinned outputs: least, greatest and mean value of each column over a stretch of time.

use serde::{Deserialize, Serialize};

use super::record::HistoryColumn;
use super::schedule::SAME;
use crate::case::schema::Case;
use crate::model::characteristic;

/// Largest number of stretches of a run; in longer runs each stretch has several cycles.
const MOST: f64 = 2000.0;
/// Number of stretches of a run that is not driven at a frequency.
const PARTS: f64 = 1000.0;
/// Fraction of a stretch within which an output belongs to the next one.
const EDGE: f64 = 1e-6;

/// Columns before those of the history: first and last output time, and the number of outputs.
const OWN: [&str; 3] = ["from [s]", "to [s]", "outputs [1]"];

/// Names of the columns, units included; three for each column of the history.
pub fn names(columns: &[HistoryColumn]) -> Vec<String> {
    let of = |c: &HistoryColumn| ["least", "greatest", "mean"].map(|what| format!("{} {what} [{}]", c.name, c.unit));
    let own = OWN.map(String::from);
    own.into_iter().chain(columns.iter().skip(1).flat_map(of)).collect()
}

/// Division of a run into stretches.
#[derive(Clone, Copy, Debug)]
pub struct ThinningIntervals {
    length: f64,
    /// Start of the window [s], where the stretches end.
    end: f64,
}

impl ThinningIntervals {
    /// Stretches of one drive cycle, or several in long runs; equal parts of a run without a drive.
    pub fn new(case: &Case) -> Self {
        let (end, window) = (case.time.end_s, case.time.window());
        let cycle = characteristic::forcing_period(case).filter(|period| *period > 0.0 && *period < end);
        let cycle = cycle.unwrap_or(end / PARTS);
        Self {
            length: cycle * (end / cycle / MOST).ceil().max(1.0),
            end: end - window * (1.0 + SAME),
        }
    }

    /// Number of stretches.
    pub fn count(&self) -> f64 {
        (self.end / self.length).max(0.0).ceil()
    }

    /// Number of the stretch that contains time `t` [s]; `None` in the window.
    pub fn index_at(&self, t: f64) -> Option<u64> {
        (t < self.end).then(|| (t / self.length + EDGE).floor() as u64)
    }
}

/// Statistics of the current stretch.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StretchStatistics {
    number: u64,
    count: u64,
    times: [f64; 2],
    least: Vec<f64>,
    greatest: Vec<f64>,
    sums: Vec<f64>,
}

impl StretchStatistics {
    /// Adds a row of the history. Returns the row of the previous stretch if this row begins another.
    pub fn take(&mut self, number: Option<u64>, row: &[f64]) -> Option<Vec<f64>> {
        let before = if number == Some(self.number) {
            None
        } else {
            self.close()
        };
        if let (Some(number), [t, values @ ..]) = (number, row) {
            if self.count == 0 {
                *self = Self {
                    number,
                    count: 1,
                    times: [*t; 2],
                    least: values.to_vec(),
                    greatest: values.to_vec(),
                    sums: values.to_vec(),
                };
            } else {
                self.count += 1;
                self.times[1] = *t;
                for (k, x) in values.iter().enumerate() {
                    self.least[k] = self.least[k].min(*x);
                    self.greatest[k] = self.greatest[k].max(*x);
                    self.sums[k] += x;
                }
            }
        }
        before
    }

    /// Returns the row of the stretch, if it has any outputs, and clears it.
    pub fn close(&mut self) -> Option<Vec<f64>> {
        if self.count == 0 {
            return None;
        }
        let count = self.count as f64;
        let mut row = vec![self.times[0], self.times[1], count];
        for ((least, greatest), sum) in self.least.iter().zip(&self.greatest).zip(&self.sums) {
            row.extend([*least, *greatest, sum / count]);
        }
        *self = Self::default();
        Some(row)
    }
}
