//! Roots of equations in the complex plane.

use nalgebra::Complex;

/// A root near a guess, by secants.
pub fn root(f: impl Fn(Complex<f64>) -> Complex<f64>, guess: Complex<f64>) -> Complex<f64> {
    let (mut a, mut b) = (guess * 1.001, guess);
    for _ in 0..30 {
        let (at_a, at_b) = (f(a), f(b));
        if (at_b - at_a).norm() == 0.0 {
            break;
        }
        (a, b) = (b, b - at_b * (b - a) / (at_b - at_a));
    }
    b
}
