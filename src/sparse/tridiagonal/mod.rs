//! LU factors of block tridiagonal matrices: unknowns coupled along a line.
//!
//! Unknowns that a row of two entries expresses by another one are eliminated first ([`condense`](super::condense)). The rest is ordered in levels of its
//! graph, by distance from an end node. Each level is a small dense block, adjacent only to the level before and the one after
//! ([`levels`]). Elimination proceeds from both ends to a block in the middle: two independent chains of operations (a twisted
//! factorization).
//!
//! ```text
//! D_j = A_jj - A_ji D_i⁻¹ A_ij      i the block before on the way to the middle, or both at the middle
//! y_j = D_j⁻¹ (b_j - A_ji y_i)      x_i = y_i - (D_i⁻¹ A_ij) x_j
//! ```
//!
//! Rows are exchanged only within blocks. After every factorization, a test solution checks that this was sufficient: its backward error
//! must be small (Oettli & Prager 1964).

mod dense;
mod levels;
mod plan;
mod sweeps;

use crate::numerics::threads::both;
use crate::sparse::Pattern;
use dense::{MultiplyAdd, OneRounding, TwoRoundings, padded};
use plan::{Block, Plan};
#[cfg(target_arch = "x86_64")]
use sweeps::wide;

/// Largest accepted backward error of the factors: Newton's iteration does not notice the sixth digit of its Jacobian.
///
/// The largest errors occur for a rate that is nearly given, `v = cj u - b` of a very short step: v is a difference of numbers of the
/// size of b.
const BACKWARD: f64 = 1e-6;

/// Factors of matrices that share a pattern.
pub struct BlockTridiagonal {
    plan: Plan,
    /// For each block: its inverse, and the factor for its contribution to the next block.
    onward: Vec<f64>,
    /// Factor for the contribution of the next block.
    back: Vec<f64>,
    /// Coefficients of the row of each pair: `x_e = per b_r + ratio x_o`.
    per: Vec<f64>,
    ratio: Vec<f64>,
    /// First term `per b_r` for the present right-hand side.
    given: Vec<f64>,
    /// Contributions of `b_r` to other rows.
    shifts: Vec<f64>,
    /// Right-hand side and solution, block by block.
    x: Vec<f64>,
    y: Vec<f64>,
    room: Room,
}

/// Work space.
struct Room {
    /// The block being assembled.
    block: Vec<f64>,
    exchanged: Vec<usize>,
    columns: Vec<f64>,
    /// Contributions of both preceding blocks to a block.
    taken: [Vec<f64>; 2],
    /// Contribution of the next block to a block.
    through: Vec<f64>,
    solution: Vec<f64>,
    left: Vec<f64>,
    size: Vec<f64>,
}

impl BlockTridiagonal {
    /// Analyzes a square pattern. None if no ordering along a line is found whose solution needs at most `most` products of blocks, or if
    /// a number exceeds 32 bits.
    pub fn new(pattern: &Pattern, most: usize) -> Option<Self> {
        let plan = Plan::new(pattern, most)?;
        let most = |size: &dyn Fn(&Block) -> usize| plan.blocks.iter().map(size).max().unwrap_or(0);
        let (rows, n) = (most(&|block| block.rows), pattern.columns());
        let touched = most(&|block| padded(block.theirs.len()));
        let room = Room {
            block: vec![0.0; most(&|block| block.room().iter().sum())],
            exchanged: vec![0; rows],
            columns: vec![0.0; 3 * rows],
            taken: [(); 2].map(|()| vec![0.0; touched * touched]),
            through: vec![0.0; most(&|block| block.rows * block.theirs.len())],
            solution: vec![0.0; n],
            left: vec![0.0; n],
            size: vec![0.0; n],
        };
        let pairs = plan.condensed.pairs.len();
        Some(Self {
            onward: vec![0.0; plan.numbers[0]],
            back: vec![0.0; plan.numbers[1]],
            per: vec![0.0; pairs],
            ratio: vec![0.0; pairs],
            given: vec![0.0; pairs],
            shifts: vec![0.0; plan.shifts.len()],
            x: vec![0.0; plan.places],
            y: vec![0.0; plan.places],
            plan,
            room,
        })
    }

    /// Bytes that one solution reads.
    pub fn bytes(&self) -> usize {
        let plan = &self.plan;
        let pairs = size_of_val(&plan.condensed.pairs[..]) + 8 * (self.per.len() + self.ratio.len());
        8 * (self.onward.len() + self.back.len())
            + size_of_val(&plan.kept[..])
            + size_of_val(&plan.shifts[..])
            + 8 * self.shifts.len()
            + pairs
    }

    /// Factors the matrix with the entries `values`, in the order of the analyzed pattern; returns false if rows would have to be
    /// exchanged between blocks. Panics if the number of values differs from that of the pattern.
    pub fn factor(&mut self, pattern: &Pattern, values: &[f64]) -> bool {
        assert_eq!(values.len(), pattern.entries(), "values of another pattern");
        #[cfg(target_arch = "x86_64")]
        if wide() {
            // SAFETY: the processor supports the enabled target features.
            return unsafe { self.factor_wide(pattern, values) };
        }
        self.factor_by::<TwoRoundings>(pattern, values)
    }

    /// Replaces `b` by the solution of `A x = b`. Panics if `b` has a wrong length.
    pub fn solve(&mut self, b: &mut [f64]) {
        assert_eq!(b.len(), self.plan.condensed.by.len(), "right-hand side of another size");
        if self.plan.apart {
            return self.solve_apart(b);
        }
        #[cfg(target_arch = "x86_64")]
        if wide() {
            // SAFETY: the processor supports the enabled target features.
            return unsafe { self.solve_wide(b) };
        }
        self.solve_by::<TwoRoundings>(b);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn factor_wide(&mut self, pattern: &Pattern, values: &[f64]) -> bool {
        self.factor_by::<OneRounding>(pattern, values)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn solve_wide(&mut self, b: &mut [f64]) {
        self.solve_by::<OneRounding>(b);
    }

    #[inline(always)]
    fn factor_by<A: MultiplyAdd>(&mut self, pattern: &Pattern, values: &[f64]) -> bool {
        self.condense(values);
        let twist = self.plan.twist;
        for step in 0..self.plan.steps.len() {
            if !self.block::<A>(values, self.plan.steps[step][0] as usize) {
                return false;
            }
        }
        self.block::<A>(values, twist) && self.holds::<A>(pattern, values)
    }

    /// Computes the coefficients of the rows that eliminate an unknown.
    #[inline(always)]
    fn condense(&mut self, values: &[f64]) {
        let plan = &self.plan;
        for ((pair, per), ratio) in plan.condensed.pairs.iter().zip(&mut self.per).zip(&mut self.ratio) {
            *per = 1.0 / values[pair.given.1 as usize];
            *ratio = -*per * values[pair.kept.1 as usize];
        }
        for ([.., entry], shift) in plan.shifts.iter().zip(&mut self.shifts) {
            *shift = -values[*entry as usize];
        }
    }

    /// Assembles a block, subtracts the contributions of the preceding blocks ([`Room::taken`]), and inverts it.
    #[inline(always)]
    fn block<A: MultiplyAdd>(&mut self, values: &[f64], j: usize) -> bool {
        let Self {
            plan,
            onward,
            back,
            room,
            ratio,
            ..
        } = self;
        let block = &plan.blocks[j];
        let [square, beside, column] = block.room();
        let work = &mut room.block[..square + beside + column];
        work.fill(0.0);
        for [to, entry] in &plan.sources[block.sources.clone()] {
            work[*to as usize] += values[*entry as usize];
        }
        for [to, entry, pair] in &plan.folded[block.folded.clone()] {
            work[*to as usize] += ratio[*pair as usize] * values[*entry as usize];
        }
        let (d, rest) = work.split_at_mut(square);
        let (beside, column) = rest.split_at_mut(beside);
        let mut take = |theirs: &std::ops::Range<usize>, taken: &[f64]| {
            let rows = padded(theirs.len());
            for (c, taken) in theirs.clone().zip(taken.chunks_exact(rows.max(1))) {
                let to = &mut d[c * block.rows + theirs.start..][..theirs.len()];
                // both factors are stored with the opposite sign
                to.iter_mut().zip(taken).for_each(|(to, taken)| *to -= taken);
            }
        };
        // from the left, from the right; the twist block has both
        let before = [
            (j <= plan.twist).then(|| j.checked_sub(1)).flatten(),
            (j >= plan.twist).then_some(j + 1).filter(|k| *k < plan.blocks.len()),
        ];
        for (before, taken) in before.into_iter().zip(&room.taken) {
            if let Some(before) = before {
                take(&plan.blocks[before].theirs, taken);
            }
        }
        if !dense::invert::<A>(
            d,
            block.rows,
            &mut room.exchanged[..block.size],
            &mut room.columns[..3 * block.rows],
        ) {
            return false;
        }
        let onward = &mut onward[block.numbers[0]..][..square + column.len()];
        let (inverse, away) = onward.split_at_mut(square);
        let back = &mut back[block.numbers[1]..][..block.rows * block.theirs.len()];
        dense::strips(d, block.rows, inverse);
        away.iter_mut().zip(column).for_each(|(away, entry)| *away = -*entry);
        let through = &mut room.through[..back.len()];
        let (rows, mine) = (block.rows, &block.mine);
        dense::product::<A>(
            &d[mine.start * rows..mine.end * rows],
            rows,
            beside,
            mine.len().max(1),
            through,
        );
        dense::strips(through, rows, back);
        // D of the next block is reduced by A D⁻¹ A
        let taken = &mut room.taken[usize::from(j > plan.twist)];
        let touched = padded(block.theirs.len());
        for (to, through) in taken.chunks_exact_mut(touched.max(1)).zip(through.chunks_exact(rows)) {
            dense::multiply::<A, false>(away, &through[mine.clone()], to);
        }
        true
    }

    #[inline(always)]
    fn solve_by<A: MultiplyAdd>(&mut self, b: &mut [f64]) {
        self.take(b);
        let (plan, x, y) = (&self.plan, &mut self.x, &mut self.y);
        let (blocks, onward, back) = (&plan.blocks[..], &self.onward[..], &self.back[..]);
        sweeps::inwards::<A>(blocks, plan.steps.iter(), onward, [x, y], 0);
        sweeps::apply::<A>(&blocks[plan.twist], onward, [x, y], 0);
        sweeps::outwards::<A>(blocks, plan.steps.iter().rev(), back, y, 0);
        self.give(b);
    }

    /// Like `solve_by`, but from both ends in two threads; the result is bitwise identical.
    fn solve_apart(&mut self, b: &mut [f64]) {
        self.take(b);
        let (plan, x, y) = (&self.plan, &mut self.x, &mut self.y);
        let (blocks, onward, back) = (&plan.blocks[..], &self.onward[..], &self.back[..]);
        let twist = &blocks[plan.twist];
        let beyond = twist.at + twist.rows;
        let (left, right) = plan.steps.split_at(plan.twist);
        // the contribution of the right side to the twist must follow that of the left side
        let (right, last) = right.split_at(right.len().saturating_sub(1));
        {
            let (left_x, right_x) = x.split_at_mut(beyond);
            let (left_y, right_y) = y.split_at_mut(beyond);
            both(
                || sweeps::to_the_twist(blocks, left, onward, [left_x, left_y], 0),
                || sweeps::to_the_twist(blocks, right, onward, [right_x, right_y], beyond),
            );
        }
        sweeps::to_the_twist(blocks, last, onward, [x, y], 0);
        sweeps::at_the_twist(twist, onward, [x, y]);
        sweeps::from_the_twist(blocks, last, back, y, 0);
        let (left_y, right_y) = y.split_at_mut(beyond);
        both(
            || sweeps::from_the_twist(blocks, left, back, left_y, 0),
            || sweeps::from_the_twist(blocks, right, back, right_y, beyond),
        );
        self.give(b);
    }

    /// Reads the right-hand side, block by block.
    #[inline(always)]
    fn take(&mut self, b: &[f64]) {
        let Self {
            plan,
            x,
            per,
            shifts,
            given,
            ..
        } = self;
        x.fill(0.0);
        // SAFETY: the plan's rows and unknowns are below n, the length of b; its places are below the length of x and
        // y.
        unsafe {
            for kept in &plan.kept {
                *x.get_unchecked_mut(kept.at as usize) = *b.get_unchecked(kept.row as usize);
            }
            for ((pair, given), per) in plan.condensed.pairs.iter().zip(&mut *given).zip(&*per) {
                *given = per * b.get_unchecked(pair.row as usize);
            }
            for ([to, pair, _], shift) in plan.shifts.iter().zip(&*shifts) {
                *x.get_unchecked_mut(*to as usize) += shift * given.get_unchecked(*pair as usize);
            }
        }
    }

    /// Writes the solution, including the eliminated unknowns.
    #[inline(always)]
    fn give(&self, b: &mut [f64]) {
        let Self {
            plan, y, ratio, given, ..
        } = self;
        // SAFETY: as in [`Self::take`].
        unsafe {
            for kept in &plan.kept {
                *b.get_unchecked_mut(kept.unknown as usize) = *y.get_unchecked(kept.at as usize);
            }
            for ((pair, given), ratio) in plan.condensed.pairs.iter().zip(given).zip(ratio) {
                *b.get_unchecked_mut(pair.given.0 as usize) = given + ratio * b.get_unchecked(pair.kept.0 as usize);
            }
        }
    }

    /// True if the backward error of a test solution is small in every row.
    #[inline(always)]
    fn holds<A: MultiplyAdd>(&mut self, pattern: &Pattern, values: &[f64]) -> bool {
        let mut solution = std::mem::take(&mut self.room.solution);
        let mut left = std::mem::take(&mut self.room.left);
        let mut size = std::mem::take(&mut self.room.size);
        let mut state = 1_u64;
        for (left, size) in left.iter_mut().zip(&mut size) {
            // pseudo-random right-hand side, unrelated to any matrix (Knuth's generator)
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            *left = (state >> 40) as f64 / (1 << 23) as f64 - 1.0;
            *size = left.abs();
        }
        solution.copy_from_slice(&left);
        self.solve_by::<A>(&mut solution);
        for (column, x) in solution.iter().enumerate() {
            let own = pattern.column(column);
            for (row, value) in pattern.rows[own.clone()].iter().zip(&values[own]) {
                let product = value * x;
                left[*row as usize] -= product;
                size[*row as usize] += product.abs();
            }
        }
        // written so that a NaN fails the test
        let holds = left.iter().zip(&size).all(|(left, size)| left.abs() <= BACKWARD * size);
        (self.room.solution, self.room.left, self.room.size) = (solution, left, size);
        holds
    }
}
