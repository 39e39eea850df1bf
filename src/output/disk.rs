//! How large the files of a run will be.

use crate::case::Case;
use crate::run::record::Header;
use crate::run::stretch::Stretches;

/// A number in a text, with its comma [byte].
const WORD: f64 = 20.0;
/// A number in arrays, raw and as archived [byte].
const ARRAYED: f64 = 16.0;
/// Pictures, page, summary [byte].
const PICTURES: f64 = 2e6;

/// Bytes of history and of fields at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// `history.csv`, `envelope.csv` and `sensitivities.csv`.
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
        // those at the start, at the end and where the window begins beside them
        let rows = time.written(time.output_interval()) + 3.0;
        let instants = time.written(time.fields_interval()) + 3.0;
        let outputs = time.end_s / time.output_interval();
        let stretches = if time.history.is_none() {
            0.0
        } else {
            Stretches::new(case).count().min(outputs)
        };
        let columns = header.columns.len() * (1 + parameters);
        let values: usize = header.fields.iter().map(|field| field.len).sum();
        let kept = if time.checkpoint_interval_s.is_some() { 2.0 } else { 0.0 };
        Self {
            history: (rows + 3.0 * stretches) * columns as f64 * WORD,
            fields: instants * (1 + values) as f64 * ARRAYED,
            others: PICTURES + kept * 2.0 * unknowns as f64 * WORD,
        }
    }

    /// All of it.
    pub fn all(&self) -> f64 {
        self.history + self.fields + self.others
    }
}
