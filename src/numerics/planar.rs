//! Vectors in the plane of motion.

use std::ops::{Add, AddAssign, Index, IndexMut, Mul, Neg, Sub, SubAssign};

use super::Scalar;

/// A vector with the components x across and z along the straight beam; `v[0]` is x, `v[1]` is z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planar<T> {
    /// Across.
    pub x: T,
    /// Along.
    pub z: T,
}

impl<T: Scalar> Planar<T> {
    /// Vector of two components.
    #[inline(always)]
    pub fn new(x: T, z: T) -> Self {
        Self { x, z }
    }

    /// Vector of constants.
    #[inline(always)]
    pub fn constant(v: Planar<f64>) -> Self {
        Self::new(T::constant(v.x), T::constant(v.z))
    }

    /// Zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(T::zero(), T::zero())
    }

    /// `(sin φ, cos φ)`: unit tangent at the angle φ.
    #[inline(always)]
    pub fn tangent(angle: T) -> Self {
        let (x, z) = angle.sin_cos();
        Self { x, z }
    }

    /// `(-z, x)`: the normal `e_n` for a tangent `e_t`.
    #[inline(always)]
    pub fn normal(self) -> Self {
        Self::new(-self.z, self.x)
    }

    /// Vector with these components along axes that are turned to `direction`, `(sin φ, cos φ)`.
    #[inline(always)]
    pub fn turned<D: Copy>(self, direction: Planar<D>) -> Self
    where
        T: Mul<D, Output = T>,
    {
        Self::new(
            self.x * direction.z + self.z * direction.x,
            self.z * direction.z - self.x * direction.x,
        )
    }

    /// Components along axes that are turned to `direction`, the inverse of [`Planar::turned`].
    #[inline(always)]
    pub fn turned_back<D: Copy>(self, direction: Planar<D>) -> Self
    where
        T: Mul<D, Output = T>,
    {
        Self::new(
            self.x * direction.z - self.z * direction.x,
            self.z * direction.z + self.x * direction.x,
        )
    }

    /// This vector times `factor`.
    #[inline(always)]
    pub fn times(self, factor: T) -> Self {
        Self::new(self.x * factor, self.z * factor)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.z * other.z
    }

    /// Cross product, positive if `to` turns from this vector in the sense of growing φ: `to.x self.z - to.z self.x`.
    #[inline(always)]
    pub fn cross(self, to: Self) -> T {
        to.x * self.z - to.z * self.x
    }

    /// Squared length.
    #[inline(always)]
    pub fn squared(self) -> T {
        self.x.squared() + self.z.squared()
    }

    /// Unit vector in its direction.
    #[inline(always)]
    pub fn unit(self) -> Self {
        self.times(T::constant(1.0) / self.squared().sqrt())
    }

    /// Angle to another vector, in `(-π, π]`.
    #[inline(always)]
    pub fn angle_to(self, to: Self) -> T {
        self.cross(to).atan2(to.z * self.z + to.x * self.x)
    }
}

impl<T> Index<usize> for Planar<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, axis: usize) -> &T {
        if axis == 0 { &self.x } else { &self.z }
    }
}

impl<T> IndexMut<usize> for Planar<T> {
    #[inline(always)]
    fn index_mut(&mut self, axis: usize) -> &mut T {
        if axis == 0 { &mut self.x } else { &mut self.z }
    }
}

impl<T: Scalar> Add for Planar<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.z + other.z)
    }
}

impl<T: Scalar> Sub for Planar<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.z - other.z)
    }
}

impl<T: Scalar> Neg for Planar<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.z)
    }
}

impl<T: Scalar> Mul<f64> for Planar<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.z * factor)
    }
}

impl<T: Scalar> AddAssign for Planar<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.x += other.x;
        self.z += other.z;
    }
}

impl<T: Scalar> SubAssign for Planar<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        self.x -= other.x;
        self.z -= other.z;
    }
}
