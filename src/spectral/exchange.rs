//! Rows exchanged in pairs so that the diagonal is strong.

use nalgebra::Complex;

use crate::sparse::Pattern;

/// A pattern whose rows have been exchanged in pairs.
///
/// At shifts below most eigenvalues the rows `u' = v` and of momentum have their large entries in each other's columns.
/// KLU orders columns for pivots on the diagonal; with pivots elsewhere the modes of a beam with 3900 unknowns took 33 s
/// instead of 2.3 s. The measure `|aᵢⱼ aⱼᵢ| > |aᵢᵢ aⱼⱼ|` does not depend on how rows and columns are scaled.
pub(super) struct Exchanged {
    /// The pattern after the exchange.
    pub pattern: Pattern,
    /// Which entry of the old pattern each entry was.
    entries: Vec<usize>,
    /// Row that stands in the place of each; its own inverse.
    partner: Vec<usize>,
}

impl Exchanged {
    /// Exchanges what a matrix with these entries asks for.
    pub fn new(pattern: &Pattern, values: &[Complex<f64>]) -> Self {
        let n = pattern.columns();
        let at = |row: usize, column: usize| {
            let rows = &pattern.rows[pattern.column(column)];
            let found = rows.binary_search(&(row as i64)).ok();
            found.map_or(0.0, |k| values[pattern.starts[column] as usize + k].norm())
        };
        let mut partner: Vec<usize> = (0..n).collect();
        for i in 0..n {
            if partner[i] != i {
                continue;
            }
            let own = at(i, i);
            let mut best = (1.0, i);
            for entry in pattern.column(i) {
                let j = pattern.rows[entry] as usize;
                let across = values[entry].norm() * at(i, j);
                if j != i && partner[j] == j && across > best.0 * own * at(j, j) {
                    let kept = (own * at(j, j)).max(f64::MIN_POSITIVE);
                    best = (across / kept, j);
                }
            }
            (partner[i], partner[best.1]) = (best.1, i);
        }
        let mut exchanged = Self {
            pattern: Pattern {
                starts: pattern.starts.clone(),
                rows: Vec::with_capacity(pattern.entries()),
            },
            entries: Vec::with_capacity(pattern.entries()),
            partner,
        };
        for column in 0..n {
            let mut all: Vec<usize> = pattern.column(column).collect();
            let row = |entry: usize| exchanged.partner[pattern.rows[entry] as usize] as i64;
            all.sort_by_key(|&entry| row(entry));
            exchanged.pattern.rows.extend(all.iter().map(|&entry| row(entry)));
            exchanged.entries.extend(all);
        }
        exchanged
    }

    /// Entries in the order of the pattern after the exchange.
    pub fn values(&self, old: &[Complex<f64>], new: &mut Vec<Complex<f64>>) {
        new.clear();
        new.extend(self.entries.iter().map(|&entry| old[entry]));
    }

    /// Exchanges the entries of a right-hand side, or back.
    pub fn rows(&self, b: &mut [Complex<f64>]) {
        for (i, &j) in self.partner.iter().enumerate().filter(|(i, j)| i < *j) {
            b.swap(i, j);
        }
    }
}
