//! Rows and fields as flat arrays, which numpy takes over without a copy.

use slcbeam::error::Result;
use slcbeam::run::record::{Control, Header, Progress, Recorder, ThinnedRows};

use crate::watch::Watch;

/// What was recorded; arrays by rows.
#[derive(Default)]
pub struct Arrays {
    /// The history.
    pub history: Vec<f64>,
    /// What is left of output times that the history leaves out.
    pub envelope: Vec<f64>,
    /// Derivatives of the history.
    pub sensitivities: Vec<f64>,
    /// Times of the fields [s].
    pub times: Vec<f64>,
    /// Fields over times and places.
    pub fields: Vec<Vec<f64>>,
    /// The same columns of the companion at some of the output times; NaN where it lacks one.
    pub companion: Vec<f64>,
}

/// Keeps a run in memory.
pub struct Keeper<'a> {
    watch: &'a Watch,
    /// As begun; nothing where the run did not begin.
    pub header: Option<Header>,
    /// What came.
    pub arrays: Arrays,
}

impl<'a> Keeper<'a> {
    /// Of a run that is looked after.
    pub fn new(watch: &'a Watch) -> Self {
        Self {
            watch,
            header: None,
            arrays: Arrays::default(),
        }
    }
}

impl Recorder for Keeper<'_> {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.arrays.fields = vec![vec![]; header.fields.len()];
        self.header = Some(header.clone());
        Ok(())
    }
    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.arrays.history.extend_from_slice(row);
        Ok(())
    }
    fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.arrays.sensitivities.extend_from_slice(row);
        Ok(())
    }
    fn envelope(&mut self, row: &[f64]) -> Result<()> {
        self.arrays.envelope.extend_from_slice(row);
        Ok(())
    }
    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.arrays.times.push(t);
        for (kept, array) in self.arrays.fields.iter_mut().zip(arrays) {
            kept.extend_from_slice(array);
        }
        Ok(())
    }
    fn companion(&mut self, rows: &ThinnedRows) -> Result<()> {
        let own = self.header.iter().flat_map(|header| &header.columns);
        let place = |name: &str| rows.columns().iter().position(|column| column.name == name);
        let places: Vec<Option<usize>> = own.map(|column| place(&column.name)).collect();
        let values = |row: &[f64]| -> Vec<f64> { places.iter().map(|k| k.map_or(f64::NAN, |k| row[k])).collect() };
        self.arrays.companion = rows.rows().flat_map(values).collect();
        Ok(())
    }
    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok(self.watch.step(progress))
    }
}
