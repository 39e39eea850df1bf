//! Numbers with first and second derivatives by the five entries of the deformation gradient.

use std::ops::{Add, Mul, Sub};

/// Entries: zz, zx, xz, xx, yy.
pub const N: usize = 5;

/// A value with gradient and Hessian.
#[derive(Debug, Clone, Copy)]
pub struct Jet {
    /// Value.
    pub v: f64,
    /// Gradient.
    pub g: [f64; N],
    /// Hessian, symmetric.
    pub h: [[f64; N]; N],
}

impl Jet {
    /// A constant.
    pub fn constant(v: f64) -> Self {
        Self {
            v,
            g: [0.0; N],
            h: [[0.0; N]; N],
        }
    }

    /// The k-th variable.
    pub fn variable(k: usize, v: f64) -> Self {
        let mut jet = Self::constant(v);
        jet.g[k] = 1.0;
        jet
    }

    /// f(self), from f and its first two derivatives at the value.
    pub fn chain(&self, [f, f1, f2]: [f64; 3]) -> Self {
        let mut out = Self::constant(f);
        for i in 0..N {
            out.g[i] = f1 * self.g[i];
            for j in 0..N {
                out.h[i][j] = f1 * self.h[i][j] + f2 * self.g[i] * self.g[j];
            }
        }
        out
    }

    /// Power of self; the value must be positive.
    pub fn power(&self, p: f64) -> Self {
        let f = self.v.powf(p);
        self.chain([f, p * f / self.v, p * (p - 1.0) * f / (self.v * self.v)])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(mut self, o: Self) -> Self {
        self.v += o.v;
        for i in 0..N {
            self.g[i] += o.g[i];
            for j in 0..N {
                self.h[i][j] += o.h[i][j];
            }
        }
        self
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + o * -1.0
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        self.chain([k * self.v, k, 0.0])
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let mut out = Self::constant(self.v * o.v);
        for i in 0..N {
            out.g[i] = self.v * o.g[i] + o.v * self.g[i];
            for j in 0..N {
                out.h[i][j] = self.v * o.h[i][j] + o.v * self.h[i][j] + self.g[i] * o.g[j] + o.g[i] * self.g[j];
            }
        }
        out
    }
}
