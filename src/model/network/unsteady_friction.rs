//! Unsteady friction: a passive network of resistances and inertances in parallel.

/// Rates `n_i` and weights `m_i` of Kagawa et al. (Trans. JSME B 49, 1983) for Zielke's weighting function,
/// `W(τ) = Σ m_i exp(-n_i τ)`.
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

/// `[E72]` The branches of [E51] for a duct of any cross-section, with area A, perimeter P and `r = 2A/P`. β is the
/// momentum factor of its steady profile, [E73]:
///
/// ```text
/// r_i = √b (8 μ l/(A r²)) m_i/2        rates b n_i ν/r²        b = 1/(9 (β - 1)²)
/// ```
///
/// Both limits are exact. For slow changes the inertance is β times that of plug flow. For fast changes friction is
/// that of the wall layer, `P √(ρ μ iω)/A²` per length. A round duct has β = 4/3, b = 1. The impedance of rectangles of
/// any aspect ratio is accurate to 0.7 % up to `r √(ω/ν) = 100`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ladder {
    /// `√b 8 μ l/(A r²)` [Pa s/m^3].
    resistance: f64,
    /// `b ν/r²` [1/s].
    rate: f64,
}

impl Ladder {
    /// Ladder of a round duct with its laminar resistance [Pa s/m^3] and `ν/r²` [1/s].
    pub fn round(resistance: f64, rate: f64) -> Self {
        Self { resistance, rate }
    }

    /// Ladder of a duct with momentum factor β, `8 μ l/(A r²)` [Pa s/m^3] and `ν/r²` [1/s], `r = 2A/P`.
    pub fn of_profile(momentum: f64, resistance: f64, rate: f64) -> Self {
        let faster = (3.0 * (momentum - 1.0)).recip();
        Self {
            resistance: faster * resistance,
            rate: faster * faster * rate,
        }
    }

    /// Ladder of a fraction of the length.
    pub fn over(self, part: f64) -> Self {
        Self {
            resistance: part * self.resistance,
            ..self
        }
    }

    /// Resistances [Pa s/m^3] and rates [1/s] of the branches.
    pub fn branches(self) -> impl Iterator<Item = (f64, f64)> {
        KAGAWA
            .iter()
            .map(move |(n, m)| (0.5 * m * self.resistance, n * self.rate))
    }
}
