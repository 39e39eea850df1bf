//! `history.csv`: written row by row, read back as envelopes of bounded size.

use std::fs::File;
use std::io::{self, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::folder::fault;
use super::numbers::shortest;
use crate::error::Result;
use crate::run::record::Column;

/// Wall time after which rows reach the disk at the latest, so that a run can be watched and loses little when killed.
pub(crate) const FLUSH: Duration = Duration::from_millis(500);

/// Writes the history as it comes.
#[derive(Debug)]
pub struct HistoryWriter {
    path: PathBuf,
    out: csv::Writer<File>,
    columns: usize,
    flushed: Instant,
}

impl HistoryWriter {
    /// Creates the file with its line of names, `name [unit]`.
    pub fn create(path: &Path, columns: &[Column]) -> Result<Self> {
        Self::with_names(
            path,
            columns.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect(),
        )
    }

    /// Creates the file with its line of names, which hold the units already.
    pub fn with_names(path: &Path, names: Vec<String>) -> Result<Self> {
        let file = File::create(path).map_err(|e| fault("create", path, e))?;
        let mut writer = Self {
            path: path.to_path_buf(),
            out: csv::Writer::from_writer(file),
            columns: names.len(),
            flushed: Instant::now(),
        };
        let written = writer.out.write_record(&names);
        writer.settle(written)?;
        writer.flush()?;
        Ok(writer)
    }

    /// Opens the file of an interrupted run and drops what came after its first `bytes`.
    pub fn reopen(path: &Path, columns: usize, bytes: u64) -> Result<Self> {
        let open = || -> io::Result<File> {
            let mut file = File::options().write(true).open(path)?;
            file.set_len(bytes)?;
            file.seek(SeekFrom::End(0))?;
            Ok(file)
        };
        let file = open().map_err(|e| fault("open", path, e))?;
        Ok(Self {
            path: path.to_path_buf(),
            out: csv::Writer::from_writer(file),
            columns,
            flushed: Instant::now(),
        })
    }

    /// Size of the file so far, all of it safe on disk.
    pub fn secure(&mut self) -> Result<u64> {
        self.flush()?;
        let measure = || -> io::Result<u64> {
            let file = self.out.get_ref();
            file.sync_data()?;
            Ok(file.metadata()?.len())
        };
        measure().map_err(|e| fault("write", &self.path, e))
    }

    /// Appends a row; as many numbers as columns.
    pub fn row(&mut self, row: &[f64]) -> Result<()> {
        debug_assert_eq!(row.len(), self.columns);
        let written = self.out.write_record(row.iter().map(|&x| shortest(x)));
        self.settle(written)?;
        if self.flushed.elapsed() >= FLUSH {
            self.flush()?;
        }
        Ok(())
    }

    /// Brings everything to the disk.
    pub fn flush(&mut self) -> Result<()> {
        self.flushed = Instant::now();
        self.out.flush().map_err(|e| fault("write", &self.path, e))
    }

    fn settle(&self, written: csv::Result<()>) -> Result<()> {
        written.map_err(|e| fault("write", &self.path, io::Error::from(e)))
    }
}
