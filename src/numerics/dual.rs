//! Dual numbers: a value and its derivatives in `L` directions.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::numerics::{Scalar, angle};

/// `value + Σ derivative[l] ε_l`, `ε_l ε_m = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const L: usize> {
    /// Value.
    pub value: f64,
    /// Derivatives.
    pub derivative: [f64; L],
}

impl<const L: usize> Dual<L> {
    /// `f(value)` with slope `slope`.
    #[inline(always)]
    fn chain(self, value: f64, slope: f64) -> Self {
        let mut derivative = self.derivative;
        for d in &mut derivative {
            *d *= slope;
        }
        Self { value, derivative }
    }

    /// `a self' + b other'` with the given value.
    #[inline(always)]
    fn combine(self, other: Self, value: f64, a: f64, b: f64) -> Self {
        let mut derivative = [0.0; L];
        for (l, d) in derivative.iter_mut().enumerate() {
            *d = a * self.derivative[l] + b * other.derivative[l];
        }
        Self { value, derivative }
    }
}

impl<const L: usize> Add for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl<const L: usize> Sub for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl<const L: usize> Mul for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.combine(other, self.value * other.value, other.value, self.value)
    }
}

impl<const L: usize> Div for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let reciprocal = 1.0 / other.value;
        let value = self.value * reciprocal;
        self.combine(other, value, reciprocal, -value * reciprocal)
    }
}

impl<const L: usize> Neg for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl<const L: usize> Add<f64> for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: f64) -> Self {
        self.value += other;
        self
    }
}

impl<const L: usize> Sub<f64> for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: f64) -> Self {
        self.value -= other;
        self
    }
}

impl<const L: usize> Mul<f64> for Dual<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl<const L: usize> AddAssign for Dual<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        for (d, o) in self.derivative.iter_mut().zip(&other.derivative) {
            *d += o;
        }
    }
}

impl<const L: usize> SubAssign for Dual<L> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.value -= other.value;
        for (d, o) in self.derivative.iter_mut().zip(&other.derivative) {
            *d -= o;
        }
    }
}

impl<const L: usize> Scalar for Dual<L> {
    #[inline(always)]
    fn value(&self) -> Option<f64> {
        Some(self.value)
    }
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self {
            value,
            derivative: [0.0; L],
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let angle = angle::atan2(self.value, x.value);
        let per_square = 1.0 / (self.value * self.value + x.value * x.value);
        self.combine(x, angle, x.value * per_square, -self.value * per_square)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
    #[inline(always)]
    fn lift(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        let (value, slope) = function(self.value);
        self.chain(value, slope)
    }
    #[inline(always)]
    fn lift_with(self, other: Self, function: impl Fn(f64, f64) -> (f64, [f64; 2])) -> Self {
        let (value, [slope, of_other]) = function(self.value, other.value);
        self.combine(other, value, slope, of_other)
    }
}
