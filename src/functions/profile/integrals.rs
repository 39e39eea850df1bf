//! Exact integrals of a profile over an interval, weighted with 1, t and t^2.

use std::f64::consts::{PI, TAU};

use super::waves::Waves;
use super::{Polynomial, Profile, Wave};
use crate::functions::curve::Interpolation;
use crate::numerics::gauss::Gauss;

/// Half waves in a piece above which waves are integrated in closed form.
const HALF_WAVES: f64 = 64.0;

/// Largest number of half waves in a piece for quadrature without closed form.
const MOST_HALF_WAVES: f64 = 65_536.0;

/// Points of the largest rule, which is exact to degree 127.
const MOST_POINTS: usize = 64;

/// A profile with data for its integration: the knots between its smooth pieces, and its form there.
///
/// Between two knots a profile is a sum of polynomials times waves. Gauss quadrature integrates polynomials exactly.
/// With ten additional points it integrates half a wave to machine precision: its error is of the order
/// `(pi/2)^20/20!^2`. Large numbers of waves are integrated by parts.
#[derive(Clone, Debug)]
pub struct Integrals<'a> {
    profile: &'a Profile,
    knots: Vec<f64>,
    /// Largest phase rate of the waves with respect to x [rad].
    turning: f64,
    rule: Gauss,
    /// Pieces required by the degree alone.
    parts: f64,
}

impl<'a> Integrals<'a> {
    /// Integrals of a profile.
    pub fn new(profile: &'a Profile) -> Self {
        let mut knots = vec![];
        profile.add_knots(&mut knots);
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        let (degree, turning) = profile.character();
        let waves = if turning > 0.0 { 10 } else { 0 };
        let points = (degree / 2 + 2 + waves).min(MOST_POINTS);
        Self {
            profile,
            knots,
            turning,
            rule: Gauss::new(points),
            parts: (degree as f64 / (2 * MOST_POINTS - 24) as f64).ceil().max(1.0),
        }
    }

    /// `∫ f dx`, `∫ f t dx` and `∫ f t^2 dx` over [a, b], `t = (x - a)/(b - a)`.
    pub fn moments(&self, a: f64, b: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        self.each_piece(a, b, |p, q| {
            let (from, share) = ((p - a) / (b - a), (q - p) / (b - a));
            let [m0, m1, m2] = self.piece(p, q);
            sum[0] += m0;
            sum[1] += from * m0 + share * m1;
            sum[2] += from * from * m0 + 2.0 * from * share * m1 + share * share * m2;
        });
        sum
    }

    /// Integrals over [a, b] weighted with the two hat functions that are 1 at `a` and at `b`.
    pub fn hats(&self, a: f64, b: f64) -> (f64, f64) {
        let [whole, right, _] = self.moments(a, b);
        (whole - right, right)
    }

    /// Mean over [a, b].
    pub fn mean(&self, a: f64, b: f64) -> f64 {
        self.profile
            .uniform()
            .unwrap_or_else(|| self.moments(a, b)[0] / (b - a))
    }

    /// Largest number of half waves in an interval of the given length.
    pub fn half_waves(&self, length: f64) -> f64 {
        self.turning * length / PI
    }

    /// Knots inside (a, b).
    pub fn knots_in(&self, a: f64, b: f64) -> &[f64] {
        let first = self.knots.partition_point(|knot| *knot <= a);
        let end = self.knots.partition_point(|knot| *knot < b);
        &self.knots[first..end.max(first)]
    }

    /// Calls `smooth` for every interval between two knots of [a, b].
    fn each_piece(&self, a: f64, b: f64, mut smooth: impl FnMut(f64, f64)) {
        let mut from = a;
        for &knot in self.knots_in(a, b) {
            smooth(from, knot);
            from = knot;
        }
        smooth(from, b);
    }

    /// Moments over an interval without knots.
    fn piece(&self, p: f64, q: f64) -> [f64; 3] {
        let half_waves = self.half_waves(q - p);
        if half_waves > HALF_WAVES
            && let Some(waves) = Waves::decompose(self.profile, p, q)
        {
            return waves.moments().map(|m| (q - p) * m);
        }
        let parts = half_waves.min(MOST_HALF_WAVES).ceil().max(self.parts);
        let mut sum = [0.0; 3];
        let step = (q - p) / parts;
        for k in 0..parts as usize {
            let from = p + step * k as f64;
            for (x, weight) in self.rule.on(from, from + step) {
                let (value, t) = (weight * self.profile.value(x), (x - p) / (q - p));
                sum[0] += value;
                sum[1] += value * t;
                sum[2] += value * t * t;
            }
        }
        sum
    }
}

impl Profile {
    /// Value of a uniform profile; none for others.
    pub fn uniform(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Cosine(wave) | Self::Sine(wave) => {
                (wave.amplitude == 0.0 || wave.waves == 0.0).then(|| self.value(0.0))
            }
            Self::Linear([root, tip]) => (root == tip).then_some(*root),
            Self::Polynomial(Polynomial { coefficients }) => {
                coefficients.iter().skip(1).all(|c| *c == 0.0).then(|| self.value(0.0))
            }
            Self::Table(table) => table.curve.is_constant().then(|| self.value(0.0)),
            Self::Sum(terms) => terms.iter().map(Self::uniform).sum(),
            Self::Product(factors) => factors.iter().map(Self::uniform).product(),
        }
    }

    /// Appends the places where the profile is not smooth.
    fn add_knots(&self, knots: &mut Vec<f64>) {
        match self {
            Self::Constant(_) | Self::Cosine(_) | Self::Sine(_) | Self::Linear(_) | Self::Polynomial(_) => {}
            Self::Table(table) => knots.extend(&table.positions),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().for_each(|part| part.add_knots(knots)),
        }
    }

    /// Largest polynomial degree and largest phase rate of the waves with respect to x [rad], between knots.
    fn character(&self) -> (usize, f64) {
        let larger = |(d, r): (usize, f64), (e, s): (usize, f64)| (d.max(e), r.max(s));
        match self {
            Self::Constant(_) => (0, 0.0),
            Self::Cosine(Wave { waves, .. }) | Self::Sine(Wave { waves, .. }) => (0, TAU * waves.abs()),
            Self::Linear(_) => (1, 0.0),
            Self::Polynomial(Polynomial { coefficients }) => (coefficients.len().saturating_sub(1), 0.0),
            Self::Table(table) => match table.interpolation {
                Interpolation::Linear => (1, 0.0),
                Interpolation::Monotone | Interpolation::Cubic => (3, 0.0),
            },
            Self::Sum(terms) => terms.iter().map(Self::character).fold((0, 0.0), larger),
            Self::Product(factors) => factors
                .iter()
                .map(Self::character)
                .fold((0, 0.0), |(d, r), (e, s)| (d + e, r + s)),
        }
    }
}
