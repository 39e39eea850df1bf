//! LU factors in the cheaper of two ways: small dense blocks along a line, or KLU.

use super::klu::{Klu, KluError};
use super::{BlockTridiagonal, Pattern};

/// Products of dense blocks that are worth one of sparse factors: they stand in order, four go at a time, and none waits for an index.
const DENSE: f64 = 2.5;

/// Factors of matrices that share a pattern, for one right-hand side after the other.
pub struct Lu {
    klu: Klu,
    /// None where a line of dense blocks would cost more.
    blocks: Option<Box<BlockTridiagonal>>,
    /// Whether the present factors are these blocks.
    in_blocks: bool,
    factorizations: u64,
    refused: u64,
}

impl Lu {
    /// Analyses a square pattern; the way that is chosen depends on it alone.
    pub fn new(pattern: &Pattern) -> Result<Self, KluError> {
        let klu = Klu::new(pattern)?;
        let worth = |blocks: &BlockTridiagonal| blocks.products() as f64 <= DENSE * klu.expected_entries();
        let blocks = BlockTridiagonal::new(pattern).filter(worth).map(Box::new);
        Ok(Self {
            klu,
            blocks,
            in_blocks: false,
            factorizations: 0,
            refused: 0,
        })
    }

    /// KLU's factors in any case: of these alone the sign of the determinant is known.
    #[must_use]
    pub fn sparse(self) -> Self {
        Self { blocks: None, ..self }
    }

    /// Sign of the determinant of KLU's factors: 1, -1, or 0 without any.
    pub fn determinant_sign(&self) -> i8 {
        self.klu.determinant_sign()
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.klu.entries()
    }

    /// Whether the present factors are dense blocks along a line.
    pub fn in_blocks(&self) -> bool {
        self.in_blocks
    }

    /// Bytes of the present factors that a solution reads.
    pub fn bytes(&self) -> usize {
        match &self.blocks {
            Some(blocks) if self.in_blocks => blocks.bytes(),
            _ => self.klu.bytes(),
        }
    }

    /// Factorisations.
    pub fn factorizations(&self) -> u64 {
        self.factorizations + self.klu.factorizations
    }

    /// Factorisations done anew because pivots were bad: old ones of KLU's, or those within blocks.
    pub fn pivot_refreshes(&self) -> u64 {
        self.refused + self.klu.pivot_refreshes
    }

    /// Factors the matrix whose entries, in the order of the pattern, are `values`. What would need rows exchanged between blocks goes to KLU.
    ///
    /// After a fault there are no factors. Panics when the number of values is not that of the pattern.
    pub fn factor(&mut self, values: &[f64]) -> Result<(), KluError> {
        if let Some(blocks) = &mut self.blocks {
            self.factorizations += 1;
            self.in_blocks = blocks.factor(values);
            if self.in_blocks {
                return Ok(());
            }
            self.refused += 1;
        }
        self.klu.factor(values)
    }

    /// Forgets the factors: the next ones get pivots of their own.
    pub fn forget(&mut self) {
        self.in_blocks = false;
        self.klu.forget();
    }

    /// Replaces `b` by the solution of `A x = b`; false without factors. Panics when `b` has another length.
    pub fn solve(&mut self, b: &mut [f64]) -> bool {
        match &mut self.blocks {
            Some(blocks) if self.in_blocks => {
                blocks.solve(b);
                true
            }
            _ => self.klu.solve(b),
        }
    }
}
