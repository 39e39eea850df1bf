//! Estimated sizes of the files of a run.

use crate::case::Case;
use crate::run::record::{Header, ThinnedRows};
use crate::run::thinned_statistics::ThinningIntervals;

/// Size of a number in a text file, with its comma [byte].
const WORD: f64 = 20.0;
/// Size of a half width of an error band with its comma [byte].
const WIDTH: f64 = 10.0;
/// Size of a number in arrays, raw and archived together [byte].
const ARRAYED: f64 = 16.0;
/// Size of pictures, page and summary together [byte].
const PICTURES: f64 = 2e6;

/// Largest expected sizes of the files of a run [byte].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// `history.csv`, `envelope.csv`, `sensitivities.csv` and `errors.csv`.
    pub history: f64,
    /// `fields.npz`, and the raw arrays from which it is packed.
    pub fields: f64,
    /// Checkpoints, pictures, page.
    pub others: f64,
}

impl Disk {
    /// Estimates the sizes for a header, a number of unknowns, and derivatives with respect to a number of parameters.
    pub fn estimate(case: &Case, header: &Header, unknowns: usize, parameters: usize) -> Self {
        let time = &case.time;
        // plus rows at the start, at the end and at the start of the window
        let rows = time.written(time.output_interval()) + 3.0;
        let instants = time.written(time.fields_interval()) + 3.0;
        let outputs = time.end_s / time.output_interval();
        let stretches = if time.history.is_none() {
            0.0
        } else {
            ThinningIntervals::new(case).count().min(outputs)
        };
        let columns = header.columns.len() * (1 + parameters);
        let banded = rows.min(ThinnedRows::MOST as f64);
        let values: usize = header.fields.iter().map(|field| field.len).sum();
        let kept = if time.checkpoint_interval_s.is_some() { 2.0 } else { 0.0 };
        Self {
            history: (rows + 3.0 * stretches) * columns as f64 * WORD + banded * header.columns.len() as f64 * WIDTH,
            fields: instants * (1 + values) as f64 * ARRAYED,
            others: PICTURES + kept * 2.0 * unknowns as f64 * WORD,
        }
    }

    /// Total size [byte].
    pub fn all(&self) -> f64 {
        self.history + self.fields + self.others
    }
}
