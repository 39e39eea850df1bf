//! Growth rates, frequencies, zeros and limits from samples.

use std::f64::consts::TAU;

use crate::error::Result;

/// Limit `h -> 0` from values at `2h` and `h` with a second-order error.
pub fn richardson(coarse: f64, fine: f64) -> f64 {
    fine + (fine - coarse) / 3.0
}

/// Zero of a function near two places, by the secant method.
pub fn secant([mut a, mut b]: [f64; 2], value: impl Fn(f64) -> Result<f64>) -> Result<f64> {
    let mut at_a = value(a)?;
    for _ in 0..8 {
        let at_b = value(b)?;
        let next = b - at_b * (b - a) / (at_b - at_a);
        (a, at_a, b) = (b, at_b, next);
        if (b - a).abs() < 1e-8 {
            break;
        }
    }
    Ok(b)
}

/// Growth rate and angular frequency [1/s] of samples of an exponentially growing or decaying oscillation, `interval`
/// apart. Fits `x_{k+1} = a x_k + b x_{k-1}` with `a = 2 e^{σ Δ} cos(ω Δ)`, `b = -e^{2 σ Δ}` by least squares (Prony).
pub fn oscillation(samples: &[f64], interval: f64) -> (f64, f64) {
    let (mut uu, mut uv, mut vv, mut ux, mut vx) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for w in samples.windows(3) {
        let (v, u, x) = (w[0], w[1], w[2]);
        uu += u * u;
        uv += u * v;
        vv += v * v;
        ux += u * x;
        vx += v * x;
    }
    let determinant = uu * vv - uv * uv;
    let a = (ux * vv - vx * uv) / determinant;
    let b = (vx * uu - ux * uv) / determinant;
    let radius = (-b).sqrt();
    (radius.ln() / interval, (0.5 * a / radius).acos() / interval)
}

/// Slope of the least-squares line through points.
pub fn slope(x: &[f64], y: &[f64]) -> f64 {
    let count = x.len() as f64;
    let (mx, my) = (x.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
    let top: f64 = x.iter().zip(y).map(|(x, y)| (x - mx) * (y - my)).sum();
    top / x.iter().map(|x| (x - mx) * (x - mx)).sum::<f64>()
}

/// Growth rate of the largest magnitude in consecutive spans of `span` samples, without the first `skipped` spans.
pub fn growth_of_spans(samples: &[f64], span: usize, interval: f64, skipped: usize) -> f64 {
    let (times, logs): (Vec<f64>, Vec<f64>) = samples
        .chunks_exact(span)
        .enumerate()
        .skip(skipped)
        .map(|(k, part)| {
            let largest = part.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            ((k * span) as f64 * interval, largest.ln())
        })
        .unzip();
    slope(&times, &logs)
}

/// Mean under the weight `1 - cos`, which suppresses an oscillation even if its periods do not fit the samples.
pub fn smooth_mean(samples: &[f64]) -> f64 {
    let count = samples.len() as f64;
    let weight = |k: usize| 1.0 - (TAU * (k as f64 + 0.5) / count).cos();
    samples.iter().enumerate().map(|(k, x)| weight(k) * x).sum::<f64>() / count
}

/// Lowest value of a smooth function from samples, by the parabola through the three samples around the minimum.
pub fn minimum(samples: &[f64]) -> f64 {
    let lowest = samples.windows(3).min_by(|a, b| a[1].total_cmp(&b[1]));
    let Some(&[a, b, c]) = lowest else { return f64::NAN };
    b - 0.125 * (c - a) * (c - a) / (a - 2.0 * b + c)
}
