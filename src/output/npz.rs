//! Reads arrays from a `.npz`. Sizes stated in the file are compared with its real size before memory is allocated, and data with their
//! checksum.
//!
//! Accepts only the format that this program writes ([`super::arrays`]): entries that are stored, not deflated, of little-endian doubles,
//! row by row. Any other file is foreign or damaged.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use zip::ZipArchive;
use zip::read::ZipFile;

use super::folder::{damaged, open};

/// Largest header of an array [byte]; headers of this program have 118.
const LONGEST: usize = 4096;
/// Largest number of arrays; a result has about twenty.
const MOST: usize = 1000;

/// Name and shape of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Name of the array.
    pub name: String,
    /// Lengths of its one or two dimensions.
    pub shape: Vec<usize>,
}

impl Entry {
    /// Length of a row: all numbers of an axis, or those of one instant of a field.
    pub fn width(&self) -> usize {
        self.shape[self.shape.len() - 1]
    }

    /// Number of rows; an axis has one.
    pub fn rows(&self) -> usize {
        if self.shape.len() == 1 { 1 } else { self.shape[0] }
    }
}

/// A file of arrays whose stated sizes are verified.
pub struct Npz {
    zip: ZipArchive<BufReader<File>>,
    entries: Vec<Entry>,
}

impl Npz {
    /// Opens the file and checks the header of every array.
    ///
    /// # Errors
    ///
    /// The file is no such archive; an array is stated to be larger than its entry, or all entries together larger than the file, as when
    /// they overlap; a name is not that of an array.
    pub fn open(path: &Path) -> io::Result<Self> {
        let file = open(path)?;
        let there = file.metadata()?.len();
        let mut zip = ZipArchive::new(BufReader::new(file))?;
        if zip.len() > MOST {
            return Err(damaged(format!(
                "its directory lists {} arrays; a result has at most {MOST}",
                zip.len()
            )));
        }
        let (mut entries, mut total) = (vec![], 0_u64);
        for k in 0..zip.len() {
            let mut entry = zip.by_index(k)?;
            let size = entry.size();
            total = total.saturating_add(size);
            if total > there || entry.compressed_size() != size {
                return Err(damaged(format!(
                    "its arrays would have {total} bytes or more, the file has {there}"
                )));
            }
            let name = entry.name()?.strip_suffix(".npy").map(String::from);
            let name =
                name.filter(|name| !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_'));
            let Some(name) = name else {
                return Err(damaged("an entry of it has not the name of an array"));
            };
            let shape = describe(&mut entry, size).map_err(|e| damaged(format!("{name}: {e}")))?;
            entries.push(Entry { name, shape });
        }
        Ok(Self { zip, entries })
    }

    /// All arrays, in the order of the file.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// An array by name.
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.name == name)
    }

    /// All numbers of an array.
    ///
    /// # Errors
    ///
    /// There is no such array, it is incomplete, or its checksum differs.
    pub fn read(&mut self, name: &str) -> io::Result<Vec<f64>> {
        let mut rows = self.rows(name)?;
        let mut all = Vec::with_capacity(rows.left * rows.width);
        let mut row = vec![];
        while rows.next(&mut row)? {
            all.extend_from_slice(&row);
        }
        rows.finish()?;
        Ok(all)
    }

    /// Reads an array row by row: a file may be larger than memory.
    ///
    /// # Errors
    ///
    /// There is no such array.
    pub fn rows(&mut self, name: &str) -> io::Result<NpzRows<'_>> {
        let found = self.entries.iter().position(|e| e.name == name);
        let k = found.ok_or_else(|| damaged(format!("{name} is missing")))?;
        let (width, left) = (self.entries[k].width(), self.entries[k].rows());
        let mut entry = self.zip.by_index(k)?;
        let size = entry.size();
        describe(&mut entry, size).map_err(|e| damaged(format!("{name}: {e}")))?;
        Ok(NpzRows {
            entry,
            width,
            left,
            bytes: vec![0; 8 * width],
        })
    }

    /// Passes the rows with these numbers, ascending, to a function. Returns the rows after them.
    ///
    /// # Errors
    ///
    /// There is no such array, or it is incomplete.
    pub fn chosen(&mut self, name: &str, wanted: &[usize], with: &mut dyn FnMut(&[f64])) -> io::Result<NpzRows<'_>> {
        let mut rows = self.rows(name)?;
        let (mut row, mut at) = (vec![], 0);
        for &number in wanted {
            for _ in at..number {
                rows.pass()?;
            }
            if rows.next(&mut row)? {
                with(&row);
            }
            at = number + 1;
        }
        Ok(rows)
    }
}

/// Unread rows of an array.
pub struct NpzRows<'a> {
    entry: ZipFile<'a, BufReader<File>>,
    width: usize,
    left: usize,
    bytes: Vec<u8>,
}

impl NpzRows<'_> {
    /// Reads the next row. Returns false at the end.
    pub fn next(&mut self, row: &mut Vec<f64>) -> io::Result<bool> {
        if !self.pass()? {
            return Ok(false);
        }
        row.clear();
        row.extend(self.bytes.as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)));
        Ok(true)
    }

    /// Skips a row. Returns false at the end.
    pub fn pass(&mut self) -> io::Result<bool> {
        if self.left == 0 {
            return Ok(false);
        }
        self.left -= 1;
        self.entry.read_exact(&mut self.bytes)?;
        Ok(true)
    }

    /// Reads all remaining rows: the checksum covers the entire array.
    pub fn finish(mut self) -> io::Result<()> {
        io::copy(&mut self.entry, &mut io::sink()).map(|_| ())
    }
}

/// Reads the header of an array: its lengths, which must fit an entry of `size` bytes.
fn describe(entry: &mut impl Read, size: u64) -> io::Result<Vec<usize>> {
    let mut head = [0; 10];
    entry.read_exact(&mut head)?;
    if head[..8] != *b"\x93NUMPY\x01\x00" {
        return Err(damaged("it does not begin as an array does"));
    }
    let length = usize::from(u16::from_le_bytes([head[8], head[9]]));
    if length > LONGEST {
        return Err(damaged(format!("its description would have {length} bytes")));
    }
    let mut text = vec![0; length];
    entry.read_exact(&mut text)?;
    let shape = std::str::from_utf8(&text).ok().and_then(shape);
    let Some(shape) = shape.filter(|shape| (1..=2).contains(&shape.len())) else {
        return Err(damaged(
            "its description is none of doubles in one or two dimensions, row by row",
        ));
    };
    let product = |product: u64, n: &u64| product.checked_mul(*n);
    let bytes = shape.iter().try_fold(8, product);
    if bytes.and_then(|bytes| bytes.checked_add(10 + length as u64)) != Some(size) {
        return Err(damaged(format!(
            "its shape {shape:?} does not match its size of {size} bytes"
        )));
    }
    // lengths are at most the file's size, except in empty arrays, whose other length is meaningless
    let lengths = shape.iter().map(|&n| usize::try_from(n).ok().filter(|_| n <= size));
    let lengths: Option<Vec<usize>> = lengths.collect();
    lengths.ok_or_else(|| damaged("it is empty, but of an impossible length"))
}

/// Parses the lengths in `{'descr': '<f8', 'fortran_order': False, 'shape': (11, 3), }`.
fn shape(text: &str) -> Option<Vec<u64>> {
    let plain: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let has = |part: &str| plain.contains(part);
    if !has("'descr':'<f8'") || !has("'fortran_order':False") {
        return None;
    }
    let (_, rest) = plain.split_once("'shape':(")?;
    let (inside, _) = rest.split_once(')')?;
    let lengths = inside.trim_end_matches(',').split(',');
    lengths.map(|n| n.parse().ok()).collect()
}
