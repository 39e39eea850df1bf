//! Friction with a memory: a passive network of resistances beside inertances.

/// Rates `n_i` and weights `m_i` of Kagawa et al. (Trans. JSME B 49, 1983) for Zielke's weighting function, `W(τ) = Σ m_i exp(-n_i τ)`.
static KAGAWA: [(f64, f64); BRANCHES] = [
    (26.3744, 1.0),
    (72.8033, 1.16725),
    (187.424, 2.20064),
    (536.626, 3.92861),
    (1570.60, 6.78788),
    (4618.13, 11.6761),
    (13601.1, 20.0612),
    (40082.5, 34.4541),
    (118_153.0, 59.1642),
    (348_316.0, 101.590),
];

/// Branches of a ladder.
pub const BRANCHES: usize = 10;

/// `[E72]` The branches of [E51] for a duct of any section, area A, perimeter P, β the mean of the squared velocity of its steady profile over its
/// mean's square, `r = 2A/P`:
///
/// ```text
/// r_i = √b (8 μ l/(A r²)) m_i/2        rates b n_i ν/r²        b = 1/(9 (β - 1)²)
/// ```
///
/// With that the inertance is β of a plug's where flow changes slowly, and where it changes fast friction is that of the layer at the wall, `P √(ρ μ iω)/A²` a
/// length: both ends are exact. A round duct has β = 4/3, b = 1. Rectangles of all shapes have their impedance to 0.7 % up to `r √(ω/ν) = 100`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ladder {
    /// `√b 8 μ l/(A r²)` [Pa s/m^3].
    resistance: f64,
    /// `b ν/r²` [1/s].
    rate: f64,
}

impl Ladder {
    /// Of a round duct: its laminar resistance [Pa s/m^3] and `ν/r²` [1/s].
    pub fn round(resistance: f64, rate: f64) -> Self {
        Self { resistance, rate }
    }

    /// Of a duct with a steady profile of this β; `8 μ l/(A r²)` [Pa s/m^3] and `ν/r²` [1/s] of `r = 2A/P`.
    pub fn of_profile(momentum: f64, resistance: f64, rate: f64) -> Self {
        let faster = (3.0 * (momentum - 1.0)).recip();
        Self {
            resistance: faster * resistance,
            rate: faster * faster * rate,
        }
    }

    /// Of a part of the length.
    pub fn over(self, part: f64) -> Self {
        Self {
            resistance: part * self.resistance,
            ..self
        }
    }

    /// Resistances [Pa s/m^3] and rates [1/s] of its branches.
    pub fn branches(self) -> impl Iterator<Item = (f64, f64)> {
        KAGAWA
            .iter()
            .map(move |(n, m)| (0.5 * m * self.resistance, n * self.rate))
    }
}
