//! `designs.jsonl`: a line a design, each with a checksum of its row and of the plan. What a killed program leaves half written at its
//! end is dropped; a row that was changed, or that belongs to another plan, is not used.

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

/// What separates a row from its checksum.
const SEAL: &[u8] = b",\"crc32\":";

/// Lines of damaged rows that a message names.
const NAMED: usize = 5;

/// The lines of a sweep under way.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Checksum of the plan.
    plan: u32,
}

/// The line of a row: its JSON object with the checksum as the last key.
fn sealed(plan: u32, row: &Row) -> serde_json::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(row)?;
    let sum = checksum(plan, &line);
    line.pop();
    line.extend_from_slice(SEAL);
    line.extend_from_slice(format!("{sum}}}\n").as_bytes());
    Ok(line)
}

fn checksum(plan: u32, row: &[u8]) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(&plan.to_le_bytes());
    sum.update(row);
    sum.finalize()
}

/// A line as it was read.
enum Line {
    Checked(Row),
    /// A row as versions before checksums wrote it.
    Unchecked(Row),
    Damaged,
}

impl Line {
    fn read(plan: u32, line: &[u8]) -> Self {
        let Ok(row) = serde_json::from_slice::<Row>(line) else {
            return Self::Damaged;
        };
        let sealed_line = line.windows(SEAL.len()).any(|part| part == SEAL);
        // byte for byte: an unknown key or a space may be what is left of a checksum
        match sealed_line {
            true if sealed(plan, &row).is_ok_and(|own| own.strip_suffix(b"\n") == Some(line)) => Self::Checked(row),
            false if serde_json::to_vec(&row).is_ok_and(|own| own == line) => Self::Unchecked(row),
            _ => Self::Damaged,
        }
    }
}

impl Journal {
    /// Opens it to go on behind what is whole.
    ///
    /// # Errors
    /// It cannot be made or cut.
    pub fn go_on(folder: &ResultFolder, survey: &Survey) -> Result<Self> {
        let path = folder.path(JOURNAL);
        let opened = || -> io::Result<File> {
            if path.is_symlink() {
                let why =
                    "it is a symbolic link, and rows are not written through one; put the file itself in its place";
                return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
            }
            let file = OpenOptions::new().append(true).create(true).open(&path)?;
            if file.metadata()?.len() > survey.whole {
                file.set_len(survey.whole)?;
            }
            file.sync_all()?;
            Ok(file)
        };
        let file = opened().map_err(|e| fault("write", &path, e))?;
        folder.secure()?;
        let plan = survey.plan;
        Ok(Self { path, file, plan })
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
        let line = sealed(self.plan, row).map_err(|e| fault("write", &self.path, e.into()))?;
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
    /// Checksum of the plan.
    plan: u32,
    /// Numbers of lines, from 1, whose rows were changed or belong to another plan.
    damaged: Vec<usize>,
    /// Names of figures, in the order of the first row that has them.
    pub figures: Vec<String>,
    /// Rows by how they ended.
    pub statuses: BTreeMap<Status, usize>,
}

impl Survey {
    /// Of a file; of none where there is none. A damaged line is not used; of two rows of a design the first
    /// that finished counts, else the last.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of(path: &Path, plan: &Plan) -> Result<Self> {
        let mut found = Self {
            path: path.to_path_buf(),
            begins: vec![0; plan.designs],
            ended: vec![None; plan.designs],
            plan: plan.crc32(),
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
        let (mut checked, mut number) = (false, 0);
        loop {
            number += 1;
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
            let row = match Line::read(self.plan, &line) {
                Line::Checked(row) => {
                    checked = true;
                    row
                }
                // those of an earlier version come before all others
                Line::Unchecked(row) if !checked => row,
                _ => {
                    self.damaged.push(number);
                    continue;
                }
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

    /// What is damaged, in words; nothing where nothing is.
    pub fn damage(&self) -> Option<String> {
        let count = self.damaged.len();
        let named: Vec<String> = self.damaged.iter().take(NAMED).map(usize::to_string).collect();
        let (rows, more) = (
            if count == 1 { "row is" } else { "rows are" },
            if count > NAMED { ", .." } else { "" },
        );
        (count > 0).then(|| {
            format!(
                "{}: {count} {rows} not used (line {}{more}): a checksum differs, so that the row was changed or belongs to another sweep",
                self.path.display(),
                named.join(", ")
            )
        })
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
