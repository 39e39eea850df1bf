//! `designs.jsonl`: one line per design.

use std::collections::BTreeMap;
use std::io::{self, BufRead as _, BufReader, Seek as _, SeekFrom};
use std::path::Path;

use super::JOURNAL;
use crate::error::Result;
use crate::output::folder::{ResultFolder, fault, open};
use crate::output::journal::{Journal, Lines};
use crate::run::summary::Status;
use crate::study::sweep::{SweepPlan, SweepRow};

/// Content of a journal without its rows.
#[derive(Clone, Debug, Default)]
pub struct JournalSummary {
    lines: Lines,
    /// Byte offset of the line of each design, plus 1; 0 if there is none.
    begins: Vec<u64>,
    /// Status of each design that has a row.
    ended: Vec<Option<Status>>,
    /// Names of figures, in the order of the first row that has them.
    pub figures: Vec<String>,
    /// Number of rows by status.
    pub statuses: BTreeMap<Status, usize>,
}

impl JournalSummary {
    /// Reads a journal; a missing file counts as empty. Ignores damaged lines. Of several rows of a design the first that finished counts,
    /// else the last.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn read(path: &Path, plan: &SweepPlan) -> Result<Self> {
        let mut found = Self {
            begins: vec![0; plan.designs],
            ended: vec![None; plan.designs],
            ..Self::default()
        };
        // by name: the first design with this figure, and its place there
        let mut names: BTreeMap<String, (usize, usize)> = BTreeMap::new();
        found.lines = Lines::read(path, plan.crc32(), true, |begin, row: SweepRow| {
            let fits = row.number < plan.designs && row.case < plan.cases.len() && row.values.len() == plan.axes.len();
            if !fits || !plan.has(row.number) || found.finished(row.number) {
                return;
            }
            found.begins[row.number] = begin + 1;
            found.ended[row.number] = Some(row.found.status);
            for (place, (name, _)) in row.found.figures.into_iter().enumerate() {
                let here = (row.number, place);
                let first = names.entry(name).or_insert(here);
                *first = here.min(*first);
            }
        })?;
        for status in found.ended.iter().flatten() {
            *found.statuses.entry(*status).or_default() += 1;
        }
        let mut all: Vec<_> = names.into_iter().collect();
        all.sort_by_key(|(_, place)| *place);
        found.figures = all.into_iter().map(|(name, _)| name).collect();
        Ok(found)
    }

    /// Opens the journal to append after its complete lines.
    ///
    /// # Errors
    /// The file cannot be created or truncated.
    pub fn go_on(&self, folder: &ResultFolder) -> Result<Journal> {
        let journal = Journal::go_on(folder.path(JOURNAL), &self.lines)?;
        folder.secure()?;
        Ok(journal)
    }

    /// Description of damaged rows; `None` if there are none.
    pub fn damage(&self) -> Option<String> {
        self.lines.damage("sweep")
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.begins.iter().filter(|begin| **begin > 0).count()
    }

    /// True if a design has a row.
    pub fn has(&self, number: usize) -> bool {
        self.begins.get(number).is_some_and(|begin| *begin > 0)
    }

    /// True if a design has a row that finished.
    pub fn finished(&self, number: usize) -> bool {
        self.ended.get(number) == Some(&Some(Status::Finished))
    }

    /// Passes every row to `take`, in the order of design numbers.
    ///
    /// # Errors
    /// A row cannot be read, or `take` fails.
    pub fn each(&self, mut take: impl FnMut(SweepRow) -> io::Result<()>) -> Result<()> {
        let mut read = || -> io::Result<()> {
            if self.count() == 0 {
                return Ok(());
            }
            let mut lines = BufReader::new(open(self.lines.path())?);
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
        read().map_err(|e| fault("read", self.lines.path(), e))
    }
}
