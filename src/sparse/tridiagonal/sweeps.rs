//! Sweeps from the ends to the twist and back, on vectors that begin at the place `first`.

use super::dense::{self, MultiplyAdd, OneRounding, TwoRoundings, padded};
use super::plan::Block;

/// Right-hand side, and its product with the inverse blocks.
type RotatedVectors<'a> = [&'a mut [f64]; 2];

/// `y = D⁻¹ b` of a block.
#[inline(always)]
pub(super) fn apply<A: MultiplyAdd>(block: &Block, onward: &[f64], [b, y]: RotatedVectors<'_>, first: usize) {
    let inverse = &onward[block.numbers[0]..][..block.rows * block.size];
    let at = block.at - first;
    dense::multiply::<A, false>(inverse, &b[at..][..block.size], &mut y[at..][..block.rows]);
}

/// Applies the inverse of each block in this order, and subtracts its contribution to the next block.
#[inline(always)]
pub(super) fn inwards<'s, A: MultiplyAdd>(
    blocks: &[Block],
    steps: impl Iterator<Item = &'s [u32; 2]>,
    onward: &[f64],
    [b, y]: RotatedVectors<'_>,
    first: usize,
) {
    for &[i, next] in steps {
        let block = &blocks[i as usize];
        apply::<A>(block, onward, [b, y], first);
        let (mine, theirs) = (&block.mine, &block.theirs);
        let rows = padded(theirs.len());
        let away = &onward[block.numbers[0] + block.rows * block.size..][..rows * mine.len()];
        let to = &mut b[blocks[next as usize].at - first + theirs.start..][..rows];
        let own = &y[block.at - first + mine.start..][..mine.len()];
        dense::multiply::<A, true>(away, own, to);
    }
}

/// Subtracts from blocks, in this order, the contribution of each one's next block.
#[inline(always)]
pub(super) fn outwards<'s, A: MultiplyAdd>(
    blocks: &[Block],
    steps: impl Iterator<Item = &'s [u32; 2]>,
    back: &[f64],
    y: &mut [f64],
    first: usize,
) {
    for &[i, next] in steps {
        let (block, next) = (&blocks[i as usize], &blocks[next as usize]);
        let theirs = block.theirs.len();
        let numbers = &back[block.numbers[1]..][..block.rows * theirs];
        let (at, there) = (block.at - first, next.at - first);
        // blocks do not overlap
        let (low, high) = y.split_at_mut(at.max(there));
        let (own, known) = if at < there {
            (&mut low[at..], &high[block.theirs.start..])
        } else {
            (high, &low[there + block.theirs.start..])
        };
        dense::multiply::<A, true>(numbers, &known[..theirs], &mut own[..block.rows]);
    }
}

/// [`inwards`] in the widest vectors of the processor.
pub(super) fn to_the_twist(
    blocks: &[Block],
    steps: &[[u32; 2]],
    onward: &[f64],
    [b, y]: RotatedVectors<'_>,
    first: usize,
) {
    #[cfg(target_arch = "x86_64")]
    if wide() {
        #[target_feature(enable = "avx2,fma")]
        fn fused(blocks: &[Block], steps: &[[u32; 2]], onward: &[f64], [b, y]: RotatedVectors<'_>, first: usize) {
            inwards::<OneRounding>(blocks, steps.iter(), onward, [b, y], first);
        }
        // SAFETY: the processor supports the enabled target features.
        return unsafe { fused(blocks, steps, onward, [b, y], first) };
    }
    inwards::<TwoRoundings>(blocks, steps.iter(), onward, [b, y], first);
}

/// [`apply`] in the widest vectors of the processor.
pub(super) fn at_the_twist(block: &Block, onward: &[f64], [b, y]: RotatedVectors<'_>) {
    #[cfg(target_arch = "x86_64")]
    if wide() {
        #[target_feature(enable = "avx2,fma")]
        fn fused(block: &Block, onward: &[f64], [b, y]: RotatedVectors<'_>) {
            apply::<OneRounding>(block, onward, [b, y], 0);
        }
        // SAFETY: the processor supports the enabled target features.
        return unsafe { fused(block, onward, [b, y]) };
    }
    apply::<TwoRoundings>(block, onward, [b, y], 0);
}

/// [`outwards`] in the widest vectors of the processor, in the reverse order of the steps.
pub(super) fn from_the_twist(blocks: &[Block], steps: &[[u32; 2]], back: &[f64], y: &mut [f64], first: usize) {
    #[cfg(target_arch = "x86_64")]
    if wide() {
        #[target_feature(enable = "avx2,fma")]
        fn fused(blocks: &[Block], steps: &[[u32; 2]], back: &[f64], y: &mut [f64], first: usize) {
            outwards::<OneRounding>(blocks, steps.iter().rev(), back, y, first);
        }
        // SAFETY: the processor supports the enabled target features.
        return unsafe { fused(blocks, steps, back, y, first) };
    }
    outwards::<TwoRoundings>(blocks, steps.iter().rev(), back, y, first);
}

/// True if the processor supports the instructions of x86-64-v3 used here (AVX2 and FMA).
#[cfg(target_arch = "x86_64")]
pub(super) fn wide() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}
