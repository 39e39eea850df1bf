//! Journals: a JSON object a line, each with a checksum of its row and of the plan. What a killed program leaves half written at the
//! end is dropped; a row that was changed, or that belongs to another plan, is not used.

use std::fs::{File, OpenOptions};
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::folder::{damaged, fault, open};
use crate::error::Result;

/// No line of a row is longer [byte].
const LONGEST: u64 = 16 << 20;

/// What separates a row from its checksum.
const SEAL: &[u8] = b",\"crc32\":";

/// Lines of damaged rows that a message names.
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

/// A line as it was read.
enum Line<T> {
    Checked(T),
    /// A row as versions before checksums wrote it.
    Unchecked(T),
    Damaged,
}

impl<T: Serialize + DeserializeOwned> Line<T> {
    fn read(plan: u32, line: &[u8]) -> Self {
        let Ok(row) = serde_json::from_slice::<T>(line) else {
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

    /// Appends a row; it is on the disk when this returns.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn append(&mut self, row: &impl Serialize) -> Result<()> {
        self.put(row)?;
        self.secure()
    }

    /// Appends a row, in one piece; one that is longer than any is left out.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn put(&mut self, row: &impl Serialize) -> Result<()> {
        let line = sealed(self.plan, row).map_err(|e| fault("write", &self.path, e.into()))?;
        if line.len() as u64 >= LONGEST {
            return Ok(());
        }
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

/// The lines of a journal, without their rows.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    path: PathBuf,
    /// Bytes of whole lines.
    whole: u64,
    /// Checksum of the plan.
    plan: u32,
    /// Numbers of lines, from 1, whose rows were changed or belong to another plan.
    damaged: Vec<usize>,
}

impl Lines {
    /// Reads a journal, where there is one, and gives each sound row to `take` with the byte at which its line begins. Rows without
    /// checksums, which versions before these wrote, are sound before the first that has one, where `unchecked` admits them.
    ///
    /// # Errors
    /// It cannot be read.
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
                // those of an earlier version come before all others
                Line::Unchecked(row) if !checked => take(begin, row),
                _ => self.damaged.push(number),
            }
        }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What is damaged, in words; nothing where nothing is. `plan` is what rows may belong to besides.
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
