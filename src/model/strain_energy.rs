//! Energy of the section beyond its quadratic part.

use crate::case::schema::StrainEnergy as Written;
use crate::numerics::Scalar;

/// Highest degree of the polynomial.
pub const DEGREE: usize = 6;
/// Monomials of stretch and curvature up to that degree: number with an even power of curvature, total number.
const EVEN: usize = 16;
const ALL: usize = (DEGREE + 1) * (DEGREE + 2) / 2;

/// `[E48]` Potential added by a finite-strain law of the section; `g_i` is the larger limit of `y_i`:
///
/// ```text
/// Ω = Ω_2 + P(z)      y = (λ - 1 - λ_p, κ - α_p, p_u, p_d)      P = Σ P_k z^k, 3 <= |k| <= degree
/// z = (y_1/g_1, y_2/g_2, (p_u + p_d)/2 g_3, (p_u - p_d)/2 g_3)
/// N = EA y_1 + P_1      M = EI y_2 + P_2      φ_b l_b a1_R = φ_b l_b (a_p p_R + R A_M + A_N) - ∂P/∂p_R
/// ∂P/∂p_R = P_{3,4} - (∂λ_p/∂p_R) P_1 - (∂α_p/∂p_R) P_2
/// ```
///
/// All derivatives follow from one potential, so every polynomial conserves energy. Odd total powers of curvature and
/// pressure difference (`k_2 + k_4`) do not occur in mirror-symmetric sections, powers of the difference not with an upper row alone.
#[derive(Clone, Debug, PartialEq)]
pub struct StrainPotential {
    /// Lower and upper limits of `y`.
    limits: [[f64; 2]; 4],
    /// `1/g_1`, `1/g_2`, `1/2 g_3`.
    inverse: [f64; 3],
    blocks: Vec<Block>,
}

/// Powers of `z_1^a z_2^b`: first those with an even power of curvature, each kind sorted by total degree.
const MONOMIALS: [[usize; 2]; ALL] = {
    let mut all = [[0; 2]; ALL];
    let mut n = 0;
    while n < ALL {
        all[n] = powers_of(n);
        n += 1;
    }
    all
};

/// Powers of the monomial at an index.
const fn powers_of(place: usize) -> [usize; 2] {
    let odd = (place >= EVEN) as usize;
    let (mut left, mut sum) = (place - odd * EVEN, odd);
    loop {
        let many = (sum - odd) / 2 + 1;
        if left < many {
            let b = odd + 2 * left;
            return [sum - b, b];
        }
        left -= many;
        sum += 1;
    }
}

/// All terms with equal powers of pressure sum and pressure difference.
#[derive(Clone, Debug, PartialEq)]
struct Block {
    powers: [usize; 2],
    /// Coefficients of the monomials from `first`; zero where `|k| < 3`.
    coefficients: Vec<f64>,
    first: usize,
}

/// P and its derivatives by y.
#[derive(Clone, Copy, Debug)]
pub struct EnergySlopes<T> {
    /// P [N].
    pub energy: T,
    /// `P_1` [N].
    pub force: T,
    /// `P_2` [N m].
    pub moment: T,
    /// `P_3`, `P_4` [N/Pa].
    pub by_pressure: [T; 2],
}

/// Powers of one number.
type Powers<T> = [T; DEGREE + 1];

/// `1, x, .., x^DEGREE`.
#[inline]
fn powers<T: Scalar>(x: T) -> Powers<T> {
    let mut all = [T::constant(1.0); DEGREE + 1];
    for k in 1..=DEGREE {
        all[k] = all[k - 1] * x;
    }
    all
}

/// `k x^(k-1)` from the powers of x.
#[inline]
fn slope<T: Scalar>(powers: &Powers<T>, k: usize) -> T {
    match k {
        0 => T::zero(),
        _ => powers[k - 1] * k as f64,
    }
}

impl StrainPotential {
    /// Energy of a checked case.
    pub fn new(written: &Written) -> Self {
        let limits = written.limits();
        let degree = written.degree.min(DEGREE);
        let mut given = written.coefficients_n.iter().copied();
        let pairs = |most: usize| (0..=most).flat_map(|sum| (0..=sum).map(move |second| [sum - second, second]));
        let mut blocks = vec![];
        for powers in pairs(degree) {
            let sum = powers[0] + powers[1];
            let mut both = [0, 1].map(|odd| Block {
                powers,
                coefficients: vec![],
                first: odd * EVEN,
            });
            for [a, b] in pairs(degree - sum) {
                if written.mirrored && (b + powers[1]) % 2 == 1 {
                    continue;
                }
                both[b % 2].coefficients.push(match a + b + sum {
                    0..3 => 0.0,
                    _ => given.next().unwrap_or(0.0),
                });
            }
            blocks.extend(
                both.into_iter()
                    .filter(|block| block.coefficients.iter().any(|c| *c != 0.0)),
            );
        }
        let inverse = |parts: &[[f64; 2]]| match parts.iter().flatten().fold(0.0, |most, end| end.abs().max(most)) {
            largest if largest > 0.0 => 1.0 / largest,
            _ => 0.0,
        };
        Self {
            limits,
            inverse: [
                inverse(&limits[..1]),
                inverse(&limits[1..2]),
                0.5 * inverse(&limits[2..]),
            ],
            blocks,
        }
    }

    /// Evaluates P and its derivatives at y.
    pub fn at<T: Scalar>(&self, [stretch, curvature, upper, lower]: [T; 4]) -> EnergySlopes<T> {
        let [e, k] = [stretch * self.inverse[0], curvature * self.inverse[1]].map(powers);
        let [s, d] = [upper + lower, upper - lower].map(|p| powers(p * self.inverse[2]));
        let values = MONOMIALS.map(|[a, b]| e[a] * k[b]);
        let by_stretch = MONOMIALS.map(|[a, b]| slope(&e, a) * k[b]);
        let by_curvature = MONOMIALS.map(|[a, b]| e[a] * slope(&k, b));
        let [mut energy, mut force, mut moment, mut by_sum, mut by_difference] = [T::zero(); 5];
        for block in &self.blocks {
            let [mut value, mut of_stretch, mut of_curvature] = [T::zero(); 3];
            let range = block.first..block.first + block.coefficients.len();
            let slopes = by_stretch[range.clone()].iter().zip(&by_curvature[range.clone()]);
            for ((own, (stretch, curvature)), &c) in values[range].iter().zip(slopes).zip(&block.coefficients) {
                value += *own * c;
                of_stretch += *stretch * c;
                of_curvature += *curvature * c;
            }
            let [a, b] = block.powers;
            let pressures = s[a] * d[b];
            energy += pressures * value;
            force += pressures * of_stretch;
            moment += pressures * of_curvature;
            by_sum += slope(&s, a) * d[b] * value;
            by_difference += s[a] * slope(&d, b) * value;
        }
        let [by_sum, by_difference] = [by_sum, by_difference].map(|by| by * self.inverse[2]);
        EnergySlopes {
            energy,
            force: force * self.inverse[0],
            moment: moment * self.inverse[1],
            by_pressure: [by_sum + by_difference, by_sum - by_difference],
        }
    }

    /// Position of a state relative to the ellipsoid of validity of P; 1 on its boundary.
    pub fn out(&self, y: &[f64; 4]) -> f64 {
        self.parts(y).map(|(part, _)| part * part).sum::<f64>().sqrt()
    }

    /// Rate of [`Self::out`].
    pub fn out_rate(&self, y: &[f64; 4], rates: &[f64; 4]) -> f64 {
        let product: f64 = self
            .parts(y)
            .zip(rates)
            .map(|((part, end), rate)| part * rate / end)
            .sum();
        product / self.out(y).max(f64::MIN_POSITIVE)
    }

    /// Each entry over the limit on its side, with the limit.
    fn parts(&self, y: &[f64; 4]) -> impl Iterator<Item = (f64, f64)> {
        let ends = self
            .limits
            .iter()
            .zip(y)
            .map(|(limits, y)| (*y, limits[usize::from(*y > 0.0)]));
        ends.map(|(y, end)| if end == 0.0 { (0.0, 1.0) } else { (y / end, end) })
    }

    /// Bound of |P| over the quadratic part `(EA y_1² + EI y_2² + Σ φ_b l_b a_p p²)/2` for all states with strains and
    /// pressures up to `y`. `stiffness` contains the three coefficients. Each term is bounded by the product of a pair
    /// of its factors, in terms of energy, and the rest of its factors.
    pub fn share(&self, stiffness: [f64; 3], y: [f64; 3]) -> f64 {
        // Σ p² = 2 g² 2 (z_3² + z_4²)
        let square = |i: usize| 0.5 * stiffness[i.min(2)] * [1.0, 1.0, 0.5, 0.5][i] / self.inverse[i.min(2)].powi(2);
        let z: [f64; 4] = std::array::from_fn(|i| y[i.min(2)] * self.inverse[i.min(2)] * [1.0, 1.0, 2.0, 2.0][i]);
        let term = |powers: [usize; 4]| -> f64 {
            // |z_i z_j| <= (s_i z_i² + s_j z_j²)/(2 √(s_i s_j)), s the coefficients of the squares in the energy
            let pairs = (0..4).flat_map(|i| (0..=i).map(move |j| [i, j]));
            let bounds = pairs.filter_map(|pair| {
                let left: Option<Vec<i32>> = (0..4)
                    .map(|n| i32::try_from(powers[n].checked_sub(pair.iter().filter(|i| **i == n).count())?).ok())
                    .collect();
                let rest: f64 = left?.into_iter().zip(z).map(|(power, z)| z.powi(power)).product();
                let half = if pair[0] == pair[1] { 1.0 } else { 2.0 };
                Some(rest / (half * (square(pair[0]) * square(pair[1])).sqrt()))
            });
            bounds.fold(f64::INFINITY, f64::min)
        };
        let mut share = 0.0;
        for block in &self.blocks {
            for (monomial, c) in MONOMIALS[block.first..]
                .iter()
                .zip(&block.coefficients)
                .filter(|(_, c)| **c != 0.0)
            {
                let ([a, b], [s, d]) = (*monomial, block.powers);
                share += c.abs() * term([a, b, s, d]);
            }
        }
        share
    }
}
