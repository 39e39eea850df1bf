//! Intervals of numbers, and of values with derivatives, with the rules of calculus.

use crate::functions::jet::Jet;

/// Closed interval from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Empty interval.
    pub const EMPTY: Self = Self {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    /// Interval of one number.
    pub fn point(x: f64) -> Self {
        Self::between(x, x)
    }

    /// Interval between two numbers in any order; the whole line if one is NaN.
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

    /// Smallest magnitude.
    pub fn least(self) -> f64 {
        self.low.max(-self.high).max(0.0)
    }

    /// Smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Intersection of two enclosures of the same number; `other` if rounding errors make it empty.
    pub fn narrowed(self, other: Self) -> Self {
        let both = Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        };
        if both.low <= both.high { both } else { other }
    }

    /// Interval times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Self::between(factor * self.low, factor * self.high)
    }

    /// Interval widened by a fraction of its size, to cover rounding errors.
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
        // sum of opposite infinities
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

/// Enclosures of a value and its first three derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JetSpan(pub [Interval; 4]);

impl JetSpan {
    /// Empty span.
    pub const EMPTY: Self = Self([Interval::EMPTY; 4]);

    /// Span of a sum.
    pub fn sum(terms: impl Iterator<Item = Self>) -> Self {
        terms.reduce(|a, b| a + b).unwrap_or(Self::at(Jet::default()))
    }

    /// Span of a product.
    pub fn product(factors: impl Iterator<Item = Self>) -> Self {
        factors.reduce(|a, b| a * b).unwrap_or(Self::at(Jet::constant(1.0)))
    }

    /// Span of one instant.
    pub fn at(jet: Jet) -> Self {
        Self([jet.value, jet.rate, jet.acceleration, jet.jerk].map(Interval::point))
    }

    /// Smallest span that contains both.
    pub fn hull(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k].hull(other.0[k])))
    }

    /// Narrows the span of a piece `[a, b]` by the function at its ends and middle; the second derivative must be
    /// continuous there. A quantity with a derivative of constant sign is between its end values; others use Taylor's
    /// formula about the middle.
    pub fn narrowed_by(self, [first, middle, last]: [Jet; 3], half: f64) -> Self {
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

impl std::ops::Add for JetSpan {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

/// Leibniz rule, as for [`Jet`].
impl std::ops::Mul for JetSpan {
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

/// A piecewise smooth function of one variable with enclosures. Breaks separate its pieces.
pub trait Bounded {
    /// Value and derivatives at `x`, on the branch that contains `within`.
    fn exactly(&self, x: f64, within: f64) -> Jet;

    /// Encloses values and derivatives on every branch inside `[from, to]`.
    fn span(&self, from: f64, to: f64) -> JetSpan;

    /// True if [`Self::span`] is as narrow as possible.
    fn is_elementary(&self) -> bool;

    /// Appends breaks in any order, at least those up to `to`.
    fn parted(&self, to: f64, out: &mut Vec<f64>);

    /// Appends breaks, and points where only the third derivative jumps.
    fn joined(&self, to: f64, out: &mut Vec<f64>) {
        self.parted(to, out);
    }

    /// Visits places in `[from, to]` where the function may be large.
    fn crests(&self, from: f64, to: f64, visit: &mut dyn FnMut(f64));
}
