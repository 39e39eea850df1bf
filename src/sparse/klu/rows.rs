//! KLU's factors stored by rows, for many solutions with the same factors.
//!
//! KLU stores columns: each product of a solution is added to memory, and the next one must wait for it. By rows, the sum stays in a
//! register. With 32-bit indices and inverse pivots, a solution needs half of KLU's time.

use std::slice::from_raw_parts;

use crate::sparse::{c, groups::groups};

/// `R⁻¹ P A Q = L U + F`: factors of each diagonal block, and the entries F above the blocks.
pub(super) struct Rows {
    /// First row of each block, and the number of rows.
    blocks: Vec<usize>,
    above: Triangle,
    lower: Triangle,
    upper: Triangle,
    per_pivot: Vec<f64>,
    /// Inverses of the scale factors of rows.
    per_row: Vec<f64>,
    /// Equation of each row, unknown of each column.
    equation: Vec<u32>,
    unknown: Vec<u32>,
    x: Vec<f64>,
}

/// Entry of KLU's factors: row, column, index of its value in KLU's storage.
type Entry = [u32; 3];

/// Rows of a triangle without its diagonal.
struct Triangle {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Index of each value in KLU's storage.
    places: Vec<u32>,
}

impl Triangle {
    /// Creates the rows; each row keeps the given order of its entries.
    fn new(n: usize, entries: &[Entry]) -> Self {
        let by_row = entries.iter().map(|&[row, column, place]| (row, (column, place)));
        let (rows, starts) = groups(n, by_row);
        let (columns, places) = rows.into_iter().unzip();
        Self {
            values: vec![0.0; entries.len()],
            starts,
            columns,
            places,
        }
    }

    /// Reads the values of some rows again.
    ///
    /// # Safety
    /// `numbers` points to the storage that the entries' `places` refer to.
    unsafe fn take(&mut self, rows: std::ops::Range<usize>, numbers: *const f64) {
        let entries = self.starts[rows.start]..self.starts[rows.end];
        for (value, &place) in self.values[entries.clone()].iter_mut().zip(&self.places[entries]) {
            // SAFETY: guaranteed by the caller.
            *value = unsafe { *numbers.add(place as usize) };
        }
    }

    /// `start - Σ value x` of row k, as two independent sums.
    ///
    /// # Safety
    /// k is a row, and `x` has an element for each row.
    #[inline(always)]
    unsafe fn eliminate(&self, k: usize, start: f64, x: &[f64]) -> f64 {
        // SAFETY: a row's entries lie between its start and the next, and their columns are below the number of rows.
        unsafe {
            let product =
                |p: usize| self.values.get_unchecked(p) * x.get_unchecked(*self.columns.get_unchecked(p) as usize);
            let (mut p, end) = (*self.starts.get_unchecked(k), *self.starts.get_unchecked(k + 1));
            let mut sums = [start, 0.0];
            while p + 1 < end {
                sums[0] -= product(p);
                sums[1] -= product(p + 1);
                p += 2;
            }
            if p < end {
                sums[0] -= product(p);
            }
            sums[0] + sums[1]
        }
    }
}

impl Rows {
    /// Converts KLU's factors to rows; none if an index exceeds 32 bits.
    ///
    /// # Safety
    /// KLU has created both, for the same matrix.
    pub unsafe fn new(symbolic: &c::klu_l_symbolic, numeric: &c::klu_l_numeric) -> Option<Self> {
        let n = usize::try_from(symbolic.n).ok()?;
        // SAFETY: KLU stores a start for each block and the end of all, permutations of n, and n + 1 starts of columns of F.
        let (blocks, equation, unknown, off) = unsafe {
            (
                from_raw_parts(symbolic.R, symbolic.nblocks as usize + 1),
                from_raw_parts(numeric.Pnum, n),
                from_raw_parts(symbolic.Q, n),
                from_raw_parts(numeric.Offp, n + 1),
            )
        };
        let narrow = |wide: &[i64]| wide.iter().map(|&k| u32::try_from(k).ok()).collect::<Option<Vec<_>>>();
        let blocks: Vec<usize> = blocks.iter().map(|&k| k as usize).collect();
        let (mut above, mut lower, mut upper): (Vec<Entry>, Vec<Entry>, Vec<Entry>) = (vec![], vec![], vec![]);
        for (block, ends) in blocks.windows(2).enumerate() {
            for k in ends[0]..ends[1] {
                let add = |to: &mut Vec<Entry>, first: usize, place: usize, rows: &[i64]| {
                    for (p, row) in rows.iter().enumerate() {
                        to.push([
                            u32::try_from(first + *row as usize).ok()?,
                            k as u32,
                            u32::try_from(place + p).ok()?,
                        ]);
                    }
                    Some(())
                };
                let place = off[k] as usize;
                // SAFETY: the rows of F's columns are contiguous.
                let rows = unsafe { from_raw_parts(numeric.Offi.add(place), off[k + 1] as usize - place) };
                add(&mut above, 0, place, rows)?;
                if ends[1] - ends[0] == 1 {
                    continue;
                }
                for (to, starts, lengths) in [
                    (&mut lower, numeric.Lip, numeric.Llen),
                    (&mut upper, numeric.Uip, numeric.Ulen),
                ] {
                    // SAFETY: in the pool of a block of several rows a column consists of its row indices, counted from the block's first
                    // row,
                    // and then of as many values, in units of 8 bytes.
                    let (place, rows) = unsafe {
                        let (start, length) = (*starts.add(k) as usize, *lengths.add(k) as usize);
                        let pool = Self::pool(numeric, block);
                        (start + length, from_raw_parts(pool.add(start).cast::<i64>(), length))
                    };
                    add(to, ends[0], place, rows)?;
                }
            }
        }
        // descending columns: back substitution then reads the most recently computed unknown last
        upper.reverse();
        Some(Self {
            above: Triangle::new(n, &above),
            lower: Triangle::new(n, &lower),
            upper: Triangle::new(n, &upper),
            per_pivot: vec![0.0; n],
            per_row: vec![1.0; n],
            equation: narrow(equation)?,
            unknown: narrow(unknown)?,
            x: vec![0.0; n],
            blocks,
        })
    }

    /// Number of bytes that one solution reads.
    pub fn bytes(&self) -> usize {
        let triangles = [&self.above, &self.lower, &self.upper];
        let entries: usize = triangles
            .iter()
            .map(|triangle| 12 * triangle.values.len() + 8 * triangle.starts.len())
            .sum();
        entries + 24 * self.per_pivot.len()
    }

    /// Values of the factors of a block.
    ///
    /// # Safety
    /// The block exists.
    unsafe fn pool(numeric: &c::klu_l_numeric, block: usize) -> *const f64 {
        // SAFETY: KLU stores a pointer for each block.
        unsafe { (*numeric.LUbx.add(block)).cast() }
    }

    /// Reads all values again.
    ///
    /// # Safety
    /// KLU has created the factors with the pivots of the factors passed to [`Rows::new`].
    pub unsafe fn take(&mut self, numeric: &c::klu_l_numeric) {
        let n = self.x.len();
        // SAFETY: pivots, row scales, F and pools are KLU's, of this matrix; row scales exist if rows are scaled.
        unsafe {
            for (per, pivot) in self
                .per_pivot
                .iter_mut()
                .zip(from_raw_parts(numeric.Udiag.cast::<f64>(), n))
            {
                *per = 1.0 / pivot;
            }
            if !numeric.Rs.is_null() {
                for (per, size) in self.per_row.iter_mut().zip(from_raw_parts(numeric.Rs, n)) {
                    *per = 1.0 / size;
                }
            }
            self.above.take(0..n, numeric.Offx.cast());
            for (block, ends) in self.blocks.windows(2).enumerate() {
                let pool = Self::pool(numeric, block);
                self.lower.take(ends[0]..ends[1], pool);
                self.upper.take(ends[0]..ends[1], pool);
            }
        }
    }

    /// Replaces `b` by the solution of `A x = b`. Panics if `b` has a wrong length.
    pub fn solve(&mut self, b: &mut [f64]) {
        let x = &mut self.x;
        assert_eq!(b.len(), x.len(), "right-hand side of another size");
        for ((x, per), &equation) in x.iter_mut().zip(&self.per_row).zip(&self.equation) {
            // SAFETY: equations are below n, the length of b.
            *x = per * unsafe { b.get_unchecked(equation as usize) };
        }
        let several = !self.above.values.is_empty();
        for ends in self.blocks.windows(2).rev() {
            // SAFETY: rows of blocks are below n, the length of x and of the inverses.
            unsafe {
                for k in (ends[0]..ends[1]).filter(|_| several) {
                    *x.get_unchecked_mut(k) = self.above.eliminate(k, *x.get_unchecked(k), x);
                }
                for k in ends[0]..ends[1] {
                    *x.get_unchecked_mut(k) = self.lower.eliminate(k, *x.get_unchecked(k), x);
                }
                for k in (ends[0]..ends[1]).rev() {
                    let left = self.upper.eliminate(k, *x.get_unchecked(k), x);
                    *x.get_unchecked_mut(k) = left * self.per_pivot.get_unchecked(k);
                }
            }
        }
        for (x, &unknown) in x.iter().zip(&self.unknown) {
            // SAFETY: unknowns are below n, the length of b.
            unsafe { *b.get_unchecked_mut(unknown as usize) = *x };
        }
    }
}
