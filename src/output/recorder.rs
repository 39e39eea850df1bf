//! The recorder that fills a result folder.

use std::panic;
use std::path::PathBuf;
use std::thread;
use std::time::Instant;

use super::arrays::ArraysWriter;
use super::behind::{Behind, Growing, Secured};
use super::checkpoint::{self, Saved};
use super::envelope::Envelope;
use super::folder::{
    CHECKPOINT, CHECKPOINT_BEFORE, ENVELOPE, FIELDS, HISTORY, PICTURES, RAW_FIELDS, REPORT, ResultFolder,
    SENSITIVITIES, SUMMARY,
};
use super::history::HistoryWriter;
use super::pictures::{self, Picture, STRETCHES};
use super::stream::Stream;
use super::summary;
use crate::case::{Case, Written};
use crate::error::Result;
use crate::model::characteristic;
use crate::run::checkpoint::Checkpoint;
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::run::summary::{Status, Summary};
use crate::run::wall::Laps;

/// Called after every step; decides whether to go on.
pub type Hook = Box<dyn FnMut(&Progress) -> Control>;

/// What is recorded besides the run itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// Name of the case, for the pictures.
    pub case_name: String,
    /// The case as resolved.
    pub case: Written,
    /// Frequency of the drive [Hz]: pictures over space then show its last cycle.
    pub frequency_hz: Option<f64>,
}

impl Labels {
    /// Those of a case.
    pub fn of(case: &Case) -> Self {
        Self {
            case_name: case.name.clone(),
            case: case.written(),
            frequency_hz: characteristic::forcing_period(case).map(|period| 1.0 / period),
        }
    }
}

/// Streams a run into a folder.
///
/// An older result in the folder stands until [`Recorder::begin`]: a run that cannot start destroys nothing. Dropped
/// without [`FolderRecorder::finish`], it leaves `history.csv` and the raw arrays as far as they were written.
pub struct FolderRecorder {
    folder: ResultFolder,
    labels: Labels,
    hook: Hook,
    lean: bool,
    open: Option<Behind>,
}

impl FolderRecorder {
    /// Into this folder, asking `hook` after every step.
    pub fn new(folder: ResultFolder, labels: Labels, hook: Hook) -> Self {
        Self {
            folder,
            labels,
            hook,
            lean: false,
            open: None,
        }
    }

    /// Leaves summary, case and arrays alone in the end. Tables are written all the same while the run is under way: by them its folder is
    /// known, and it goes on from them.
    #[must_use]
    pub fn lean(self, lean: bool) -> Self {
        Self { lean, ..self }
    }

    /// Goes on in the folder of an interrupted run; what was recorded after its checkpoint is dropped. All files are verified
    /// before any is touched.
    ///
    /// # Errors
    ///
    /// A file is damaged or gone; then the folder is as it was.
    pub fn resume(folder: ResultFolder, labels: Labels, hook: Hook, saved: &Saved, header: &Header) -> Result<Self> {
        let (history, raw) = (folder.path(HISTORY), folder.path(RAW_FIELDS));
        Stream::verify(&history, saved.history)?;
        ArraysWriter::verify(&raw, header, &saved.fields)?;
        let besides = [(ENVELOPE, saved.envelope), (SENSITIVITIES, saved.sensitivities)];
        for (name, mark) in besides {
            mark.map_or(Ok(()), |mark| Stream::verify(&folder.path(name), mark))?;
        }
        folder.remove(SUMMARY)?;
        folder.remove_exports()?;
        let history = HistoryWriter::reopen(&history, saved.history)?;
        let arrays = ArraysWriter::reopen(&raw, header, &saved.fields)?;
        let [envelope, sensitivities] = besides.map(|(name, mark)| {
            let path = folder.path(name);
            mark.map(|mark| HistoryWriter::reopen(&path, mark)).transpose()
        });
        let files = Growing {
            history,
            arrays,
            envelope: envelope?,
            sensitivities: sensitivities?,
        };
        Ok(Self {
            open: Some(Behind::new(files)),
            ..Self::new(folder, labels, hook)
        })
    }

    /// Completes the folder however the run ended: history and arrays whole and on the disk, then the summary that says so, then
    /// pictures. What a run could go on from stays until [`Finished::close`], so that all of this can be repeated.
    ///
    /// A run that failed before it began leaves case and summary, and moves an older result aside.
    ///
    /// # Errors
    ///
    /// A file cannot be written; the summary then says `failed`, and why.
    pub fn finish(mut self, summary: &Summary) -> Result<Finished> {
        let (mut laps, mut spent) = (Laps::since(Instant::now()), Spent::default());
        let began = self.open.is_some();
        let aside = if began { None } else { self.folder.set_aside()? };
        let mut drawn = vec![];
        let completed = match self.open.take() {
            Some(open) => self.complete(open, summary.status, &mut drawn, &mut laps, &mut spent),
            None => Ok(()),
        };
        // The summary matters most: it is tried whatever could not be written before.
        let cased = self.folder.write_case(&self.labels.case);
        // where arrays or tables are not whole nothing may say that they are
        let failed = completed.as_ref().err().map(|error| Summary {
            status: Status::Failed,
            reason: Some(error.to_string()),
            ..summary.clone()
        });
        let told = summary::write(&self.folder, failed.as_ref().unwrap_or(summary));
        completed.and(cased).and(told.map(|_| ()))?;
        self.folder.secure()?;
        if self.lean {
            // of a run that is gone on with
            PICTURES
                .into_iter()
                .chain([REPORT])
                .try_for_each(|name| self.folder.remove(name))?;
        }
        self.folder.write_all(&drawn)?;
        spent.files += laps.lap();
        Ok(Finished {
            spent,
            lean: self.lean,
            resumable: summary.status != Status::Finished && self.folder.path(CHECKPOINT).exists(),
            folder: self.folder,
            aside,
        })
    }

    /// Brings the tables to the disk, draws pictures of them and packs the arrays, both at once.
    fn complete(
        &self,
        open: Behind,
        status: Status,
        drawn: &mut Vec<Picture>,
        laps: &mut Laps,
        spent: &mut Spent,
    ) -> Result<()> {
        let mut files = open.close()?;
        if !(self.lean && status == Status::Finished) {
            files.secure_tables()?;
        }
        let mut arrays = files.arrays;
        spent.files += laps.lap();
        if self.lean {
            return arrays.finish(&self.folder.path(FIELDS));
        }
        let (case, dir) = (&self.labels.case_name, self.folder.dir());
        let over_time = || Ok(pictures::over_time(case, &Envelope::read(dir, STRETCHES)?));
        thread::scope(|scope| {
            let over_time = scope.spawn(over_time);
            let over_space = pictures::over_space(case, self.labels.frequency_hz, &mut arrays);
            spent.pictures += laps.lap();
            let packed = arrays.finish(&self.folder.path(FIELDS));
            spent.files += laps.lap();
            let over_time: Result<_> = over_time
                .join()
                .unwrap_or_else(|panicked| panic::resume_unwind(panicked));
            spent.pictures += laps.lap();
            drawn.extend(over_time?);
            drawn.extend(over_space?);
            packed
        })
    }
}

/// Wall time that a completed folder took [s].
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Pictures.
    pub pictures: f64,
    /// Files.
    pub files: f64,
}

/// A folder whose result is complete.
#[derive(Debug)]
#[must_use = "what the run could go on from is still there"]
pub struct Finished {
    folder: ResultFolder,
    resumable: bool,
    lean: bool,
    /// What completing it took.
    pub spent: Spent,
    /// Where an older result went.
    pub aside: Option<PathBuf>,
}

impl Finished {
    /// A folder that took over the result of another, with all that belongs to it.
    pub fn of(folder: ResultFolder) -> Self {
        Self {
            resumable: true,
            lean: false,
            folder,
            spent: Spent::default(),
            aside: None,
        }
    }

    /// Removes what a run could go on from, unless it is yet to go on. Returns the folder, still locked.
    pub fn close(self) -> Result<ResultFolder> {
        if self.resumable {
            return Ok(self.folder);
        }
        self.folder.secure()?;
        self.folder.remove(CHECKPOINT_BEFORE)?;
        self.folder.remove(CHECKPOINT)?;
        self.folder.secure()?;
        self.folder.remove_raw()?;
        if self.lean {
            // last: with a checkpoint still there, it would be damaged without them
            let tables = [HISTORY, ENVELOPE, SENSITIVITIES];
            tables.iter().try_for_each(|name| self.folder.remove(name))?;
        }
        Ok(self.folder)
    }

    /// The folder, still locked.
    pub fn folder(&self) -> &ResultFolder {
        &self.folder
    }
}

impl Recorder for FolderRecorder {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.folder.clear()?;
        let history = HistoryWriter::create(&self.folder.path(HISTORY), &header.columns)?;
        let arrays = ArraysWriter::create(&self.folder.path(RAW_FIELDS), header)?;
        self.folder.write_case(&self.labels.case)?;
        let table = |file: &str, names: &[String]| {
            let path = self.folder.path(file);
            let wanted = !names.is_empty();
            wanted
                .then(|| HistoryWriter::with_names(&path, names.to_vec()))
                .transpose()
        };
        let files = Growing {
            history,
            arrays,
            envelope: table(ENVELOPE, &header.envelope)?,
            sensitivities: table(SENSITIVITIES, &header.sensitivities)?,
        };
        self.open = Some(Behind::new(files));
        Ok(())
    }

    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.open.as_mut().map_or(Ok(()), |open| open.history(row))
    }

    fn envelope(&mut self, row: &[f64]) -> Result<()> {
        self.open.as_mut().map_or(Ok(()), |open| open.envelope(row))
    }

    fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.open.as_mut().map_or(Ok(()), |open| open.sensitivities(row))
    }

    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.open.as_mut().map_or(Ok(()), |open| open.fields(t, arrays))
    }

    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok((self.hook)(progress))
    }

    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let Some(open) = self.open.as_mut() else {
            return Ok(());
        };
        let Secured { tables, arrays } = open.secure()?;
        let saved = Saved {
            history: tables.history,
            envelope: tables.envelope,
            sensitivities: tables.sensitivities,
            fields: arrays,
            run: checkpoint.clone(),
        };
        checkpoint::write(&self.folder, &saved)
    }
}
