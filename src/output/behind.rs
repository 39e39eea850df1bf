//! The files that grow with a run, written behind it: a thread makes text of numbers while the run goes on.
//!
//! Rows are handed over in batches, of which few numbers wait at a time, so that memory stays flat. Files hold what they would if the run wrote them itself.

use std::io;
use std::mem;
use std::panic;
use std::path::Path;
use std::sync::mpsc::{self, Receiver, Sender, SyncSender};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use super::arrays::{ArraysWriter, Marks};
use super::envelope::Remembered;
use super::folder::{HISTORY, fault};
use super::history::HistoryWriter;
use super::stream::Mark;
use crate::error::{Error, Result};

/// Numbers of a batch.
const BATCH: usize = 1 << 13;
/// Wall time after which a batch is handed over however small it is.
const WAIT: Duration = Duration::from_millis(100);
/// Numbers that may wait to be written, so that a disk that is busy for a moment does not hold up the run; of a large beam one batch, which
/// holds a whole instant.
const WAITING: usize = 1 << 18;

/// The files of a folder that grow with a run.
#[derive(Debug)]
pub struct Growing {
    /// The history.
    pub history: HistoryWriter,
    /// The same in memory, if it is whole and short.
    pub kept: Option<Remembered>,
    /// Fields.
    pub arrays: ArraysWriter,
    /// What is left of output times that are not written.
    pub envelope: Option<HistoryWriter>,
    /// Derivatives.
    pub sensitivities: Option<HistoryWriter>,
}

/// How much of each of these files is safe on the disk.
#[derive(Clone, Debug)]
pub struct Secured {
    /// The tables.
    pub tables: Tables,
    /// Fields.
    pub arrays: Marks,
}

/// The tables among them.
#[derive(Clone, Copy, Debug)]
pub struct Tables {
    /// The history.
    pub history: Mark,
    /// What is left of output times that are not written.
    pub envelope: Option<Mark>,
    /// Derivatives.
    pub sensitivities: Option<Mark>,
}

impl Growing {
    /// Brings everything to the disk itself.
    pub fn secure(&mut self) -> Result<Secured> {
        let secured = |rows: &mut Option<HistoryWriter>| rows.as_mut().map(HistoryWriter::secure).transpose();
        Ok(Secured {
            tables: Tables {
                history: self.history.secure()?,
                envelope: secured(&mut self.envelope)?,
                sensitivities: secured(&mut self.sensitivities)?,
            },
            arrays: self.arrays.secure()?,
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

/// Rows, one after the other.
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
    /// Of each instant its time and all fields.
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
    Secure(Sender<Secured>),
}

/// Writes [`Growing`] files in a thread; it ends at the first file that cannot be written.
#[derive(Debug)]
pub struct Behind {
    batch: Batch,
    handed: Instant,
    work: Option<SyncSender<Work>>,
    thread: Option<JoinHandle<Result<Growing>>>,
}

impl Behind {
    /// Takes over the files.
    ///
    /// # Errors
    /// The system grants no thread.
    pub fn new(files: Growing) -> Result<Self> {
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

    /// A row of the history.
    pub fn history(&mut self, row: &[f64]) -> Result<()> {
        self.batch.history.push([row]);
        self.hand_over_in_time()
    }

    /// A row of the envelope.
    pub fn envelope(&mut self, row: &[f64]) -> Result<()> {
        self.batch.envelope.push([row]);
        self.hand_over_in_time()
    }

    /// A row of derivatives.
    pub fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.batch.sensitivities.push([row]);
        self.hand_over_in_time()
    }

    /// An instant of all fields.
    pub fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.batch
            .fields
            .push([&[t][..]].into_iter().chain(arrays.iter().copied()));
        self.hand_over_in_time()
    }

    /// Waits until everything is safe on the disk.
    pub fn secure(&mut self) -> Result<Secured> {
        self.hand_over()?;
        let (tell, told) = mpsc::channel();
        self.send(Work::Secure(tell))?;
        match told.recv() {
            Ok(secured) => Ok(secured),
            Err(_) => self.broken(),
        }
    }

    /// Waits until everything is written; gives the files back.
    pub fn close(mut self) -> Result<Growing> {
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

    /// Why the thread has ended.
    fn broken<T>(&mut self) -> Result<T> {
        self.end().and_then(|_| Err(gone()))
    }

    fn end(&mut self) -> Result<Growing> {
        drop(self.work.take());
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(ended)) => ended,
            Some(Err(panicked)) => panic::resume_unwind(panicked),
            None => Err(gone()),
        }
    }
}

impl Drop for Behind {
    /// What was handed over is written, whatever ends the run.
    fn drop(&mut self) {
        if self.thread.is_some() {
            let _ = self.hand_over().and_then(|()| self.end());
        }
    }
}

fn write(mut files: Growing, todo: &Receiver<Work>) -> Result<Growing> {
    for work in todo {
        match work {
            Work::Write(batch) => files.take(&batch)?,
            Work::Secure(tell) => {
                let secured = files.secure()?;
                // nobody waits for it if the run has ended meanwhile
                let _ = tell.send(secured);
            }
        }
    }
    Ok(files)
}

fn gone() -> Error {
    fault("write", Path::new(HISTORY), io::ErrorKind::BrokenPipe.into())
}
