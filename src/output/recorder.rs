//! The recorder that fills a result folder.

use std::path::PathBuf;

use super::arrays::ArraysWriter;
use super::checkpoint::{self, Saved};
use super::envelope::Envelope;
use super::folder::{CASE, CHECKPOINT, FIELDS, HISTORY, RAW_FIELDS, ResultFolder, SENSITIVITIES, SUMMARY};
use super::history::HistoryWriter;
use super::pictures::{self, STRETCHES};
use super::summary;
use crate::error::Result;
use crate::run::checkpoint::Checkpoint;
use crate::run::record::{Control, Header, Progress, Recorder};
use crate::run::summary::{Status, Summary};

/// Called after every step; decides whether to go on.
pub type Hook = Box<dyn FnMut(&Progress) -> Control>;

/// What is recorded besides the run itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Labels {
    /// Name of the case, for the pictures.
    pub case_name: String,
    /// The case as resolved, the text of `case.json`.
    pub case_json: String,
    /// Frequency of the drive [Hz]: pictures over space then show its last cycle.
    pub frequency_hz: Option<f64>,
}

/// Streams a run into a folder.
///
/// An older result in the folder stands until [`Recorder::begin`]: a run that cannot start destroys nothing. Dropped
/// without [`FolderRecorder::finish`], it leaves `history.csv` and the raw arrays as far as they were written.
pub struct FolderRecorder {
    folder: ResultFolder,
    labels: Labels,
    hook: Hook,
    open: Option<(HistoryWriter, ArraysWriter)>,
    sensitivities: Option<HistoryWriter>,
}

impl FolderRecorder {
    /// Into this folder, asking `hook` after every step.
    pub fn new(folder: ResultFolder, labels: Labels, hook: Hook) -> Self {
        Self {
            folder,
            labels,
            hook,
            open: None,
            sensitivities: None,
        }
    }

    /// Goes on in the folder of an interrupted run; what was recorded after its checkpoint is dropped.
    pub fn resume(folder: ResultFolder, labels: Labels, hook: Hook, saved: &Saved, header: &Header) -> Result<Self> {
        folder.remove(SUMMARY)?;
        let history = HistoryWriter::reopen(&folder.path(HISTORY), header.columns.len(), saved.history_bytes)?;
        let arrays = ArraysWriter::reopen(&folder.path(RAW_FIELDS), header, saved.instants)?;
        Ok(Self {
            open: Some((history, arrays)),
            ..Self::new(folder, labels, hook)
        })
    }

    /// Completes the folder however the run ended: arrays packed, pictures drawn, summary last. Returns the files.
    ///
    /// A run that failed before it began leaves an older result alone, and otherwise case and summary only.
    pub fn finish(mut self, summary: &Summary) -> Result<Vec<PathBuf>> {
        let mut files = Vec::new();
        let derivatives = self.sensitivities.take().map_or(Ok(()), |mut rows| {
            files.push(self.folder.path(SENSITIVITIES));
            rows.flush()
        });
        let completed = match self.open.take() {
            Some((history, arrays)) => {
                let resumable = summary.status != Status::Finished && self.folder.path(CHECKPOINT).exists();
                self.complete(history, arrays, resumable, &mut files)
            }
            None if self.folder.holds_older() => return Ok(files),
            None => Ok(()),
        };
        // The summary matters most: it is tried even when arrays or pictures could not be written.
        let case = self.labels.case_json.as_bytes();
        files.push(self.folder.write(CASE, case)?);
        files.push(summary::write(&self.folder, summary)?);
        completed.and(derivatives)?;
        Ok(files)
    }

    fn complete(
        &self,
        mut history: HistoryWriter,
        mut arrays: ArraysWriter,
        resumable: bool,
        files: &mut Vec<PathBuf>,
    ) -> Result<()> {
        history.flush()?;
        drop(history);
        let path = self.folder.path(HISTORY);
        let case = &self.labels.case_name;
        let mut drawn = pictures::over_time(case, &Envelope::read(&path, STRETCHES)?);
        files.push(path);
        drawn.extend(pictures::over_space(case, self.labels.frequency_hz, &mut arrays)?);
        let path = self.folder.path(FIELDS);
        arrays.finish(&path, resumable)?;
        files.push(path);
        for (name, text) in drawn {
            files.push(self.folder.write(name, text.as_bytes())?);
        }
        if resumable {
            Ok(())
        } else {
            self.folder.remove(CHECKPOINT)
        }
    }
}

impl Recorder for FolderRecorder {
    fn begin(&mut self, header: &Header) -> Result<()> {
        self.folder.clear()?;
        let history = HistoryWriter::create(&self.folder.path(HISTORY), &header.columns)?;
        let arrays = ArraysWriter::create(&self.folder.path(RAW_FIELDS), header)?;
        self.folder.write(CASE, self.labels.case_json.as_bytes())?;
        if !header.sensitivities.is_empty() {
            let path = self.folder.path(SENSITIVITIES);
            self.sensitivities = Some(HistoryWriter::with_names(&path, header.sensitivities.clone())?);
        }
        self.open = Some((history, arrays));
        Ok(())
    }

    fn history(&mut self, row: &[f64]) -> Result<()> {
        self.open.as_mut().map_or(Ok(()), |(history, _)| history.row(row))
    }

    fn sensitivities(&mut self, row: &[f64]) -> Result<()> {
        self.sensitivities.as_mut().map_or(Ok(()), |rows| rows.row(row))
    }

    fn fields(&mut self, t: f64, arrays: &[&[f64]]) -> Result<()> {
        self.open
            .as_mut()
            .map_or(Ok(()), |(_, writer)| writer.append(t, arrays))
    }

    fn progress(&mut self, progress: &Progress) -> Result<Control> {
        Ok((self.hook)(progress))
    }

    fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let Some((history, arrays)) = self.open.as_mut() else {
            return Ok(());
        };
        let saved = Saved {
            history_bytes: history.secure()?,
            instants: arrays.secure()?,
            run: checkpoint.clone(),
        };
        checkpoint::write(&self.folder, &saved)
    }
}
