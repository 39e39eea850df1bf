//! A value and its first three time derivatives as one quantity, with the rules of calculus.

/// Value of a signal with its first three time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// Value.
    pub value: f64,
    /// First derivative [1/s].
    pub rate: f64,
    /// Second derivative [1/s^2].
    pub acceleration: f64,
    /// Third derivative [1/s^3].
    pub jerk: f64,
}

impl Jet {
    /// Jet of a constant.
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            ..Self::default()
        }
    }

    /// This jet times `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            rate: factor * self.rate,
            acceleration: factor * self.acceleration,
            jerk: factor * self.jerk,
        }
    }

    /// `r(s) = 10 s^3 - 15 s^4 + 6 s^5` of `s = (t - start)/duration`, continued beyond [0, 1] by the same formula.
    pub fn smooth_step(t: f64, start: f64, duration: f64) -> Self {
        let (s, n) = ((t - start) / duration, 1.0 / duration);
        Self {
            value: s * s * s * (10.0 + s * (6.0 * s - 15.0)),
            rate: n * 30.0 * s * s * (1.0 - s) * (1.0 - s),
            acceleration: n * n * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
            jerk: n * n * n * 60.0 * (1.0 + 6.0 * s * (s - 1.0)),
        }
    }
}

impl std::ops::Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            rate: self.rate + other.rate,
            acceleration: self.acceleration + other.acceleration,
            jerk: self.jerk + other.jerk,
        }
    }
}

/// Leibniz rule: `(a b)' = a' b + a b'`, `(a b)'' = a'' b + 2 a' b' + a b''`,
/// `(a b)''' = a''' b + 3 a'' b' + 3 a' b'' + a b'''`.
impl std::ops::Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            rate: self.rate * other.value + self.value * other.rate,
            acceleration: self.acceleration * other.value
                + 2.0 * self.rate * other.rate
                + self.value * other.acceleration,
            jerk: self.jerk * other.value
                + 3.0 * (self.acceleration * other.rate + self.rate * other.acceleration)
                + self.value * other.jerk,
        }
    }
}

/// Time, and the smooth interval that contains it.
///
/// Signals with kinks or jumps choose their branch by `within`, an instant between two switching times, and evaluate
/// this branch at `t`. In one interval, including both ends, the model is thus smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothTime {
    /// Time [s].
    pub t: f64,
    /// An instant strictly inside the current smooth interval [s].
    pub within: f64,
}
