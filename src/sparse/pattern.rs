//! Pattern of a sparse matrix in compressed columns.

/// Positions of stored entries, column by column: rows of column j are `rows[starts[j]..starts[j + 1]]`, ascending.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    /// Start of each column in `rows`; length `n + 1`.
    pub starts: Vec<i64>,
    /// Row of each entry, ascending within a column.
    pub rows: Vec<i64>,
}

impl Pattern {
    /// Pattern from the rows of each column, in any order.
    pub fn from_columns(columns: &[Vec<usize>]) -> Self {
        let mut starts = vec![0];
        let mut rows = Vec::new();
        for column in columns {
            let mut sorted: Vec<i64> = column.iter().map(|&r| r as i64).collect();
            sorted.sort_unstable();
            sorted.dedup();
            rows.extend(sorted);
            starts.push(rows.len() as i64);
        }
        Self { starts, rows }
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// Range of the entries of a column.
    pub fn column(&self, j: usize) -> std::ops::Range<usize> {
        self.starts[j] as usize..self.starts[j + 1] as usize
    }
}
