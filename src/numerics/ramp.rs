//! A ramp with a smooth start.

/// `s(x)` and its slope: 0 below 0, `x²/(2w)` up to w, `x - w/2` beyond.
#[inline]
pub fn ramp(x: f64, width: f64) -> (f64, f64) {
    match x {
        x if x <= 0.0 => (0.0, 0.0),
        x if x < width => (0.5 * x * x / width, x / width),
        x => (x - 0.5 * width, 1.0),
    }
}

/// Integral of [`ramp`] from 0: the energy of a spring of stiffness 1 with this start.
pub fn ramp_integral(x: f64, width: f64) -> f64 {
    match x {
        x if x <= 0.0 => 0.0,
        x if x < width => x * x * x / (6.0 * width),
        x => 0.5 * x * (x - width) + width * width / 6.0,
    }
}
