//! Writes the files that grow with a run: a thread formats numbers as text while the run continues.
//!
//! Rows are handed over in batches. The queue is short, so memory use stays constant. The files are the same as without the thread.

use std::io;
use std::mem;
use std::panic;
use std::path::Path;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::arrays::{ArraysWriter, Marks};
use super::envelope::HistoryInMemory;
use super::folder::{HISTORY, fault};
use super::history::HistoryWriter;
use super::stream::StreamMark;
use crate::error::{Error, Result};

/// Number of values in a batch.
const BATCH: usize = 1 << 13;
/// Wall time after which a batch of any size is handed over.
const WAIT: Duration = Duration::from_millis(100);
/// Largest number of queued values, so that a disk that is busy for a moment does not block the run. For a large beam the queue is a single
/// batch with a whole instant.
const WAITING: usize = 1 << 18;

/// The files of a folder that grow with a run.
#[derive(Debug)]
pub struct GrowingFiles {
    /// The history.
    pub history: HistoryWriter,
    /// History in memory, if it is complete and short.
    pub kept: Option<HistoryInMemory>,
    /// Fields.
    pub arrays: ArraysWriter,
    /// Statistics over output times that the history leaves out.
    pub envelope: Option<HistoryWriter>,
    /// Derivatives.
    pub sensitivities: Option<HistoryWriter>,
}

/// Part of each file that is safe on the disk.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SyncedPart {
    /// Mark of `history.csv`.
    pub history: StreamMark,
    /// Mark of `envelope.csv`, if it exists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub envelope: Option<StreamMark>,
    /// Mark of `sensitivities.csv`, if it exists.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivities: Option<StreamMark>,
    /// Marks of the raw files of fields.
    pub fields: Marks,
}

impl GrowingFiles {
    /// Syncs all files to the disk.
    pub fn secure(&mut self) -> Result<SyncedPart> {
        let secured = |rows: &mut Option<HistoryWriter>| rows.as_mut().map(HistoryWriter::secure).transpose();
        Ok(SyncedPart {
            history: self.history.secure()?,
            envelope: secured(&mut self.envelope)?,
            sensitivities: secured(&mut self.sensitivities)?,
            fields: self.arrays.secure()?,
        })
    }

    fn take(&mut self, batch: &Batch) -> Result<()> {
        batch.history.each(|row| {
            self.kept.take_if(|kept| !kept.push(row));
            self.history.row(row)
        })?;
        for (rows, out) in [
            (&batch.envelope, &mut self.envelope),
            (&batch.sensitivities, &mut self.sensitivities),
        ] {
            if let Some(out) = out {
                rows.each(|row| out.row(row))?;
            }
        }
        batch.fields.each(|instant| self.arrays.append(instant))
    }
}

/// Consecutive rows.
#[derive(Debug, Default)]
struct Rows {
    values: Vec<f64>,
    ends: Vec<usize>,
}

impl Rows {
    fn push<'a>(&mut self, parts: impl IntoIterator<Item = &'a [f64]>) {
        parts.into_iter().for_each(|part| self.values.extend_from_slice(part));
        self.ends.push(self.values.len());
    }

    fn each(&self, mut take: impl FnMut(&[f64]) -> Result<()>) -> Result<()> {
        let mut begin = 0;
        for &end in &self.ends {
            take(&self.values[begin..end])?;
            begin = end;
        }
        Ok(())
    }
}

#[derive(Debug, Default)]
struct Batch {
    history: Rows,
    envelope: Rows,
    sensitivities: Rows,
    /// Time and all fields of each instant.
    fields: Rows,
}

impl Batch {
    fn numbers(&self) -> usize {
        let all = [&self.history, &self.envelope, &self.sensitivities, &self.fields];
        all.iter().map(|rows| rows.values.len()).sum()
    }
}

enum Work {
    Write(Batch),
    Secure(Sender<SyncedPart>),
}

/// Writes [`Growing`] files in a thread, which ends at the first write error.
#[derive(Debug)]
pub struct BackgroundWriter {
    batch: Batch,
    handed: Instant,
    work: Option<SyncSender<Work>>,
    thread: Option<JoinHandle<Result<GrowingFiles>>>,
}

impl BackgroundWriter {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub fn new(files: GrowingFiles) -> Result<Self> {
        let batch = BATCH.max(files.arrays.numbers());
        let (work, todo) = mpsc::sync_channel((WAITING / batch).max(1));
        let thread = Builder::new().spawn(move || write(files, &todo));
        Ok(Self {
            batch: Batch::default(),
            handed: Instant::now(),
            work: Some(work),
            thread: Some(thread.map_err(|e| fault("begin a thread that writes", Path::new(HISTORY), e))?),
        })
    }

    /// Queues a row of the history.
    pub fn history(&mut self, row: &[f64]) -> Result<()> {
        self.batch.history.push([row]);
        self.hand_over_in_time()
    }

    /// Queues a row of the envelope.
    pub fn envelope(&mut self, row: &[f64]) -> Result<()> {
        self.batch.envelope.push([row]);
        self.hand_over_in_time()
    }

    /// Queues a row of derivatives.
    pub fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.batch.sensitivities.push([row]);
        self.hand_over_in_time()
    }

    /// Queues an instant of all fields.
    pub fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.batch
            .fields
            .push([&[t][..]].into_iter().chain(arrays.iter().copied()));
        self.hand_over_in_time()
    }

    /// Waits until everything is safe on the disk.
    pub fn secure(&mut self) -> Result<SyncedPart> {
        self.hand_over()?;
        let (sender, receiver) = mpsc::channel();
        self.send(Work::Secure(sender))?;
        match receiver.recv() {
            Ok(secured) => Ok(secured),
            Err(_) => self.broken(),
        }
    }

    /// Waits until everything is written and returns the files.
    pub fn close(mut self) -> Result<GrowingFiles> {
        self.hand_over()?;
        self.end()
    }

    fn hand_over_in_time(&mut self) -> Result<()> {
        if self.batch.numbers() >= BATCH || self.handed.elapsed() >= WAIT {
            return self.hand_over();
        }
        Ok(())
    }

    fn hand_over(&mut self) -> Result<()> {
        self.handed = Instant::now();
        let batch = mem::take(&mut self.batch);
        self.send(Work::Write(batch))
    }

    fn send(&mut self, work: Work) -> Result<()> {
        let taken = self.work.as_ref().is_some_and(|to| to.send(work).is_ok());
        if taken { Ok(()) } else { self.broken() }
    }

    /// Returns the error with which the thread ended.
    fn broken<T>(&mut self) -> Result<T> {
        self.end().and_then(|_| Err(gone()))
    }

    fn end(&mut self) -> Result<GrowingFiles> {
        drop(self.work.take());
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(ended)) => ended,
            Some(Err(panicked)) => panic::resume_unwind(panicked),
            None => Err(gone()),
        }
    }
}

impl Drop for BackgroundWriter {
    /// Writes everything queued, however the run ends.
    fn drop(&mut self) {
        if self.thread.is_some() {
            let _ = self.hand_over().and_then(|()| self.end());
        }
    }
}

fn write(mut files: GrowingFiles, todo: &Receiver<Work>) -> Result<GrowingFiles> {
    for work in todo {
        match work {
            Work::Write(batch) => files.take(&batch)?,
            Work::Secure(reply) => {
                let secured = files.secure()?;
                // no receiver if the run has ended meanwhile
                let _ = reply.send(secured);
            }
        }
    }
    Ok(files)
}

fn gone() -> Error {
    fault("write", Path::new(HISTORY), io::ErrorKind::BrokenPipe.into())
}
