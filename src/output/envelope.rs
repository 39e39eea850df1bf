//! Reads a history of any length in one pass into bounded memory: least and largest value of each column in a limited number of stretches
//! of time.

use std::fs::File;
use std::io;
use std::path::Path;

use super::folder::{ENVELOPE, HISTORY, fault, open};
use crate::error::Result;

/// Least and largest value of a stretch, each with its time.
#[derive(Clone, Copy, Debug)]
struct Extremes {
    least: (f64, f64),
    largest: (f64, f64),
}

impl Extremes {
    fn new(t: f64, y: f64) -> Self {
        Self {
            least: (t, y),
            largest: (t, y),
        }
    }

    /// Joins two stretches; NaN loses against any number.
    fn join(mut self, other: Self) -> Self {
        if self.least.1.is_nan() || other.least.1 < self.least.1 {
            self.least = other.least;
        }
        if self.largest.1.is_nan() || other.largest.1 > self.largest.1 {
            self.largest = other.largest;
        }
        self
    }

    /// Both values in the order of their times.
    fn in_order(self) -> [(f64, f64); 2] {
        match self.least.0 <= self.largest.0 {
            true => [self.least, self.largest],
            false => [self.largest, self.least],
        }
    }
}

/// Columns of a history, thinned so that their curves look like those of the full history.
#[derive(Clone, Debug, Default)]
pub struct Envelope {
    names: Vec<(String, String)>,
    /// Row-major: one row per stretch, one entry per column.
    stretches: Vec<Extremes>,
    most: usize,
    rows_a_stretch: usize,
    rows_in_last: usize,
}

impl Envelope {
    /// An empty envelope; it keeps at most `most` stretches.
    pub fn new(most: usize) -> Self {
        Self {
            most: most.max(2),
            rows_a_stretch: 1,
            ..Self::default()
        }
    }

    /// Reads a history. If not all of it was written, the envelope file replaces it before the window. Skips an incomplete last line of a
    /// killed run.
    pub fn read(history: HistorySource, most: usize) -> Result<Self> {
        let mut envelope = Self::new(most);
        each_row(history, |names, origin, row| envelope.add(names, origin, row))?;
        Ok(envelope)
    }

    /// Adds a row of these columns, of which the first is time; skips a covered row.
    pub fn add(&mut self, names: &Names, origin: RowOrigin, row: &[f64]) {
        if self.names.is_empty() {
            self.names = names.to_vec();
        }
        if origin != RowOrigin::Covered {
            self.push(row);
        }
    }

    fn push(&mut self, row: &[f64]) {
        let columns = self.names.len();
        let new = row.iter().map(|&y| Extremes::new(row[0], y));
        if self.rows_in_last == 0 || self.rows_in_last == self.rows_a_stretch {
            if self.stretches.len() == self.most * columns {
                self.halve();
            }
            if self.rows_in_last == 0 || self.rows_in_last == self.rows_a_stretch {
                self.stretches.extend(new);
                self.rows_in_last = 1;
                return;
            }
        }
        let start = self.stretches.len() - columns;
        for (kept, new) in self.stretches[start..].iter_mut().zip(new) {
            *kept = kept.join(new);
        }
        self.rows_in_last += 1;
    }

    /// Joins stretches in pairs.
    fn halve(&mut self) {
        let columns = self.names.len();
        let count = self.stretches.len() / columns;
        for pair in 0..count / 2 {
            for c in 0..columns {
                let (a, b) = (2 * pair * columns + c, (2 * pair + 1) * columns + c);
                self.stretches[pair * columns + c] = self.stretches[a].join(self.stretches[b]);
            }
        }
        if count % 2 == 1 {
            let (from, to) = ((count - 1) * columns, count / 2 * columns);
            self.stretches.copy_within(from..from + columns, to);
        } else {
            // A joined last pair is full. A single last stretch (odd count) is half full and grows further.
            self.rows_in_last *= 2;
        }
        self.stretches.truncate(count.div_ceil(2) * columns);
        self.rows_a_stretch *= 2;
    }

    /// Names and units of the columns.
    pub fn names(&self) -> &[(String, String)] {
        &self.names
    }

    /// Times and values of a column; the extremes of a stretch are in the order of their times.
    pub fn points(&self, column: usize) -> Vec<(f64, f64)> {
        let mut points = Vec::new();
        for e in self.stretches.iter().skip(column).step_by(self.names.len().max(1)) {
            let [first, second] = e.in_order();
            points.push(first);
            if second.0 > first.0 {
                points.push(second);
            }
        }
        points
    }

    /// All columns over common times, time first. A stretch of several rows gives two values: its end times, and in each column the least
    /// and largest value in the order of their times.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        let width = self.names.len();
        let mut columns = vec![Vec::new(); width];
        for stretch in self.stretches.chunks_exact(width.max(1)) {
            let time = stretch[0];
            let single = time.largest.1 <= time.least.1;
            for (column, e) in columns.iter_mut().zip(stretch) {
                let [first, second] = e.in_order();
                column.push(first.1);
                if !single {
                    column.push(second.1);
                }
            }
        }
        columns
    }
}

/// Origin of a row of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowOrigin {
    /// A drawn row of the history.
    History,
    /// A row of the history before the window; the envelope is more complete there.
    Covered,
    /// A row of the envelope.
    Rest,
}

/// Names and units of the columns of a history.
pub type Names = [(String, String)];

/// Largest number of values of a history kept in memory.
const KEPT: usize = 1 << 19;

/// A history short enough to stay in memory while it is written. It need not be read back.
#[derive(Debug)]
pub struct HistoryInMemory {
    names: Vec<(String, String)>,
    numbers: Vec<f64>,
}

impl HistoryInMemory {
    /// Creates an empty history with these headings.
    pub fn new(headings: &[String]) -> Self {
        Self {
            names: headings.iter().map(|heading| split_name(heading)).collect(),
            numbers: vec![],
        }
    }

    /// Adds a row with one number per column. Returns true if the history is still short enough.
    pub fn push(&mut self, row: &[f64]) -> bool {
        // text does not store sign and payload of NaN
        let as_read = row.iter().map(|&x| if x.is_nan() { f64::NAN } else { x });
        self.numbers.extend(as_read);
        self.numbers.len() < KEPT
    }
}

/// Location of a history.
#[derive(Clone, Copy, Debug)]
pub enum HistorySource<'a> {
    /// Tables in a folder.
    Folder(&'a Path),
    /// Memory, with the complete history.
    Memory(&'a HistoryInMemory),
}

impl<'a> HistorySource<'a> {
    /// History of a run that has just ended in a folder.
    pub fn new(dir: &'a Path, kept: Option<&'a HistoryInMemory>) -> Self {
        kept.map_or(Self::Folder(dir), Self::Memory)
    }
}

/// Passes all rows of a history to `take`, with the names of their columns. Rows of the envelope precede: least values at the start of a
/// stretch, greatest values at its end. Then follow all rows of the history, including those that the envelope covers.
pub fn each_row(history: HistorySource, mut take: impl FnMut(&Names, RowOrigin, &[f64])) -> Result<()> {
    let dir = match history {
        HistorySource::Folder(dir) => dir,
        HistorySource::Memory(HistoryInMemory { names, numbers }) => {
            let rows = numbers.chunks_exact(names.len().max(1));
            rows.for_each(|row| take(names, RowOrigin::History, row));
            return Ok(());
        }
    };
    let path = dir.join(HISTORY);
    let (names, mut rows) = table(&path)?;
    let covered = dir.join(ENVELOPE);
    let mut until = f64::NEG_INFINITY;
    if covered.is_file() {
        let (own, mut stretches) = table(&covered)?;
        let mut both = [vec![], vec![]];
        while let Some(row) = stretches.next()? {
            if own.len() != 3 * names.len() || row.len() != own.len() || row[1] < row[0] || row[0] < until {
                continue;
            }
            until = row[1];
            for (k, values) in both.iter_mut().enumerate() {
                values.clear();
                values.push(row[k]);
                values.extend(row[3..].chunks_exact(3).map(|of| of[k]));
            }
            take(&names, RowOrigin::Rest, &both[0]);
            if row[1] > row[0] {
                take(&names, RowOrigin::Rest, &both[1]);
            }
        }
    }
    while let Some(row) = rows.next()? {
        if row.len() == names.len() && !row.is_empty() {
            let source = if row[0] <= until {
                RowOrigin::Covered
            } else {
                RowOrigin::History
            };
            take(&names, source, row);
        }
    }
    Ok(())
}

/// Rows of a table of numbers. A row ends before its first cell that is not a number.
pub(super) struct TableRows<'a> {
    path: &'a Path,
    reader: csv::Reader<File>,
    record: csv::StringRecord,
    row: Vec<f64>,
}

impl TableRows<'_> {
    pub(super) fn next(&mut self) -> Result<Option<&[f64]>> {
        let read = self.reader.read_record(&mut self.record);
        if !read.map_err(|e| fault("read", self.path, io::Error::from(e)))? {
            return Ok(None);
        }
        self.row.clear();
        let numbers = self.record.iter().map_while(|x| x.trim().parse::<f64>().ok());
        self.row.extend(numbers);
        Ok(Some(&self.row))
    }
}

/// Names and units of the columns of a table, and its rows.
pub(super) fn table(path: &Path) -> Result<(Vec<(String, String)>, TableRows<'_>)> {
    let failed = |e: csv::Error| fault("read", path, io::Error::from(e));
    let file = open(path).map_err(|e| fault("read", path, e))?;
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(file);
    let names = reader.headers().map_err(failed)?.iter().map(split_name).collect();
    let rows = TableRows {
        path,
        reader,
        record: csv::StringRecord::new(),
        row: vec![],
    };
    Ok((names, rows))
}

/// Splits `tip_u1 [m]` into name and unit.
fn split_name(heading: &str) -> (String, String) {
    match heading.trim().strip_suffix(']').and_then(|h| h.rsplit_once(" [")) {
        Some((name, unit)) => (name.to_string(), unit.to_string()),
        None => (heading.trim().to_string(), "1".to_string()),
    }
}
