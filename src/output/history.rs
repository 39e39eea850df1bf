//! `history.csv`: written row by row, read back as envelopes of bounded size.

use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::folder::{fault, name_of, open};
use super::numbers::shortest_in;
use super::stream::{Stream, StreamMark};
use crate::error::Result;
use crate::run::record::HistoryColumn;

/// Longest wall time until rows are in the file: a run can be watched, and loses little when killed.
pub(crate) const FLUSH: Duration = Duration::from_millis(500);

/// Names of columns with their units, `name [unit]`.
pub fn headings(columns: &[HistoryColumn]) -> Vec<String> {
    columns.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect()
}

/// Writes a history row by row.
#[derive(Debug)]
pub struct HistoryWriter {
    path: PathBuf,
    out: csv::Writer<Stream>,
    columns: usize,
    flushed: Instant,
}

impl HistoryWriter {
    /// Creates the file with its headings, `name [unit]`.
    pub fn create(path: &Path, columns: &[HistoryColumn]) -> Result<Self> {
        Self::with_names(path, headings(columns))
    }

    /// Creates the file with its headings, which already contain the units.
    pub fn with_names(path: &Path, names: Vec<String>) -> Result<Self> {
        let mut writer = Self {
            path: path.to_path_buf(),
            out: csv::Writer::from_writer(Stream::create(path)?),
            columns: names.len(),
            flushed: Instant::now(),
        };
        let written = writer.out.write_record(&names);
        writer.settle(written)?;
        writer.flush()?;
        Ok(writer)
    }

    /// Opens the verified file of an interrupted run and truncates it at the mark.
    pub fn reopen(path: &Path, mark: StreamMark) -> Result<Self> {
        let columns = || -> csv::Result<usize> {
            let mut reader = csv::Reader::from_reader(open(path)?);
            Ok(reader.headers()?.len())
        };
        Ok(Self {
            path: path.to_path_buf(),
            columns: columns().map_err(|e| fault("read", path, io::Error::from(e)))?,
            out: csv::Writer::from_writer(Stream::reopen(path, mark)?),
            flushed: Instant::now(),
        })
    }

    /// Syncs all rows to the disk and returns the mark.
    pub fn secure(&mut self) -> Result<StreamMark> {
        self.flush()?;
        self.out.get_ref().secure()
    }

    /// Appends a row with one number per column.
    pub fn row(&mut self, row: &[f64]) -> Result<()> {
        debug_assert_eq!(row.len(), self.columns);
        let mut room = zmij::Buffer::new();
        let mut write = || {
            let each = |&x: &f64| self.out.write_field(shortest_in(&mut room, x));
            row.iter().try_for_each(each)?;
            self.out.write_record(None::<&[u8]>)
        };
        let written = write();
        self.settle(written)?;
        if self.flushed.elapsed() >= FLUSH {
            self.flush()?;
        }
        Ok(())
    }

    /// Name of the file, and CRC-32 of the flushed content.
    pub fn checksum(&self) -> (String, u32) {
        (name_of(&self.path), self.out.get_ref().mark().crc32)
    }

    /// Flushes all rows to the file.
    pub fn flush(&mut self) -> Result<()> {
        self.flushed = Instant::now();
        self.out.flush().map_err(|e| fault("write", &self.path, e))
    }

    fn settle(&self, written: csv::Result<()>) -> Result<()> {
        written.map_err(|e| fault("write", &self.path, io::Error::from(e)))
    }
}
