//! Reproducible pseudo-random numbers: SplitMix64 (Steele, Lea & Flood, 2014).

/// Pseudo-random number generator.
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// Generator of a seed and a stream; streams of one seed differ.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut own = Self(seed);
        let mixed = own.next() ^ stream.wrapping_mul(0xd1b5_4a32_d192_ed03);
        Self(mixed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Next 32 bits.
    pub fn bits(&mut self) -> u32 {
        (self.next() >> 32) as u32
    }

    /// Next number in the open interval (0, 1).
    pub fn share(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// The k-th following [`Rng::share`], counted from 0.
    pub fn at(mut self, k: u64) -> f64 {
        self.0 = self.0.wrapping_add(k.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        self.share()
    }

    /// Next integer below `count`.
    pub fn below(&mut self, count: u64) -> u64 {
        ((u128::from(self.next()) * u128::from(count)) >> 64) as u64
    }

    /// Random permutation of the integers below `count` (Fisher & Yates).
    pub fn order(&mut self, count: u32) -> Vec<u32> {
        let mut all: Vec<u32> = (0..count).collect();
        for k in (1..all.len()).rev() {
            let other = self.below(k as u64 + 1) as usize;
            all.swap(k, other);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: the first numbers of SplitMix64 from 1234567, by the code of Steele, Lea & Flood.
    #[test]
    fn numbers_are_those_of_splitmix() {
        let mut chance = Rng(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| chance.next()).collect();
        assert_eq!(
            first,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
    }

    #[test]
    fn an_order_has_each_number_once() {
        let mut order = Rng::new(1, 2).order(1000);
        assert_ne!(order[..10], [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
        order.sort_unstable();
        assert_eq!(order, (0..1000).collect::<Vec<_>>());
    }
}
