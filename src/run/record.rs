//! Interface between a run and its recorders. The run itself prints nothing and writes nothing.

use super::checkpoint::Checkpoint;
pub use crate::discrete::quantities::probes::HistoryColumn;
use crate::error::Result;

/// A fixed coordinate along which a field is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedAxis {
    /// Array name, unit included: `theta_node_m`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Description in one sentence.
    pub about: &'static str,
    /// Coordinates.
    pub values: Vec<f64>,
}

/// An array over time and one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedField {
    /// Array name, unit included: `u1_m`.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Name of its [`Axis`].
    pub axis: &'static str,
    /// Description in one sentence.
    pub about: &'static str,
    /// Length along the axis.
    pub len: usize,
}

/// Description of the recorded data, available before the first step.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Header {
    /// Columns of the history; the first is `t [s]`.
    pub columns: Vec<HistoryColumn>,
    /// Coordinates.
    pub axes: Vec<RecordedAxis>,
    /// Fields.
    pub fields: Vec<RecordedField>,
    /// Columns of the statistics over stretches of thinned outputs, names with units; empty if all outputs are written.
    pub envelope: Vec<String>,
    /// Columns of derivatives, names with units, the first `t [s]`; empty if none are requested.
    pub sensitivities: Vec<String>,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Simulated time [s].
    pub t: f64,
    /// Simulated time at the end [s].
    pub end: f64,
    /// Accepted steps so far.
    pub steps: u64,
    /// Current step [s].
    pub step: f64,
    /// Current order.
    pub order: u8,
}

/// Decision to continue or stop a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Control {
    /// Continue.
    Continue,
    /// Stop here, with a reason; the recorded data remain.
    Stop(String),
}

/// Outcome of a sample.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sampled {
    /// Part of the figures.
    Taken,
    /// Part of the figures, and recorded.
    Written,
    /// Dropped, because it exceeds a validity limit of the model, which the text describes.
    Beyond(String),
}

/// Receives the results of a run, in order of time.
pub trait Recorder {
    /// Called once, before the first row.
    fn begin(&mut self, _: &Header) -> Result<()> {
        Ok(())
    }
    /// Receives one row of the history, as long as `header.columns`.
    fn history(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }
    /// Receives one row of derivatives, after the history row of the same instant, as long as `header.sensitivities`.
    fn sensitivities(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }
    /// Receives the statistics over one stretch of outputs, as long as `header.envelope`.
    fn envelope(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }
    /// Receives all fields at one instant, in the order of `header.fields`.
    fn fields(&mut self, _: f64, _: &[&[f64]]) -> Result<()> {
        Ok(())
    }
    /// Called after every accepted step, and occasionally within an expensive one; must be cheap.
    fn progress(&mut self, progress: &Progress) -> Result<Control>;
    /// Called at every checkpoint time; all earlier data must be safely stored when it returns.
    fn checkpoint(&mut self, _: &Checkpoint) -> Result<()> {
        Ok(())
    }
    /// False for figures alone: states are not examined for growing waves, which takes longer than a short run.
    fn examines_waves(&self) -> bool {
        true
    }
    /// Receives the history of the companion of a run that has finished.
    fn companion(&mut self, _: &ThinnedRows) -> Result<()> {
        Ok(())
    }
}

/// Rows of a history, thinned by their numbers alone, so that two runs with equal output times keep the same instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThinnedRows {
    columns: Vec<HistoryColumn>,
    rows: Vec<Vec<f64>>,
    last: Vec<f64>,
    count: u64,
    stride: u64,
}

impl ThinnedRows {
    /// Largest number of rows, without the last one.
    pub const MOST: usize = 1200;
    /// One row of so many stays: outputs per period of a drive are rarely a multiple of nine, so that all phases of a drive remain.
    const THINNED: u64 = 3;

    /// No rows of these columns, the first of which is time.
    pub fn new(columns: &[HistoryColumn]) -> Self {
        Self {
            columns: columns.to_vec(),
            stride: 1,
            ..Self::default()
        }
    }

    /// Rows that are thinned already.
    pub fn from_rows(columns: &[HistoryColumn], rows: Vec<Vec<f64>>) -> Self {
        Self {
            rows,
            ..Self::new(columns)
        }
    }

    /// Adds a row.
    pub fn push(&mut self, row: &[f64]) {
        if self.count.is_multiple_of(self.stride) && self.rows.len() == Self::MOST {
            let mut number = 0;
            self.rows.retain(|_| {
                number += 1;
                (number - 1_u64).is_multiple_of(Self::THINNED)
            });
            self.stride *= Self::THINNED;
        }
        if self.count.is_multiple_of(self.stride) {
            self.rows.push(row.to_vec());
        }
        self.last.clear();
        self.last.extend_from_slice(row);
        self.count += 1;
    }

    /// The columns.
    pub fn columns(&self) -> &[HistoryColumn] {
        &self.columns
    }

    /// Rows that are kept, the last one included.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        let ends = self.count > 0 && !(self.count - 1).is_multiple_of(self.stride);
        let last = ends.then_some(&self.last);
        self.rows.iter().chain(last).map(Vec::as_slice)
    }
}

/// Recorder that stores nothing and only decides if the run continues.
pub struct Unrecorded<F: FnMut(&Progress) -> Control>(pub F);

impl<F: FnMut(&Progress) -> Control> Recorder for Unrecorded<F> {
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok((self.0)(progress))
    }
}

/// The same for runs of which only the figures count, [`Recorder::examines_waves`].
pub struct FiguresAlone<F: FnMut(&Progress) -> Control>(pub F);

impl<F: FnMut(&Progress) -> Control> Recorder for FiguresAlone<F> {
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok((self.0)(progress))
    }
    fn examines_waves(&self) -> bool {
        false
    }
}

/// Recorder that keeps thinned rows of the history and its figures alone, and decides if the run continues.
pub struct ThinnedRecorder<F: FnMut(&Progress) -> Control> {
    /// Decision.
    pub hook: F,
    /// History.
    pub rows: ThinnedRows,
}

impl<F: FnMut(&Progress) -> Control> Recorder for ThinnedRecorder<F> {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.rows = ThinnedRows::new(&header.columns);
        Ok(())
    }
    fn examines_waves(&self) -> bool {
        false
    }
    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.rows.push(row);
        Ok(())
    }
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok((self.hook)(progress))
    }
}

/// Recorder that stores everything in memory, for tests and studies.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    /// Header of the run.
    pub header: Header,
    /// Rows of the history.
    pub rows: Vec<Vec<f64>>,
    /// Rows of derivatives.
    pub sensitivities: Vec<Vec<f64>>,
    /// Times of the fields.
    pub field_times: Vec<f64>,
    /// Fields: `fields[f][time]` is the array of field f.
    pub fields: Vec<Vec<Vec<f64>>>,
    /// Checkpoints.
    pub checkpoints: Vec<Checkpoint>,
    /// History of the companion.
    pub companion: Option<ThinnedRows>,
}

impl Memory {
    /// One column of the history by name; `None` if it does not exist.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let k = self.header.columns.iter().position(|c| c.name == name)?;
        Some(self.rows.iter().map(|r| r[k]).collect())
    }

    /// One column of derivatives, by the history column and the pointer of the number: `("tip_u1", "/fluid/viscosity_pa_s")`.
    pub fn sensitivity(&self, column: &str, pointer: &str) -> Option<Vec<f64>> {
        let start = format!("d {column}/d {pointer} [");
        let k = self
            .header
            .sensitivities
            .iter()
            .position(|name| name.starts_with(&start))?;
        Some(self.sensitivities.iter().map(|r| r[k]).collect())
    }

    /// One field by name: an array for each recorded time.
    pub fn field(&self, name: &str) -> Option<&[Vec<f64>]> {
        let k = self.header.fields.iter().position(|f| f.name == name)?;
        Some(&self.fields[k])
    }
}

impl Recorder for Memory {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.header = header.clone();
        self.fields = vec![Vec::new(); header.fields.len()];
        Ok(())
    }
    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.rows.push(row.to_vec());
        Ok(())
    }
    fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.sensitivities.push(row.to_vec());
        Ok(())
    }
    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.field_times.push(t);
        for (kept, array) in self.fields.iter_mut().zip(arrays) {
            kept.push(array.to_vec());
        }
        Ok(())
    }
    fn progress(&mut self, _: &Progress) -> Result<Control> {
        Ok(Control::Continue)
    }
    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        self.checkpoints.push(checkpoint.clone());
        Ok(())
    }
    fn companion(&mut self, rows: &ThinnedRows) -> Result<()> {
        self.companion = Some(rows.clone());
        Ok(())
    }
}
