//! Number types for the equations: `f64` for the residual, dual numbers for its derivatives, and a tracer for its
//! sparsity pattern.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number, or a type with its arithmetic.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + AddAssign
    + SubAssign
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// Its value; none for a number that only records what it depends on.
    fn value(&self) -> Option<f64>;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Angle of the vector `(x, self)`.
    fn atan2(self, x: Self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Applies a function given by value and derivative.
    fn lift(self, function: impl Fn(f64) -> (f64, f64)) -> Self;
    /// Applies a function of two numbers, given by value and both derivatives.
    fn lift_with(self, other: Self, function: impl Fn(f64, f64) -> (f64, [f64; 2])) -> Self;
    /// Zero.
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// Square.
    fn squared(self) -> Self {
        self * self
    }
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn value(&self) -> Option<f64> {
        Some(*self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        super::angle::atan2(self, x)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline(always)]
    fn lift(self, function: impl Fn(f64) -> (f64, f64)) -> Self {
        function(self).0
    }
    #[inline(always)]
    fn lift_with(self, other: Self, function: impl Fn(f64, f64) -> (f64, [f64; 2])) -> Self {
        function(self, other).0
    }
}
