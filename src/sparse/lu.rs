//! LU factors by the cheaper of two methods: small dense blocks along a line, or KLU.

use super::klu::{Klu, KluError};
use super::{BlockTridiagonal, Pattern};

/// Largest number of dense block products per matrix entry for which dense blocks are chosen. KLU's factors of a beam have some 1.5 times
/// as many entries as the matrix. A product within a dense block costs less than half a sparse one: entries are contiguous, four are
/// processed at once, and no index is read.
const DENSE: usize = 4;

/// Consecutive failures of the block factorization after which it is no longer tried.
const PATIENCE: u32 = 3;

/// LU factors of matrices with a common pattern; solves for one right-hand side at a time.
pub struct Lu {
    pattern: Pattern,
    /// None if dense blocks would be more expensive.
    blocks: Option<Box<BlockTridiagonal>>,
    /// None until it is needed.
    klu: Option<Klu>,
    /// True if the present factors are dense blocks.
    in_blocks: bool,
    factorizations: u64,
    refused: u64,
    /// Number of consecutive failed block factorizations.
    in_vain: u32,
}

impl Lu {
    /// Analyzes a square pattern; the choice of the method depends only on the pattern.
    pub fn new(pattern: &Pattern) -> Result<Self, KluError> {
        let blocks = BlockTridiagonal::new(pattern, DENSE * pattern.entries()).map(Box::new);
        match blocks {
            Some(_) => Ok(Self::with_method(pattern, blocks, None)),
            None => Self::sparse(pattern),
        }
    }

    /// Uses KLU in any case: only KLU's factors provide the sign of the determinant.
    pub fn sparse(pattern: &Pattern) -> Result<Self, KluError> {
        Ok(Self::with_method(pattern, None, Some(Klu::new(pattern)?)))
    }

    fn with_method(pattern: &Pattern, blocks: Option<Box<BlockTridiagonal>>, klu: Option<Klu>) -> Self {
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

    /// Sign of the determinant from KLU's factors: 1, -1, or 0 without factors.
    pub fn determinant_sign(&self) -> i8 {
        self.klu.as_ref().map_or(0, Klu::determinant_sign)
    }

    /// Number of stored entries.
    pub fn entries(&self) -> usize {
        self.pattern.entries()
    }

    /// True if the present factors are dense blocks along a line.
    pub fn in_blocks(&self) -> bool {
        self.in_blocks
    }

    /// Number of bytes of the present factors that one solution reads.
    pub fn bytes(&self) -> usize {
        match &self.blocks {
            Some(blocks) if self.in_blocks => blocks.bytes(),
            _ => self.klu.as_ref().map_or(0, Klu::bytes),
        }
    }

    /// Number of factorizations.
    pub fn factorizations(&self) -> u64 {
        self.factorizations + self.klu.as_ref().map_or(0, |klu| klu.factorizations)
    }

    /// Number of repeated factorizations because of bad pivots: stale pivots of KLU, or pivots restricted to blocks.
    pub fn pivot_refreshes(&self) -> u64 {
        self.refused + self.klu.as_ref().map_or(0, |klu| klu.pivot_refreshes)
    }

    /// Factors the matrix with the entries `values`, in the order of the pattern. Matrices that need row exchanges between blocks are
    /// passed to KLU.
    ///
    /// After an error there are no factors. Panics if the number of values differs from that of the pattern.
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

    /// Discards the factors and the pivot history: the next factorization chooses its pivots anew.
    pub fn forget(&mut self) {
        (self.in_blocks, self.in_vain) = (false, 0);
        self.klu.iter_mut().for_each(Klu::forget);
    }

    /// Replaces `b` by the solution of `A x = b`; returns false without factors. Panics if `b` has a wrong length.
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
