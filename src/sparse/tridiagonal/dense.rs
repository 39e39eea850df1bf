//! Products with small dense blocks, and their inverses, in the widest vectors of the processor.
//!
//! A block is stored in strips of at most [`STRIP`] rows, each by columns. The result of a strip stays in registers while memory is read
//! in order.

/// Number of rows of a strip.
pub(super) const STRIP: usize = 16;
/// Rows are padded to a multiple of this number.
pub(super) const LANES: usize = 4;

/// Ratio to the largest entry of the column above which the diagonal entry is the pivot.
const DIAGONAL: f64 = 0.1;

/// Number of rows padded to whole vectors.
pub(super) fn padded(rows: usize) -> usize {
    rows.next_multiple_of(LANES)
}

/// Rounding of a multiplication and addition `a b + c`.
pub(super) trait MultiplyAdd: Copy {
    fn add(a: f64, b: f64, c: f64) -> f64;
}

/// Rounds twice.
#[derive(Clone, Copy)]
pub(super) struct TwoRoundings;

/// Rounds once, in a single instruction.
#[derive(Clone, Copy)]
pub(super) struct OneRounding;

impl MultiplyAdd for TwoRoundings {
    #[inline(always)]
    fn add(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

impl MultiplyAdd for OneRounding {
    #[inline(always)]
    fn add(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

/// `y = M x`, or `y += M x`; M has `x.len()` columns and `y.len()` rows, a multiple of [`LANES`].
#[inline(always)]
pub(super) fn multiply<A: MultiplyAdd, const ADDS: bool>(mut m: &[f64], x: &[f64], y: &mut [f64]) {
    for strip in y.chunks_mut(STRIP) {
        let (own, rest) = m.split_at(strip.len() * x.len());
        m = rest;
        match strip.len() {
            16 => columns::<A, ADDS, 16>(own, x, strip),
            12 => columns::<A, ADDS, 12>(own, x, strip),
            8 => columns::<A, ADDS, 8>(own, x, strip),
            _ => columns::<A, ADDS, 4>(own, x, strip),
        }
    }
}

/// Sums even and odd columns separately: the two sums are independent.
#[inline(always)]
fn columns<A: MultiplyAdd, const ADDS: bool, const H: usize>(m: &[f64], x: &[f64], y: &mut [f64]) {
    let Some(y) = y.first_chunk_mut::<H>() else { return };
    let mut even = if ADDS { *y } else { [0.0; H] };
    let mut odd = [0.0; H];
    let (pairs, last) = m.as_chunks::<H>().0.as_chunks::<2>();
    let (xs, last_x) = x.as_chunks::<2>();
    for ([a, b], [x, z]) in pairs.iter().zip(xs) {
        for i in 0..H {
            even[i] = A::add(a[i], *x, even[i]);
            odd[i] = A::add(b[i], *z, odd[i]);
        }
    }
    if let ([a], [x]) = (last, last_x) {
        for i in 0..H {
            even[i] = A::add(a[i], *x, even[i]);
        }
    }
    for i in 0..H {
        y[i] = even[i] + odd[i];
    }
}

/// Converts a block stored by columns of `rows` entries to strips.
#[inline(always)]
pub(super) fn strips(d: &[f64], rows: usize, mut out: &mut [f64]) {
    for first in (0..rows).step_by(STRIP) {
        let height = STRIP.min(rows - first);
        let (own, rest) = out.split_at_mut(d.len() / rows * height);
        for (to, column) in own.chunks_exact_mut(height).zip(d.chunks_exact(rows)) {
            to.copy_from_slice(&column[first..][..height]);
        }
        out = rest;
    }
}

/// `C = -M B` of blocks stored by columns: columns of M have `rows` entries, a multiple of [`LANES`], columns of B
/// `inner`.
#[inline(always)]
pub(super) fn product<A: MultiplyAdd>(m: &[f64], rows: usize, b: &[f64], inner: usize, c: &mut [f64]) {
    for (c, b) in c.chunks_exact_mut(rows).zip(b.chunks_exact(inner)) {
        for (k, c) in c.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            let mut sum = [0.0; LANES];
            for (b, column) in b.iter().zip(m.chunks_exact(rows)) {
                for (sum, m) in sum.iter_mut().zip(&column[k * LANES..][..LANES]) {
                    *sum = A::add(-*m, *b, *sum);
                }
            }
            *c = sum;
        }
    }
}

/// Index of entry (row, column) in a block with the given numbers of padded rows and columns.
pub(super) fn place(row: usize, column: usize, rows: usize, columns: usize) -> usize {
    let first = row / STRIP * STRIP;
    first * columns + column * STRIP.min(rows - first) + row - first
}

/// Replaces the square block `d`, stored by columns of `rows` entries, by its inverse; returns false if a pivot is zero or not finite.
///
/// Gauss-Jordan elimination. The pivot is the diagonal entry unless it is below a tenth of the largest entry of its column, each relative
/// to its row. `exchanged` is work space with one number per column, `room` with three numbers per row.
#[inline(always)]
pub(super) fn invert<A: MultiplyAdd>(d: &mut [f64], rows: usize, exchanged: &mut [usize], room: &mut [f64]) -> bool {
    // loops of constant length need no counter
    match rows {
        4 => invert_by::<A>(d, 4, exchanged, room),
        8 => invert_by::<A>(d, 8, exchanged, room),
        12 => invert_by::<A>(d, 12, exchanged, room),
        16 => invert_by::<A>(d, 16, exchanged, room),
        20 => invert_by::<A>(d, 20, exchanged, room),
        _ => invert_by::<A>(d, rows, exchanged, room),
    }
}

#[inline(always)]
fn invert_by<A: MultiplyAdd>(d: &mut [f64], rows: usize, exchanged: &mut [usize], room: &mut [f64]) -> bool {
    let n = exchanged.len();
    let (per_size, rest) = room.split_at_mut(rows);
    let (pivots, keep) = rest.split_at_mut(rows);
    let keep = &mut keep[..rows];
    keep.fill(1.0);
    per_size.fill(0.0);
    for column in d.chunks_exact(rows) {
        for (size, entry) in per_size.iter_mut().zip(column) {
            *size = size.max(entry.abs());
        }
    }
    let inverse_of = |size: f64| if size > 0.0 { 1.0 / size } else { 0.0 };
    per_size.iter_mut().for_each(|size| *size = inverse_of(*size));
    for k in 0..n {
        // rows that have already been pivots are ignored
        let column = &d[k * rows..][..rows];
        let mut most = [0.0; LANES];
        for (column, per) in column
            .as_chunks::<LANES>()
            .0
            .iter()
            .zip(per_size.as_chunks::<LANES>().0)
        {
            for i in 0..LANES {
                let relative = column[i].abs() * per[i];
                most[i] = if relative > most[i] { relative } else { most[i] };
            }
        }
        let most = most.into_iter().fold(0.0, f64::max);
        let enough = |row: usize, least: f64| column[row].abs() * per_size[row] >= least;
        let p = if enough(k, DIAGONAL * most) {
            k
        } else {
            (k..n).find(|row| enough(*row, most)).unwrap_or(k)
        };
        exchanged[k] = p;
        if p != k {
            for column in d.chunks_exact_mut(rows) {
                column.swap(k, p);
            }
            per_size.swap(k, p);
        }
        let inverse = 1.0 / d[k * rows + k];
        if !(most > 0.0 && inverse.is_finite()) {
            return false;
        }
        per_size[k] = 0.0;
        // writes whole vectors: the next load would have to wait for a single entry
        for (to, pivot) in pivots.iter_mut().zip(&d[k * rows..][..rows]) {
            *to = -pivot;
        }
        (pivots[k], keep[k]) = (1.0, 0.0);
        let clear = |columns: &mut [f64]| {
            for column in columns.chunks_exact_mut(rows) {
                let factor = column[k] * inverse;
                for ((entry, pivot), keep) in column.iter_mut().zip(&*pivots).zip(&*keep) {
                    *entry = A::add(factor, *pivot, *entry * keep);
                }
            }
        };
        let (left, right) = d.split_at_mut(k * rows);
        let (own, right) = right.split_at_mut(rows);
        clear(left);
        clear(right);
        for (entry, pivot) in own.iter_mut().zip(&*pivots) {
            *entry = pivot * inverse;
        }
        keep[k] = 1.0;
    }
    for k in (0..n).rev() {
        let p = exchanged[k];
        if p != k {
            let (left, right) = d.split_at_mut(p * rows);
            left[k * rows..][..rows].swap_with_slice(&mut right[..rows]);
        }
    }
    true
}
