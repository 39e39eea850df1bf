//! `errors.csv`: half widths of the error bands of history columns.

use std::path::Path;

use super::envelope::{HistorySource, RowOrigin, each_row, table};
use super::folder::ERRORS;
use super::history::HistoryWriter;
use crate::error::Result;
use crate::run::record::{Header, ThinnedRows};
use crate::run::summary::{Status, Summary};
use crate::study::companion::band::ErrorBand;

/// Histories of a run and of its companion.
#[derive(Clone, Debug, Default)]
pub struct ComparedHistories {
    /// The run.
    pub run: ThinnedRows,
    /// The companion of a run that has finished.
    pub companion: Option<ThinnedRows>,
}

impl ComparedHistories {
    /// No rows yet.
    pub fn new(header: &Header) -> Self {
        Self {
            run: ThinnedRows::new(&header.columns),
            companion: None,
        }
    }

    /// The rows of an interrupted run in a folder.
    ///
    /// # Errors
    /// The history cannot be read.
    pub fn read(dir: &Path, header: &Header) -> Result<Self> {
        let mut found = Self::new(header);
        each_row(HistorySource::Folder(dir), |_, origin, row| {
            if origin != RowOrigin::Rest {
                found.run.push(row);
            }
        })?;
        Ok(found)
    }

    /// The error band of a run that has finished, driven with a frequency [Hz].
    pub fn band(&self, summary: &Summary, frequency_hz: Option<f64>) -> Option<ErrorBand> {
        let companion = self.companion.as_ref().filter(|_| summary.status == Status::Finished)?;
        ErrorBand::new(&self.run, companion, summary, frequency_hz.map(f64::recip))
    }
}

/// Writes the band into a folder.
///
/// # Errors
/// The file cannot be written.
pub fn write(dir: &Path, band: &ErrorBand) -> Result<HistoryWriter> {
    let headings = band.names.iter().map(|(name, unit)| format!("{name} [{unit}]"));
    let mut file = HistoryWriter::with_names(&dir.join(ERRORS), headings.collect())?;
    band.rows.iter().try_for_each(|row| file.row(row))?;
    Ok(file)
}

/// Reads the band of a folder; none if there is no file.
///
/// # Errors
/// The file cannot be read.
pub fn read(dir: &Path) -> Result<ErrorBand> {
    let path = dir.join(ERRORS);
    if !path.is_file() {
        return Ok(ErrorBand::default());
    }
    let (names, mut rows) = table(&path)?;
    let mut band = ErrorBand { names, rows: vec![] };
    while let Some(row) = rows.next()? {
        band.rows.push(row.to_vec());
    }
    Ok(band)
}
