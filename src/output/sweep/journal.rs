//! `designs.jsonl`: a line a design. What a killed program leaves half written at its end is dropped.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use super::JOURNAL;
use crate::error::Result;
use crate::output::folder::{ResultFolder, damaged, fault, open};
use crate::run::summary::Status;
use crate::study::sweep::{Plan, Row};

/// No line of a row is longer [byte].
const LONGEST: u64 = 16 << 20;

/// The lines of a sweep under way.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Opens it to go on behind what is whole.
    ///
    /// # Errors
    /// It cannot be made or cut.
    pub fn go_on(folder: &ResultFolder, survey: &Survey) -> Result<Self> {
        let path = folder.path(JOURNAL);
        let opened = || -> io::Result<File> {
            let file = OpenOptions::new().append(true).create(true).open(&path)?;
            if file.metadata()?.len() > survey.whole {
                file.set_len(survey.whole)?;
            }
            file.sync_all()?;
            Ok(file)
        };
        let file = opened().map_err(|e| fault("write", &path, e))?;
        folder.secure()?;
        Ok(Self { path, file })
    }

    /// Appends a row; it is on the disk when this returns.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn append(&mut self, row: &Row) -> Result<()> {
        self.put(row)?;
        self.secure()
    }

    /// Appends a row, in one piece.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn put(&mut self, row: &Row) -> Result<()> {
        let mut line = serde_json::to_vec(row).map_err(|e| fault("write", &self.path, e.into()))?;
        line.push(b'\n');
        self.file.write_all(&line).map_err(|e| fault("write", &self.path, e))
    }

    /// Brings everything to the disk.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn secure(&self) -> Result<()> {
        self.file.sync_data().map_err(|e| fault("write", &self.path, e))
    }
}

/// What a journal holds, without its rows.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    path: PathBuf,
    /// Where the line of each design begins, one more; 0 where there is none.
    begins: Vec<u64>,
    /// How each ended that has one.
    ended: Vec<Option<Status>>,
    /// Bytes of whole lines.
    whole: u64,
    /// Names of figures, in the order of the first row that has them.
    pub figures: Vec<String>,
    /// Rows by how they ended.
    pub statuses: BTreeMap<Status, usize>,
}

impl Survey {
    /// Of a file; of none where there is none. A line that is no row of the plan is passed over; of two rows of a design the first
    /// that finished counts, else the last.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of(path: &Path, plan: &Plan) -> Result<Self> {
        let mut found = Self {
            path: path.to_path_buf(),
            begins: vec![0; plan.designs],
            ended: vec![None; plan.designs],
            ..Self::default()
        };
        if path.exists() {
            found.read(plan).map_err(|e| fault("read", path, e))?;
        }
        Ok(found)
    }

    fn read(&mut self, plan: &Plan) -> io::Result<()> {
        let mut lines = BufReader::new(open(&self.path)?);
        let mut line = vec![];
        // by name, the first design that has it and its place there
        let mut names: BTreeMap<String, (usize, usize)> = BTreeMap::new();
        loop {
            line.clear();
            let begin = self.whole;
            let length = lines.by_ref().take(LONGEST).read_until(b'\n', &mut line)? as u64;
            if line.pop() != Some(b'\n') {
                if length == LONGEST {
                    return Err(damaged("a line of it is longer than any row"));
                }
                break;
            }
            self.whole += length;
            let Ok(row) = serde_json::from_slice::<Row>(&line) else {
                continue;
            };
            let fits = row.number < plan.designs && row.case < plan.cases.len() && row.values.len() == plan.axes.len();
            if !fits || !plan.has(row.number) || self.finished(row.number) {
                continue;
            }
            self.begins[row.number] = begin + 1;
            self.ended[row.number] = Some(row.found.status);
            for (place, (name, _)) in row.found.figures.into_iter().enumerate() {
                let here = (row.number, place);
                let first = names.entry(name).or_insert(here);
                *first = here.min(*first);
            }
        }
        for status in self.ended.iter().flatten() {
            *self.statuses.entry(*status).or_default() += 1;
        }
        let mut all: Vec<_> = names.into_iter().collect();
        all.sort_by_key(|(_, place)| *place);
        self.figures = all.into_iter().map(|(name, _)| name).collect();
        Ok(())
    }

    /// Rows.
    pub fn count(&self) -> usize {
        self.begins.iter().filter(|begin| **begin > 0).count()
    }

    /// Whether a design has a row.
    pub fn has(&self, number: usize) -> bool {
        self.begins.get(number).is_some_and(|begin| *begin > 0)
    }

    /// Whether a design has a row that tells all.
    pub fn finished(&self, number: usize) -> bool {
        self.ended.get(number) == Some(&Some(Status::Finished))
    }

    /// Gives every row to `take`, in the order of numbers.
    ///
    /// # Errors
    /// One cannot be read, or those of `take`.
    pub fn each(&self, mut take: impl FnMut(Row) -> io::Result<()>) -> Result<()> {
        let mut read = || -> io::Result<()> {
            if self.count() == 0 {
                return Ok(());
            }
            let mut lines = BufReader::new(open(&self.path)?);
            let (mut line, mut at) = (vec![], 0);
            for begin in self.begins.iter().filter_map(|begin| begin.checked_sub(1)) {
                if begin != at {
                    lines.seek(SeekFrom::Start(begin))?;
                }
                line.clear();
                at = begin + lines.read_until(b'\n', &mut line)? as u64;
                take(serde_json::from_slice(&line)?)?;
            }
            Ok(())
        };
        read().map_err(|e| fault("read", &self.path, e))
    }
}
