//! Reproducible pseudo-random numbers.

/// Linear congruential generator (Knuth, MMIX); uses the upper bits, which are more random.
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
