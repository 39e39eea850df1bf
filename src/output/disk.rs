//! How large the files of a run will be.

use crate::case::Case;
use crate::run::record::Header;

/// A number in a text, with its comma [byte].
const WORD: f64 = 20.0;
/// A number in arrays, raw and as archived [byte].
const ARRAYED: f64 = 16.0;
/// Pictures, page, summary [byte].
const PICTURES: f64 = 2e6;

/// Bytes of history and of fields at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// `history.csv` and `sensitivities.csv`.
    pub history: f64,
    /// `fields.npz`, and the raw arrays while it is made.
    pub fields: f64,
    /// Checkpoints, pictures, page.
    pub others: f64,
}

impl Disk {
    /// Of a run that records what the header says, with so many unknowns and derivatives by so many numbers.
    pub fn of(case: &Case, header: &Header, unknowns: usize, parameters: usize) -> Self {
        let time = &case.time;
        let rows = time.end_s / time.output_interval() + 2.0;
        let instants = time.end_s / time.fields_interval() + 2.0;
        let columns = header.columns.len() * (1 + parameters);
        let values: usize = header.fields.iter().map(|field| field.len).sum();
        let kept = if time.checkpoint_interval_s.is_some() { 2.0 } else { 0.0 };
        Self {
            history: rows * columns as f64 * WORD,
            fields: instants * (1 + values) as f64 * ARRAYED,
            others: PICTURES + kept * 2.0 * unknowns as f64 * WORD,
        }
    }

    /// All of it.
    pub fn all(&self) -> f64 {
        self.history + self.fields + self.others
    }
}
