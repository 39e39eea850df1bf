//! A history of any length, read back in one pass into bounded memory: least and largest value of each column in each
//! of at most so many stretches of time.

use std::io;
use std::path::Path;

use super::folder::{fault, open};
use crate::error::Result;

/// Least and largest value of a stretch, each with its time.
#[derive(Clone, Copy, Debug)]
struct Extremes {
    least: (f64, f64),
    largest: (f64, f64),
}

impl Extremes {
    fn of(t: f64, y: f64) -> Self {
        Self {
            least: (t, y),
            largest: (t, y),
        }
    }

    /// Both stretches as one; what is not a number loses against a number.
    fn join(self, other: Self) -> Self {
        let beats = |a: f64, b: f64, less: bool| b.is_nan() || if less { a < b } else { a > b };
        let least = if beats(other.least.1, self.least.1, true) {
            other.least
        } else {
            self.least
        };
        let largest = if beats(other.largest.1, self.largest.1, false) {
            other.largest
        } else {
            self.largest
        };
        Self { least, largest }
    }
}

/// Columns of a history, thinned so that curves drawn from them look like the whole.
#[derive(Clone, Debug, Default)]
pub struct Envelope {
    names: Vec<(String, String)>,
    /// Row-major: one entry a column and stretch.
    stretches: Vec<Extremes>,
    most: usize,
    rows_a_stretch: usize,
    rows_in_last: usize,
}

impl Envelope {
    /// For columns of given names and units; keeps at most `most` stretches.
    pub fn new(names: Vec<(String, String)>, most: usize) -> Self {
        Self {
            names,
            stretches: Vec::new(),
            most: most.max(2),
            rows_a_stretch: 1,
            rows_in_last: 0,
        }
    }

    /// Reads `history.csv`. A last line cut short, as a killed run leaves it, is passed over.
    pub fn read(path: &Path, most: usize) -> Result<Self> {
        let failed = |e: csv::Error| fault("read", path, io::Error::from(e));
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_reader(open(path).map_err(|e| fault("read", path, e))?);
        let names = reader.headers().map_err(failed)?.iter().map(split_name).collect();
        let mut envelope = Self::new(names, most);
        let mut record = csv::StringRecord::new();
        let mut row = Vec::new();
        while reader.read_record(&mut record).map_err(failed)? {
            row.clear();
            row.extend(record.iter().map_while(|x| x.trim().parse::<f64>().ok()));
            if row.len() == envelope.names.len() {
                envelope.push(&row);
            }
        }
        Ok(envelope)
    }

    /// Adds a row; the first column is time.
    pub fn push(&mut self, row: &[f64]) {
        let columns = self.names.len();
        let new = row.iter().map(|&y| Extremes::of(row[0], y));
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
            // The last pair is full; a single last stretch is half full and goes on growing.
            self.rows_in_last *= 2;
        }
        self.stretches.truncate(count.div_ceil(2) * columns);
        self.rows_a_stretch *= 2;
    }

    /// Names and units of the columns.
    pub fn names(&self) -> &[(String, String)] {
        &self.names
    }

    /// Times and values of a column, extremes in the order in which they occurred.
    pub fn points(&self, column: usize) -> Vec<(f64, f64)> {
        let mut points = Vec::new();
        for e in self.stretches.iter().skip(column).step_by(self.names.len().max(1)) {
            let (first, second) = if e.least.0 <= e.largest.0 {
                (e.least, e.largest)
            } else {
                (e.largest, e.least)
            };
            points.push(first);
            if second.0 > first.0 {
                points.push(second);
            }
        }
        points
    }

    /// All columns over common times, time first: of a stretch of several rows its ends, with least and largest value in the
    /// order in which they occurred.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        let width = self.names.len();
        let mut columns = vec![Vec::new(); width];
        for stretch in self.stretches.chunks_exact(width.max(1)) {
            let time = stretch[0];
            let single = time.largest.1 <= time.least.1;
            for (column, e) in columns.iter_mut().zip(stretch) {
                let (first, second) = if e.least.0 <= e.largest.0 {
                    (e.least, e.largest)
                } else {
                    (e.largest, e.least)
                };
                column.push(first.1);
                if !single {
                    column.push(second.1);
                }
            }
        }
        columns
    }
}

/// `tip_u1 [m]` into name and unit.
fn split_name(heading: &str) -> (String, String) {
    match heading.trim().strip_suffix(']').and_then(|h| h.rsplit_once(" [")) {
        Some((name, unit)) => (name.to_string(), unit.to_string()),
        None => (heading.trim().to_string(), "1".to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_extreme_is_lost_and_memory_is_bounded() {
        let names = vec![("t".to_string(), "s".to_string()), ("y".to_string(), "m".to_string())];
        let mut envelope = Envelope::new(names, 101);
        for k in 0..12_345 {
            let y = if k == 7_777 { 5.0 } else { (f64::from(k) * 0.7).sin() };
            envelope.push(&[f64::from(k), y]);
        }
        let points = envelope.points(1);
        assert!(points.len() <= 202, "{}", points.len());
        assert!(points.contains(&(7777.0, 5.0)));
        assert!(points.windows(2).all(|w| w[0].0 < w[1].0), "in order of time");
        assert_eq!(envelope.points(0).last(), Some(&(12_344.0, 12_344.0)));
        let columns = envelope.columns();
        assert!(columns[0].len() <= 202 && columns[0].len() == columns[1].len());
        assert!(columns[0].windows(2).all(|w| w[0] < w[1]), "in order of time");
        assert!(columns[1].contains(&5.0));
    }

    #[test]
    fn a_short_history_is_kept_as_it_is() {
        let names = vec![("t".to_string(), "s".to_string()), ("y".to_string(), "m".to_string())];
        let mut envelope = Envelope::new(names, 100);
        envelope.push(&[0.0, 1.0]);
        envelope.push(&[1.0, f64::NAN]);
        envelope.push(&[2.0, 1.0]);
        let points = envelope.points(1);
        assert_eq!(points.len(), 3);
        assert!(points[1].1.is_nan());
    }
}
