//! LU factors in the cheaper of two ways: small dense blocks along a line, or KLU.

use super::klu::{Klu, KluError};
use super::{BlockTridiagonal, Pattern};

/// Products of dense blocks up to which these are chosen, for each entry of the matrix. KLU's factors of a beam have some 1.5 times as many entries as
/// the matrix; a product of a dense block is worth less than half a sparse one: they stand in order, four go at a time, and none waits for an index.
const DENSE: usize = 4;

/// Matrices in a row that blocks may refuse before they are no longer asked.
const PATIENCE: u32 = 3;

/// Factors of matrices that share a pattern, for one right-hand side after the other.
pub struct Lu {
    pattern: Pattern,
    /// None where a line of dense blocks would cost more.
    blocks: Option<Box<BlockTridiagonal>>,
    /// None before it is needed.
    klu: Option<Klu>,
    /// Whether the present factors are the blocks.
    in_blocks: bool,
    factorizations: u64,
    refused: u64,
    /// The last ones in a row.
    in_vain: u32,
}

impl Lu {
    /// Analyses a square pattern; the way that is chosen depends on it alone.
    pub fn new(pattern: &Pattern) -> Result<Self, KluError> {
        let blocks = BlockTridiagonal::new(pattern, DENSE * pattern.entries()).map(Box::new);
        match blocks {
            Some(_) => Ok(Self::of(pattern, blocks, None)),
            None => Self::sparse(pattern),
        }
    }

    /// KLU's factors in any case: of these alone the sign of the determinant is known.
    pub fn sparse(pattern: &Pattern) -> Result<Self, KluError> {
        Ok(Self::of(pattern, None, Some(Klu::new(pattern)?)))
    }

    fn of(pattern: &Pattern, blocks: Option<Box<BlockTridiagonal>>, klu: Option<Klu>) -> Self {
        Self {
            pattern: pattern.clone(),
            blocks,
            klu,
            in_blocks: false,
            factorizations: 0,
            refused: 0,
            in_vain: 0,
        }
    }

    /// Sign of the determinant of KLU's factors: 1, -1, or 0 without any.
    pub fn determinant_sign(&self) -> i8 {
        self.klu.as_ref().map_or(0, Klu::determinant_sign)
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.pattern.entries()
    }

    /// Whether the present factors are dense blocks along a line.
    pub fn in_blocks(&self) -> bool {
        self.in_blocks
    }

    /// Bytes of the present factors that a solution reads.
    pub fn bytes(&self) -> usize {
        match &self.blocks {
            Some(blocks) if self.in_blocks => blocks.bytes(),
            _ => self.klu.as_ref().map_or(0, Klu::bytes),
        }
    }

    /// Factorisations.
    pub fn factorizations(&self) -> u64 {
        self.factorizations + self.klu.as_ref().map_or(0, |klu| klu.factorizations)
    }

    /// Factorisations done anew because pivots were bad: old ones of KLU's, or those within blocks.
    pub fn pivot_refreshes(&self) -> u64 {
        self.refused + self.klu.as_ref().map_or(0, |klu| klu.pivot_refreshes)
    }

    /// Factors the matrix whose entries, in the order of the pattern, are `values`. What would need rows exchanged between blocks goes to KLU.
    ///
    /// After a fault there are no factors. Panics when the number of values is not that of the pattern.
    pub fn factor(&mut self, values: &[f64]) -> Result<(), KluError> {
        if let Some(blocks) = self.blocks.as_mut().filter(|_| self.in_vain < PATIENCE) {
            self.factorizations += 1;
            self.in_blocks = blocks.factor(&self.pattern, values);
            if self.in_blocks {
                self.in_vain = 0;
                return Ok(());
            }
            self.refused += 1;
            self.in_vain += 1;
        }
        let klu = match &mut self.klu {
            Some(klu) => klu,
            none => none.insert(Klu::new(&self.pattern)?),
        };
        klu.factor(values)
    }

    /// Forgets the factors, and what was learnt of them: the next ones get pivots of their own.
    pub fn forget(&mut self) {
        (self.in_blocks, self.in_vain) = (false, 0);
        self.klu.iter_mut().for_each(Klu::forget);
    }

    /// Replaces `b` by the solution of `A x = b`; false without factors. Panics when `b` has another length.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        match (&mut self.blocks, &mut self.klu) {
            (Some(blocks), _) if self.in_blocks => {
                blocks.solve(b);
                true
            }
            (_, Some(klu)) => klu.solve(b),
            _ => false,
        }
    }
}
