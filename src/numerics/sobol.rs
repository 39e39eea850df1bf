//! Sobol sequence: a low-discrepancy sequence of points in a cube.
//!
//! ```text
//! x_n = g_1 v_1 ⊕ g_2 v_2 ⊕ ..        g the bits of n ⊕ n/2 (Antonov & Saleev), v_k = m_k/2^k
//! ```
//!
//! The direction numbers `m` are the first of new-joe-kuo-6 (S. Joe & F. Y. Kuo, SIAM J. Sci. Comput. 30, 2635, 2008).

/// Number of available dimensions.
pub const MOST: usize = 20;

/// For each dimension after the first: degree and inner coefficients of its polynomial, initial direction numbers.
const JOE_KUO: [(u32, u32, &[u32]); MOST - 1] = [
    (1, 0, &[1]),
    (2, 1, &[1, 3]),
    (3, 1, &[1, 3, 1]),
    (3, 2, &[1, 1, 1]),
    (4, 1, &[1, 1, 3, 3]),
    (4, 4, &[1, 3, 5, 13]),
    (5, 2, &[1, 1, 5, 5, 17]),
    (5, 4, &[1, 1, 5, 5, 5]),
    (5, 7, &[1, 1, 7, 11, 19]),
    (5, 11, &[1, 1, 5, 1, 1]),
    (5, 13, &[1, 1, 1, 3, 11]),
    (5, 14, &[1, 3, 5, 5, 31]),
    (6, 1, &[1, 3, 3, 9, 7, 49]),
    (6, 13, &[1, 1, 1, 15, 21, 21]),
    (6, 16, &[1, 3, 1, 13, 27, 49]),
    (6, 19, &[1, 1, 1, 15, 7, 5]),
    (6, 22, &[1, 3, 1, 15, 13, 25]),
    (6, 25, &[1, 1, 5, 5, 19, 61]),
    (7, 1, &[1, 3, 7, 11, 23, 15, 103]),
];

/// The sequence in one dimension.
#[derive(Clone, Debug)]
pub struct Sobol([u32; 32]);

impl Sobol {
    /// Sequence in a dimension below [`MOST`].
    pub fn along(direction: usize) -> Self {
        let mut v = [0; 32];
        let polynomial = direction.checked_sub(1).and_then(|k| JOE_KUO.get(k));
        for k in 0..32 {
            v[k] = match polynomial {
                None => 1 << (31 - k),
                Some((_, _, first)) if k < first.len() => first[k] << (31 - k),
                Some((degree, inner, _)) => {
                    let s = *degree as usize;
                    let bits = (1..s).filter(|j| (inner >> (s - 1 - j)) & 1 == 1);
                    bits.fold(v[k - s] ^ (v[k - s] >> s), |sum, j| sum ^ v[k - j])
                }
            };
        }
        Self(v)
    }

    /// 32 bits of a point; those of point 0 are 0.
    pub fn bits(&self, number: u32) -> u32 {
        let gray = number ^ (number >> 1);
        let set = self.0.iter().enumerate().filter(|(k, _)| (gray >> k) & 1 == 1);
        set.fold(0, |sum, (_, v)| sum ^ v)
    }

    /// Point `number` in the open interval (0, 1), digitally shifted. Omits the first point of the sequence, a corner
    /// of the cube.
    pub fn share(&self, number: u32, shift: u32) -> f64 {
        (f64::from(self.bits(number + 1) ^ shift) + 0.5) / 2_f64.powi(32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(direction: usize, number: u32) -> f64 {
        f64::from(Sobol::along(direction).bits(number)) / 2_f64.powi(32)
    }

    /// Source: the first points by Joe & Kuo's program.
    #[test]
    fn first_points_are_known() {
        let first = [
            [0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625],
            [0.875, 0.875, 0.125],
            [0.625, 0.125, 0.875],
            [0.125, 0.625, 0.375],
        ];
        for (n, point) in first.iter().enumerate() {
            assert_eq!([0, 1, 2].map(|d| share(d, n as u32)), *point, "point {n}");
        }
    }

    /// Goal: in every dimension, each interval of length 2^-k contains exactly one of the first 2^k points.
    #[test]
    fn every_stratum_holds_one_point() {
        for direction in 0..MOST {
            for k in [3, 6, 10] {
                let sobol = Sobol::along(direction);
                let mut seen: Vec<u32> = (0..1 << k).map(|n| sobol.bits(n) >> (32 - k)).collect();
                seen.sort_unstable();
                assert_eq!(seen, (0..1 << k).collect::<Vec<_>>(), "direction {direction}");
            }
        }
    }
}
