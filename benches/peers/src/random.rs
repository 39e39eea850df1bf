//! Numbers that look random and are the same in every run.

/// A linear congruential generator (Knuth, MMIX); the upper bits are the good ones.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0
    }

    /// Numbers in (-size, size).
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        let mut one = || (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        (0..n).map(|_| size * one()).collect()
    }
}
