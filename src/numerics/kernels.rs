//! Loops over vectors, written for vectorization by the compiler, with a fixed order of summation.
//!
//! Debian builds SUNDIALS without optimization; with these kernels, the time of a run falls to about 1/2.7.

use super::threads::{LARGE, both};
use super::wide;

/// Entries that a sum of vectors processes at a time: the output stays in the first-level cache while vectors are
/// added.
pub const TILE: usize = 512;

/// Split position for two threads: half the length, rounded up to whole tiles.
pub fn halfway(len: usize) -> usize {
    (len / 2).next_multiple_of(TILE).min(len)
}

/// `out = Σ factorₖ vₖ`, terms added in their order. Panics if vector lengths differ.
pub fn combine(out: &mut [f64], terms: &[(f64, &[f64])]) {
    for (_, v) in terms {
        assert_eq!(v.len(), out.len(), "a vector of another system");
    }
    halves(out, |first, part| wide!(combine_tiles(first, part, terms)));
}

/// Applies a loop to all entries, in two threads for large vectors. `each` receives the index of its first entry.
fn halves(out: &mut [f64], each: impl Fn(usize, &mut [f64]) + Sync) {
    if out.len() < LARGE {
        return each(0, out);
    }
    let half = halfway(out.len());
    let (left, right) = out.split_at_mut(half);
    both(|| each(0, left), || each(half, right));
}

/// Sums one section of the vectors, from entry `first`.
#[inline(always)]
fn combine_tiles(first: usize, out: &mut [f64], terms: &[(f64, &[f64])]) {
    for (k, tile) in out.chunks_mut(TILE).enumerate() {
        let begin = first + k * TILE;
        let place = begin..begin + tile.len();
        let Some(((factor, v), rest)) = terms.split_first() else {
            tile.fill(0.0);
            continue;
        };
        for (out, v) in tile.iter_mut().zip(&v[place.clone()]) {
            *out = factor * v;
        }
        // two vectors per pass halve the reads of the output
        let (pairs, last) = rest.as_chunks::<2>();
        for [(f, v), (g, w)] in pairs {
            for ((out, v), w) in tile.iter_mut().zip(&v[place.clone()]).zip(&w[place.clone()]) {
                *out = (*out + f * v) + g * w;
            }
        }
        for (factor, v) in last {
            for (out, v) in tile.iter_mut().zip(&v[place.clone()]) {
                *out += factor * v;
            }
        }
    }
}

/// `outᵢ = xᵢ yᵢ` for vectors of equal length.
pub fn products(x: &[f64], y: &[f64], out: &mut [f64]) {
    halves(out, |first, out| {
        wide!({
            for ((out, x), y) in out.iter_mut().zip(&x[first..]).zip(&y[first..]) {
                *out = x * y;
            }
        });
    });
}

/// `xᵢ ← xᵢ yᵢ` for vectors of equal length.
pub fn multiply(x: &mut [f64], y: &[f64]) {
    halves(x, |first, x| {
        wide!(x.iter_mut().zip(&y[first..]).for_each(|(x, y)| *x *= y));
    });
}

/// Number of interleaved partial sums: two registers of four doubles, or four of two.
const LANES: usize = 8;

/// `Σ term(xᵢ, yᵢ)`, in [`LANES`] interleaved partial sums.
#[inline(always)]
fn sum(x: &[f64], y: &[f64], term: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    let (xs, ys) = (x.chunks_exact(LANES), y.chunks_exact(LANES));
    for (i, (&a, &b)) in xs.remainder().iter().zip(ys.remainder()).enumerate() {
        sums[i] = term(a, b);
    }
    for (a, b) in xs.zip(ys) {
        for lane in 0..LANES {
            sums[lane] += term(a[lane], b[lane]);
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// `Σ xᵢ yᵢ`.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    wide!(sum(x, y, |a, b| a * b))
}

/// `Σ |xᵢ|`.
pub fn sum_abs(x: &[f64]) -> f64 {
    wide!(sum(x, x, |a, _| a.abs()))
}

/// `Σ (xᵢ wᵢ)²`.
pub fn weighted_square(x: &[f64], w: &[f64]) -> f64 {
    wide!(sum(x, w, |a, b| (a * b) * (a * b)))
}

/// `Σ (xᵢ wᵢ)²` over the entries with `idᵢ > 0`.
pub fn weighted_square_masked(x: &[f64], w: &[f64], id: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (xs, ws, ids) = (x.chunks_exact(LANES), w.chunks_exact(LANES), id.chunks_exact(LANES));
    let term = |a: f64, b: f64, keep: f64| if keep > 0.0 { (a * b) * (a * b) } else { 0.0 };
    for (i, ((&a, &b), &keep)) in xs
        .remainder()
        .iter()
        .zip(ws.remainder())
        .zip(ids.remainder())
        .enumerate()
    {
        sums[i] = term(a, b, keep);
    }
    for ((a, b), keep) in xs.zip(ws).zip(ids) {
        for lane in 0..LANES {
            sums[lane] += term(a[lane], b[lane], keep[lane]);
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Largest of `value(xᵢ)`, at least `floor`; ignores NaN, as in C.
#[inline(always)]
fn largest(x: &[f64], floor: f64, value: impl Fn(f64) -> f64) -> f64 {
    let mut most = [floor; LANES];
    let chunks = x.chunks_exact(LANES);
    for (m, &a) in most.iter_mut().zip(chunks.remainder()) {
        *m = if value(a) > *m { value(a) } else { *m };
    }
    for chunk in chunks {
        for lane in 0..LANES {
            let a = value(chunk[lane]);
            most[lane] = if a > most[lane] { a } else { most[lane] };
        }
    }
    most.into_iter().fold(floor, |m, a| if a > m { a } else { m })
}

/// `max |xᵢ|`.
pub fn max_abs(x: &[f64]) -> f64 {
    largest(x, 0.0, f64::abs)
}

/// `min xᵢ`.
pub fn min(x: &[f64]) -> f64 {
    -largest(x, f64::NEG_INFINITY, |a| -a)
}

/// True if no entry is infinite or NaN.
pub fn all_finite(x: &[f64]) -> bool {
    // 0 · a is NaN exactly for infinite and NaN entries, and NaN persists in a sum
    wide!(sum(x, x, |a, _| 0.0 * a)) == 0.0
}

/// Index of the first entry that is infinite or NaN.
pub fn first_not_finite(x: &[f64]) -> Option<usize> {
    if all_finite(x) {
        None
    } else {
        x.iter().position(|a| !a.is_finite())
    }
}

/// `wᵢ = 1 / (relative |yᵢ| + absoluteᵢ)`; false if a weight is not positive and finite.
pub fn error_weights(y: &[f64], relative: f64, absolute: &[f64], w: &mut [f64]) -> bool {
    for ((w, &y), &absolute) in w.iter_mut().zip(y).zip(absolute) {
        *w = 1.0 / (relative * y.abs() + absolute);
    }
    // a weight of zero results from an infinite unknown
    all_finite(w) && min(w) > 0.0
}
