//! Factors of complex matrices in dense blocks along a line.

use nalgebra::Complex;

use crate::sparse::lu::DENSE;
use crate::sparse::{BlockTridiagonal, Pattern};

/// LU factors of complex matrices with a common pattern, as those of real ones in which each entry `z` is the block
///
/// ```text
/// Re z  -Im z
/// Im z   Re z
/// ```
///
/// The factors of a beam cost in proportion to its length, while KLU's ordering fills the rows that are exchanged for large pivots.
pub struct EmbeddedFactors {
    pattern: Pattern,
    blocks: BlockTridiagonal,
    values: Vec<f64>,
    solution: Vec<f64>,
}

impl EmbeddedFactors {
    /// Analyzes a square pattern; `None` if dense blocks would be more expensive than sparse factors.
    pub fn new(pattern: &Pattern) -> Option<Self> {
        let mut starts = vec![0];
        let mut rows = Vec::with_capacity(4 * pattern.entries());
        for column in 0..pattern.columns() {
            for _ in 0..2 {
                let own = pattern.rows[pattern.column(column)].iter();
                rows.extend(own.flat_map(|row| [2 * row, 2 * row + 1]));
                starts.push(rows.len() as i64);
            }
        }
        let embedded = Pattern { starts, rows };
        Some(Self {
            blocks: BlockTridiagonal::new(&embedded, DENSE * embedded.entries())?,
            values: Vec::with_capacity(embedded.entries()),
            solution: Vec::with_capacity(embedded.columns()),
            pattern: embedded,
        })
    }

    /// Factors the matrix with the entries `values`, in the order of the pattern; returns false if rows would have to be exchanged between
    /// blocks.
    pub fn factor(&mut self, pattern: &Pattern, values: &[Complex<f64>]) -> bool {
        self.values.clear();
        for column in 0..pattern.columns() {
            let own = &values[pattern.column(column)];
            self.values.extend(own.iter().flat_map(|z| [z.re, z.im]));
            self.values.extend(own.iter().flat_map(|z| [-z.im, z.re]));
        }
        self.blocks.factor(&self.pattern, &self.values)
    }

    /// Replaces `b` by the solution of `A x = b`.
    pub fn solve(&mut self, b: &mut [Complex<f64>]) {
        self.solution.clear();
        self.solution.extend(b.iter().flat_map(|z| [z.re, z.im]));
        self.blocks.solve(&mut self.solution);
        let parts = self.solution.chunks_exact(2);
        b.iter_mut().zip(parts).for_each(|(z, x)| *z = Complex::new(x[0], x[1]));
    }
}
