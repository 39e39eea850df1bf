//! The recorder that fills a result folder.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Instant;

use super::arrays::ArraysWriter;
use super::checkpoint::{self, SavedCheckpoint};
use super::downsampled_history::{BackgroundWriter, GrowingFiles};
use super::envelope::{Envelope, HistoryInMemory, HistorySource};
use super::error_band::{self, ComparedHistories};
use super::folder::{
    AtomicFile, CHECKPOINT, CHECKPOINT_BEFORE, ENVELOPE, ERRORS, FIELDS, HISTORY, PICTURES, RAW_FIELDS, REPORT,
    ResultFolder, SENSITIVITIES, SUMMARY, Wait, at_once,
};
use super::history::{HistoryWriter, headings};
use super::pictures::{self, Labels, NamedSvg, STRETCHES};
use super::stream::Stream;
use super::{report, summary};
use crate::error::Result;
use crate::integrate::halt;
use crate::numerics::threads::{StartedTask, begin};
use crate::run::checkpoint::Checkpoint;
use crate::run::record::{Control, Header, Progress, Recorder, ThinnedRows};
use crate::run::summary::{Status, Summary};
use crate::run::wall_time::Stopwatch;

/// Called after every step; decides whether the run continues.
pub type Hook = Box<dyn FnMut(&Progress) -> Control>;

/// Streams a run into a folder.
///
/// An older result in the folder stays until [`Recorder::begin`], so a run that cannot start destroys nothing. Dropping it without
/// [`FolderRecorder::finish`] keeps `history.csv` and the raw arrays as written so far.
pub struct FolderRecorder {
    folder: ResultFolder,
    labels: Labels,
    hook: Hook,
    lean: bool,
    open: Option<BackgroundWriter>,
    compared: ComparedHistories,
}

impl FolderRecorder {
    /// Records into this folder, with `hook` called after every step.
    pub fn new(folder: ResultFolder, labels: Labels, hook: Hook) -> Self {
        Self {
            folder,
            labels,
            hook,
            lean: false,
            open: None,
            compared: ComparedHistories::default(),
        }
    }

    /// Keeps only summary, case and arrays at the end. Tables are still written during the run: they identify the folder, and the run can
    /// resume from them.
    #[must_use]
    pub fn lean(self, lean: bool) -> Self {
        Self { lean, ..self }
    }

    /// Resumes in the folder of an interrupted run. Drops everything recorded after the checkpoint. Verifies all files before it changes
    /// any.
    ///
    /// # Errors
    /// A file is damaged or missing; then the folder is unchanged.
    pub fn resume(
        folder: ResultFolder,
        labels: Labels,
        hook: Hook,
        at: &SavedCheckpoint,
        header: &Header,
    ) -> Result<Self> {
        let (at, history, raw) = (&at.files, folder.path(HISTORY), folder.path(RAW_FIELDS));
        Stream::verify(&history, at.history)?;
        ArraysWriter::verify(&raw, header, &at.fields)?;
        let besides = [(ENVELOPE, at.envelope), (SENSITIVITIES, at.sensitivities)];
        for (name, mark) in besides {
            mark.map_or(Ok(()), |mark| Stream::verify(&folder.path(name), mark))?;
        }
        folder.remove(SUMMARY)?;
        folder.remove_exports()?;
        let history = HistoryWriter::reopen(&history, at.history)?;
        let compared = ComparedHistories::read(folder.dir(), header)?;
        let arrays = ArraysWriter::reopen(&raw, header, &at.fields)?;
        let [envelope, sensitivities] = besides.map(|(name, mark)| {
            let path = folder.path(name);
            mark.map(|mark| HistoryWriter::reopen(&path, mark)).transpose()
        });
        let files = GrowingFiles {
            history,
            kept: None,
            arrays,
            envelope: envelope?,
            sensitivities: sensitivities?,
        };
        Ok(Self {
            open: Some(BackgroundWriter::new(files)?),
            compared,
            ..Self::new(folder, labels, hook)
        })
    }

    /// Completes the folder, however the run ended. Syncs history, arrays and summary to the disk together, then gives arrays and summary
    /// their names; pictures follow. The files from which a run resumes stay until [`Finished::close`], so that the completion can be
    /// repeated.
    ///
    /// A run that failed before it began leaves case and summary, and moves an older result aside.
    ///
    /// # Errors
    /// A file cannot be written. If it is a table or an array, the summary has the status `failed` and the reason.
    pub fn finish(mut self, summary: &Summary) -> Result<Finished> {
        let (mut laps, mut spent) = (Stopwatch::since(Instant::now()), WriteTimes::default());
        let aside = match self.open {
            Some(_) => None,
            None => self.folder.set_aside()?,
        };
        let cased = self.folder.write_case(&self.labels.case);
        let completed = match self.open.take() {
            Some(open) => halt::complete(|| self.complete(open, summary, &mut laps, &mut spent)),
            None => summary::write(&self.folder, summary).map(|_| Completed::default()),
        };
        if let Err(error) = &completed {
            // If arrays or tables are incomplete, no file may claim that they are complete. The summary matters most, so it is attempted
            // after any other failure.
            let failed = Summary {
                status: Status::Failed,
                reason: Some(error.to_string()),
                ..summary.clone()
            };
            let _ = summary::write(&self.folder, &failed);
        }
        let Completed {
            drawn,
            history,
            tables_crc32,
        } = cased.and(completed)?;
        self.folder.secure_behind()?;
        if self.lean {
            // those of a run that was resumed
            self.folder.remove_all(&PICTURES)?;
            self.folder.remove_all(&[REPORT, ERRORS])?;
        }
        for pictures in drawn {
            for (name, picture) in pictures? {
                self.folder.lay(name, picture.as_bytes())?;
            }
        }
        spent.files += laps.lap();
        Ok(Finished {
            spent,
            lean: self.lean,
            resumable: summary.status != Status::Finished && self.folder.path(CHECKPOINT).exists(),
            folder: self.folder,
            history,
            aside,
            tables_crc32,
        })
    }

    /// Syncs tables, arrays and summary to the disk, and draws the pictures meanwhile.
    fn complete(
        &self,
        open: BackgroundWriter,
        summary: &Summary,
        laps: &mut Stopwatch,
        spent: &mut WriteTimes,
    ) -> Result<Completed> {
        let mut files = open.close()?;
        files.arrays.flush()?;
        let arrays = &files.arrays;
        let band = self.compared.band(summary, self.labels.frequency_hz);
        let errors = band.iter().map(|band| error_band::write(self.folder.dir(), band));
        let errors = errors.collect::<Result<Vec<_>>>()?;
        let tables = [Some(files.history), files.envelope, files.sensitivities];
        // a lean run that has finished removes them again
        let stay = !self.lean || summary.status != Status::Finished;
        let mut tables: Vec<_> = tables.into_iter().flatten().chain(errors).filter(|_| stay).collect();
        tables.iter_mut().try_for_each(HistoryWriter::flush)?;
        let tables_crc32: BTreeMap<_, _> = tables.iter().map(HistoryWriter::checksum).collect();
        let checked = Summary {
            tables_crc32: tables_crc32.clone(),
            ..summary.clone()
        };
        let (laid, text) = (self.folder.laid(), summary::to_json(&checked));
        let [fields, summary] = [FIELDS, SUMMARY].map(|name| self.folder.path(name));
        spent.files += laps.lap();
        let (labels, dir) = (&self.labels, self.folder.dir());
        let case = &labels.case_name;
        let over_time = || {
            let rows = Envelope::read(HistorySource::new(dir, files.kept.as_ref()), STRETCHES)?;
            Ok(pictures::over_time(case, &rows, &band.unwrap_or_default()))
        };
        let drawn = thread::scope(|scope| {
            let drawing = match self.lean {
                true => vec![],
                false => vec![
                    begin(scope, over_time),
                    begin(scope, || pictures::over_space(labels, arrays)),
                ],
            };
            let put = put(tables, &laid, (arrays, &fields), (&text, &summary));
            spent.files += laps.lap();
            let drawn = drawing.into_iter().map(StartedTask::join).collect();
            spent.pictures += laps.lap();
            put.map(|()| drawn)
        })?;
        Ok(Completed {
            drawn,
            history: files.kept,
            tables_crc32,
        })
    }
}

/// Results of completing a folder.
#[derive(Default)]
struct Completed {
    /// Pictures, or errors of drawing.
    drawn: Vec<Result<Vec<NamedSvg>>>,
    /// The history, if it is in memory.
    history: Option<HistoryInMemory>,
    /// CRC-32 of the tables.
    tables_crc32: BTreeMap<String, u32>,
}

/// Syncs tables, laid files, arrays and summary to the disk at the same time; then renames arrays and summary.
fn put(
    mut tables: Vec<HistoryWriter>,
    laid: &[AtomicFile],
    (arrays, fields): (&ArraysWriter, &Path),
    (text, summary): (&str, &Path),
) -> Result<()> {
    let fields = arrays.packed(fields)?;
    let summary = AtomicFile::fill(summary, |file| file.write_all(text.as_bytes()))?;
    let tables = tables
        .iter_mut()
        .map(|table| Box::new(|| table.secure().map(|_| ())) as Wait);
    let others = laid.iter().chain([&fields, &summary]).map(AtomicFile::wait);
    at_once(tables.chain(others).collect())?;
    fields.name()?;
    summary.name().map(|_| ())
}

/// Wall time of completing a folder [s].
#[derive(Clone, Copy, Debug, Default)]
pub struct WriteTimes {
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
    history: Option<HistoryInMemory>,
    resumable: bool,
    lean: bool,
    /// Wall time of the completion.
    pub spent: WriteTimes,
    /// Folder to which an older result was moved.
    pub aside: Option<PathBuf>,
    /// CRC-32 of the tables, for rewriting the summary.
    pub tables_crc32: BTreeMap<String, u32>,
}

impl Finished {
    /// A folder that has taken over the complete result of another folder.
    pub fn new(folder: ResultFolder) -> Self {
        Self {
            resumable: true,
            lean: false,
            folder,
            history: None,
            spent: WriteTimes::default(),
            aside: None,
            tables_crc32: BTreeMap::new(),
        }
    }

    /// Replaces the result by that of another folder.
    ///
    /// # Errors
    /// The files cannot be moved.
    pub fn replace(&mut self, with: &Path) -> Result<()> {
        self.folder.replace(with)?;
        (self.resumable, self.history) = (true, None);
        Ok(())
    }

    /// Writes the page of the result.
    ///
    /// # Errors
    /// The page cannot be written. Then do not close the folder, so that the completion can be repeated.
    pub fn page(&self) -> Result<()> {
        report::lay(&self.folder, self.history.as_ref())
    }

    /// Syncs everything to the disk and removes the files from which a run resumes, unless the run can still resume. Returns the folder,
    /// still locked.
    pub fn close(self) -> Result<ResultFolder> {
        self.folder.secure()?;
        if self.resumable {
            return Ok(self.folder);
        }
        if self.folder.remove_all(&[CHECKPOINT_BEFORE, CHECKPOINT])? {
            self.folder.secure()?;
        }
        self.folder.remove_raw()?;
        if self.lean {
            // last: a remaining checkpoint would be unusable without these
            self.folder.remove_all(&[HISTORY, ENVELOPE, SENSITIVITIES])?;
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
        // the complete history, for page and pictures
        let shown = !self.lean && header.envelope.is_empty();
        let files = GrowingFiles {
            history,
            kept: shown.then(|| HistoryInMemory::new(&headings(&header.columns))),
            arrays,
            envelope: table(ENVELOPE, &header.envelope)?,
            sensitivities: table(SENSITIVITIES, &header.sensitivities)?,
        };
        self.open = Some(BackgroundWriter::new(files)?);
        self.compared = ComparedHistories::new(header);
        Ok(())
    }

    fn companion(&mut self, rows: &ThinnedRows) -> Result<()> {
        self.compared.companion = (!self.lean).then(|| rows.clone());
        Ok(())
    }

    fn history(&mut self, row: &[f64]) -> Result<()> {
        if !self.lean {
            self.compared.run.push(row);
        }
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
        let (files, run) = (open.secure()?, checkpoint.clone());
        checkpoint::write(&self.folder, &SavedCheckpoint { files, run })
    }
}
