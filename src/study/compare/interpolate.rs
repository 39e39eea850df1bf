//! Cubic interpolation between samples.

/// Weights of the samples around a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// First sample.
    pub first: usize,
    /// Weights of this sample and the following ones; zero for unused ones.
    pub weights: [f64; 4],
}

impl Weights {
    /// Returns the weights that select the sample `k`.
    pub fn exactly(k: usize) -> Self {
        Self {
            first: k,
            weights: [1.0, 0.0, 0.0, 0.0],
        }
    }

    /// True if a single sample is selected.
    pub fn is_exact(&self) -> bool {
        self.weights.iter().filter(|w| **w != 0.0).count() == 1
    }

    /// Returns the weighted mean of values.
    pub fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        let used = self.weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
        used.map(|(k, w)| w * value(self.first + k)).sum()
    }
}

/// Distance from a sample, as a share of the interval, below which the sample itself is used: such times differ by
/// rounding errors only.
const SAME: f64 = 1e-7;

/// Index of the interval of `xs` that contains `x`; the first or last one beyond the ends. Needs at least two samples.
pub fn interval(xs: &[f64], x: f64) -> usize {
    xs.partition_point(|s| *s <= x).clamp(1, xs.len() - 1) - 1
}

/// Weights of the polynomial through the four samples around `x` (fewer if there are fewer); exact for cubics.
pub fn cubic(xs: &[f64], x: f64) -> Weights {
    if xs.len() < 2 {
        return Weights::exactly(0);
    }
    let k = interval(xs, x);
    let width = xs[k + 1] - xs[k];
    for sample in [k, k + 1] {
        if (x - xs[sample]).abs() <= SAME * width {
            return Weights::exactly(sample);
        }
    }
    let count = xs.len().min(4);
    let first = k.saturating_sub(1).min(xs.len() - count);
    let mut weights = [0.0; 4];
    for (i, weight) in weights.iter_mut().enumerate().take(count) {
        let others = (0..count).filter(|j| *j != i);
        *weight = others
            .map(|j| (x - xs[first + j]) / (xs[first + i] - xs[first + j]))
            .product();
    }
    Weights { first, weights }
}

/// Weights of a cubic Hermite polynomial at the share `s` of an interval of width `h`: of the two values, then of the
/// two slopes.
pub fn hermite(s: f64, h: f64) -> [f64; 4] {
    let (s2, s3) = (s * s, s * s * s);
    [
        2.0 * s3 - 3.0 * s2 + 1.0,
        3.0 * s2 - 2.0 * s3,
        h * (s3 - 2.0 * s2 + s),
        h * (s3 - s2),
    ]
}

/// Monotone cubic interpolation (Fritsch and Carlson 1980, slopes after Brodlie): no extrema except those of the
/// samples. For data with jumps and kinks along the coordinate.
pub fn monotone(xs: &[f64], ys: &[f64], x: f64) -> f64 {
    if xs.len() < 2 {
        return ys.first().copied().unwrap_or(f64::NAN);
    }
    let k = interval(xs, x);
    let step = |i: usize| (ys[i + 1] - ys[i]) / (xs[i + 1] - xs[i]);
    let slope = |i: usize| {
        if i == 0 {
            return step(0);
        }
        if i + 1 == xs.len() {
            return step(i - 1);
        }
        let (before, after) = (step(i - 1), step(i));
        if before * after <= 0.0 {
            return 0.0;
        }
        let (h0, h1) = (xs[i] - xs[i - 1], xs[i + 1] - xs[i]);
        let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
        (w0 + w1) / (w0 / before + w1 / after)
    };
    let h = xs[k + 1] - xs[k];
    let s = ((x - xs[k]) / h).clamp(0.0, 1.0);
    let w = hermite(s, h);
    w[0] * ys[k] + w[1] * ys[k + 1] + w[2] * slope(k) + w[3] * slope(k + 1)
}
