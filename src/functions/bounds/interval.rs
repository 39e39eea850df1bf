//! Intervals of numbers, and of values with their derivatives, with the rules of calculus.

use crate::functions::jet::Jet;

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Least.
    pub low: f64,
    /// Largest.
    pub high: f64,
}

impl Interval {
    /// Holds nothing.
    pub const EMPTY: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    /// One number.
    pub fn point(x: f64) -> Self {
        Self::between(x, x)
    }

    /// Between two numbers, in any order; everything where one of them is none.
    pub fn between(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            };
        }
        Self {
            low: a.min(b),
            high: a.max(b),
        }
    }

    /// Largest magnitude.
    pub fn size(self) -> f64 {
        self.high.max(-self.low)
    }

    /// Least magnitude.
    pub fn least(self) -> f64 {
        self.low.max(-self.high).max(0.0)
    }

    /// Least interval that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// What both hold of a number that both hold; round-off may part them, then the other counts.
    pub fn narrowed(self, other: Self) -> Self {
        let both = Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        };
        if both.low <= both.high { both } else { other }
    }

    /// `factor` times this.
    pub fn scaled(self, factor: f64) -> Self {
        Self::between(factor * self.low, factor * self.high)
    }

    /// Wider by a part of its size, which covers round-off.
    pub fn widened(self, part: f64) -> Self {
        let more = part * self.size();
        Self {
            low: self.low - more,
            high: self.high + more,
        }
    }
}

impl std::ops::Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (low, high) = (self.low + other.low, self.high + other.high);
        // infinities that meet
        Self {
            low: if low.is_nan() { f64::NEG_INFINITY } else { low },
            high: if high.is_nan() { f64::INFINITY } else { high },
        }
    }
}

impl std::ops::Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let a = Self::between(self.low * other.low, self.high * other.high);
        a.hull(Self::between(self.low * other.high, self.high * other.low))
    }
}

/// Value and first three derivatives, each somewhere in its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span(pub [Interval; 4]);

impl Span {
    /// Holds nothing.
    pub const EMPTY: Self = Self([Interval::EMPTY; 4]);

    /// Of a sum.
    pub fn sum(terms: impl Iterator<Item = Self>) -> Self {
        terms.reduce(|a, b| a + b).unwrap_or(Self::at(Jet::default()))
    }

    /// Of a product.
    pub fn product(factors: impl Iterator<Item = Self>) -> Self {
        factors.reduce(|a, b| a * b).unwrap_or(Self::at(Jet::constant(1.0)))
    }

    /// One instant.
    pub fn at(jet: Jet) -> Self {
        Self([jet.value, jet.rate, jet.acceleration, jet.jerk].map(Interval::point))
    }

    /// Least span that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].hull(other.0[k])))
    }

    /// Narrower by what the ends and the middle of the piece `[a, b]` of a function tell, whose second derivative is continuous
    /// there: a derivative that keeps its sign leaves the ends, else Taylor's formula about the middle.
    pub fn told(self, [first, middle, last]: [Jet; 3], half: f64) -> Self {
        let [value, rate, acceleration, jerk] = self.0;
        let around = Interval { low: -half, high: half };
        let bend = Interval {
            low: 0.0,
            high: 0.5 * half * half,
        };
        let keeps = |i: Interval| i.low >= 0.0 || i.high <= 0.0;
        let acceleration = acceleration.narrowed(if keeps(jerk) {
            Interval::between(first.acceleration, last.acceleration)
        } else {
            Interval::point(middle.acceleration) + jerk * around
        });
        let rate = rate.narrowed(if keeps(acceleration) {
            Interval::between(first.rate, last.rate)
        } else {
            Interval::point(middle.rate) + (Interval::point(middle.acceleration) * around) + jerk * bend
        });
        let value = value.narrowed(if keeps(rate) {
            Interval::between(first.value, last.value)
        } else {
            Interval::point(middle.value) + Interval::point(middle.rate) * around + acceleration * bend
        });
        Self([value, rate, acceleration, jerk])
    }
}

impl std::ops::Add for Span {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

/// Leibniz' rule, as for [`Jet`].
impl std::ops::Mul for Span {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let ([a0, a1, a2, a3], [b0, b1, b2, b3]) = (self.0, other.0);
        Self([
            a0 * b0,
            a1 * b0 + a0 * b1,
            a2 * b0 + (a1 * b1).scaled(2.0) + a0 * b2,
            a3 * b0 + (a2 * b1 + a1 * b2).scaled(3.0) + a0 * b3,
        ])
    }
}

/// A function of one variable that can be bounded: piecewise smooth, its pieces parted by breaks.
pub trait Bounded {
    /// Values and derivatives at `x`, on the branch that holds at `within`.
    fn exactly(&self, x: f64, within: f64) -> Jet;

    /// All values and derivatives on every branch that `[from, to]` touches inside.
    fn span(&self, from: f64, to: f64) -> Span;

    /// Whether [`Self::span`] is as narrow as it can be.
    fn is_elementary(&self) -> bool;

    /// Appends breaks in any order, at least those up to `to`.
    fn parted(&self, to: f64, out: &mut Vec<f64>);

    /// Appends breaks, and joins at which only the third derivative jumps.
    fn joined(&self, to: f64, out: &mut Vec<f64>) {
        self.parted(to, out);
    }

    /// Calls for places in `[from, to]` where the function may be large.
    fn crests(&self, from: f64, to: f64, visit: &mut dyn FnMut(f64));
}
