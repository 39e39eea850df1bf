//! Static condensation: eliminates unknowns that a row of two entries expresses by another unknown.
//!
//! `a x_e + c x_o = b_r` is solved for `x_e`, whose column is added to that of `x_o`. For a beam, velocities are eliminated by
//! `cj u - v = b`.

use super::Pattern;

/// Largest number of entries that a column may add to the column it is merged with.
const MORE: usize = 2;

/// An unknown that is eliminated by another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Elimination {
    /// Row of two entries.
    pub row: u32,
    /// Eliminated unknown, and the entry of its coefficient.
    pub given: (u32, u32),
    /// Remaining unknown, and the entry of its coefficient.
    pub kept: (u32, u32),
}

/// The condensed matrix.
pub(super) struct CondensedMatrix {
    pub pairs: Vec<Elimination>,
    /// Pair that eliminates each unknown.
    pub by: Vec<Option<u32>>,
    /// Row paired with each remaining unknown; unused for the others.
    pub row: Vec<u32>,
}

impl CondensedMatrix {
    /// Selects the pairs of a square pattern, among those that are `suitable`.
    pub fn new(pattern: &Pattern, suitable: impl Fn(&Elimination) -> bool) -> Self {
        let n = pattern.columns();
        let mut rows: Vec<[u32; 3]> = vec![[0, 0, 0]; n]; // count, first entries
        let mut columns: Vec<[u32; 2]> = vec![[0, 0]; n];
        for column in 0..n {
            for entry in pattern.column(column) {
                let row = pattern.rows[entry] as usize;
                let count = rows[row][0] as usize;
                if count < 2 {
                    rows[row][1 + count] = entry as u32;
                    columns[row][count] = column as u32;
                }
                rows[row][0] += 1;
            }
        }
        let mut this = Self {
            pairs: vec![],
            by: vec![None; n],
            row: (0..n as u32).collect(),
        };
        let mut anchor = vec![false; n];
        for row in 0..n {
            if rows[row][0] != 2 {
                continue;
            }
            let both = [(columns[row][0], rows[row][1]), (columns[row][1], rows[row][2])];
            if both.iter().all(|(unknown, _)| *unknown as usize != row) {
                continue;
            }
            let length = |unknown: u32| pattern.column(unknown as usize).len();
            let (given, kept) = if length(both[0].0) <= length(both[1].0) {
                (both[0], both[1])
            } else {
                (both[1], both[0])
            };
            let (e, o) = (given.0 as usize, kept.0 as usize);
            if anchor[e] || this.by[e].is_some() || this.by[o].is_some() || more(pattern, e, o, row) > MORE {
                continue;
            }
            let pair = Elimination {
                row: row as u32,
                given,
                kept,
            };
            if !suitable(&pair) {
                continue;
            }
            if row == o {
                // the row of the eliminated unknown remains and is paired with the other unknown
                if this.row[o] as usize != o {
                    continue;
                }
                this.row[o] = e as u32;
            }
            anchor[o] = true;
            this.by[e] = Some(this.pairs.len() as u32);
            this.pairs.push(pair);
        }
        this
    }

    /// Unknown with whose column the column of `unknown` is merged: itself if it remains.
    pub fn joins(&self, unknown: usize) -> usize {
        self.by[unknown].map_or(unknown, |pair| self.pairs[pair as usize].kept.0 as usize)
    }
}

/// Number of rows of column `e`, other than `row`, that column `o` does not contain.
fn more(pattern: &Pattern, e: usize, o: usize, row: usize) -> usize {
    let theirs = &pattern.rows[pattern.column(o)];
    let mine = pattern.rows[pattern.column(e)].iter();
    mine.filter(|r| **r as usize != row && theirs.binary_search(r).is_err())
        .count()
}
