//! Journals: one JSON object per line, each with a checksum over its row and the plan. An incomplete last line of a killed program is
//! dropped. A row that was changed or belongs to another plan is ignored.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::folder::{damaged, fault, open};
use crate::error::Result;

/// Largest length of the line of a row [byte].
const LONGEST: u64 = 16 << 20;

/// Separator between a row and its checksum.
const SEAL: &[u8] = b",\"crc32\":";

/// Largest number of damaged lines named in a message.
const NAMED: usize = 5;

/// A journal that is being written.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Checksum of the plan.
    plan: u32,
}

/// The line of a row: its JSON object with the checksum as the last key.
fn sealed(plan: u32, row: &impl Serialize) -> serde_json::Result<Vec<u8>> {
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

/// A line that was read.
enum Line<T> {
    Checked(T),
    /// A row of a version before checksums.
    Unchecked(T),
    Damaged,
}

impl<T: Serialize + DeserializeOwned> Line<T> {
    fn read(plan: u32, line: &[u8]) -> Self {
        let Ok(row) = serde_json::from_slice::<T>(line) else {
            return Self::Damaged;
        };
        let sealed_line = line.windows(SEAL.len()).any(|part| part == SEAL);
        // byte for byte: an unknown key or a space may be the rest of a checksum
        match sealed_line {
            true if sealed(plan, &row).is_ok_and(|own| own.strip_suffix(b"\n") == Some(line)) => Self::Checked(row),
            false if serde_json::to_vec(&row).is_ok_and(|own| own == line) => Self::Unchecked(row),
            _ => Self::Damaged,
        }
    }
}

impl Journal {
    /// Opens a journal to append after its complete lines.
    ///
    /// # Errors
    /// The file cannot be created or truncated.
    pub fn go_on(path: PathBuf, lines: &Lines) -> Result<Self> {
        let opened = || -> io::Result<File> {
            if path.is_symlink() {
                let why =
                    "it is a symbolic link, and rows are not written through one; put the file itself in its place";
                return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
            }
            let file = OpenOptions::new().append(true).create(true).open(&path)?;
            if file.metadata()?.len() > lines.whole {
                file.set_len(lines.whole)?;
            }
            file.sync_all()?;
            Ok(file)
        };
        let file = opened().map_err(|e| fault("write", &path, e))?;
        let plan = lines.plan;
        Ok(Self { path, file, plan })
    }

    /// Appends a row and syncs it to the disk.
    ///
    /// # Errors
    /// The row cannot be written.
    pub fn append(&mut self, row: &impl Serialize) -> Result<()> {
        self.put(row)?;
        self.secure()
    }

    /// Appends a row in one piece; skips a row above the largest length.
    ///
    /// # Errors
    /// The row cannot be written.
    pub fn put(&mut self, row: &impl Serialize) -> Result<()> {
        let line = sealed(self.plan, row).map_err(|e| fault("write", &self.path, e.into()))?;
        if line.len() as u64 >= LONGEST {
            return Ok(());
        }
        self.file.write_all(&line).map_err(|e| fault("write", &self.path, e))
    }

    /// Syncs all rows to the disk.
    ///
    /// # Errors
    /// The rows cannot be written.
    pub fn secure(&self) -> Result<()> {
        self.file.sync_data().map_err(|e| fault("write", &self.path, e))
    }
}

/// The lines of a journal, without their rows.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    path: PathBuf,
    /// Bytes of complete lines.
    whole: u64,
    /// Checksum of the plan.
    plan: u32,
    /// Numbers of lines, from 1, whose rows were changed or belong to another plan.
    damaged: Vec<usize>,
}

impl Lines {
    /// Reads a journal, if it exists, and passes each valid row to `take` with the byte offset of its line. If `unchecked`, rows without
    /// checksums, from earlier versions, are valid up to the first row with a checksum.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn read<T: Serialize + DeserializeOwned>(
        path: &Path,
        plan: u32,
        unchecked: bool,
        mut take: impl FnMut(u64, T),
    ) -> Result<Self> {
        let mut found = Self {
            path: path.to_path_buf(),
            plan,
            ..Self::default()
        };
        if path.exists() {
            found.walk(!unchecked, &mut take).map_err(|e| fault("read", path, e))?;
        }
        Ok(found)
    }

    fn walk<T: Serialize + DeserializeOwned>(
        &mut self,
        mut checked: bool,
        take: &mut impl FnMut(u64, T),
    ) -> io::Result<()> {
        let mut lines = BufReader::new(open(&self.path)?);
        let (mut line, mut number) = (vec![], 0);
        loop {
            number += 1;
            line.clear();
            let begin = self.whole;
            let length = lines.by_ref().take(LONGEST).read_until(b'\n', &mut line)? as u64;
            if line.pop() != Some(b'\n') {
                if length == LONGEST {
                    return Err(damaged("a line of it is longer than any row"));
                }
                return Ok(());
            }
            self.whole += length;
            match Line::read(self.plan, &line) {
                Line::Checked(row) => {
                    checked = true;
                    take(begin, row);
                }
                // rows of an earlier version precede all others
                Line::Unchecked(row) if !checked => take(begin, row),
                _ => self.damaged.push(number),
            }
        }
    }

    /// Path of the journal.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Description of damaged rows; `None` if there are none. `plan` names the other plan to which rows may belong.
    pub fn damage(&self, plan: &str) -> Option<String> {
        let count = self.damaged.len();
        let named: Vec<String> = self.damaged.iter().take(NAMED).map(usize::to_string).collect();
        let (rows, more) = (
            if count == 1 { "row is" } else { "rows are" },
            if count > NAMED { ", .." } else { "" },
        );
        (count > 0).then(|| {
            format!(
                "{}: {count} {rows} not used (line {}{more}): a checksum differs, so that the row was changed or belongs to another {plan}",
                self.path.display(),
                named.join(", ")
            )
        })
    }
}
