//! Gauss-Legendre quadrature.

use std::f64::consts::PI;

/// Points in [0, 1] and weights that sum to 1.
#[derive(Clone, Debug)]
pub struct Gauss {
    points: Vec<(f64, f64)>,
}

impl Gauss {
    /// Rule of `n` points, exact for polynomials of degree `2 n - 1`. The points are zeros of the Legendre polynomial,
    /// by Newton's iteration (Press et al., Numerical Recipes, 4.6).
    pub fn new(n: usize) -> Self {
        let order = n as f64;
        let zero = |k: usize| {
            let mut z = (PI * (k as f64 + 0.75) / (order + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (value, rate) = legendre(n, z);
                slope = rate;
                let step = value / rate;
                z -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 - z), 1.0 / ((1.0 - z * z) * slope * slope))
        };
        Self {
            points: (0..n).map(zero).collect(),
        }
    }

    /// Points and weights on [a, b].
    pub fn on(&self, a: f64, b: f64) -> impl Iterator<Item = (f64, f64)> {
        let length = b - a;
        self.points
            .iter()
            .map(move |(t, weight)| (a + length * t, length * weight))
    }
}

/// Legendre polynomial of degree `n` and its derivative, inside (-1, 1).
fn legendre(n: usize, z: f64) -> (f64, f64) {
    let (mut before, mut value) = (0.0, 1.0);
    for k in 0..n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * z * value - k * before) / (k + 1.0));
    }
    (value, n as f64 * (z * value - before) / (z * z - 1.0))
}
