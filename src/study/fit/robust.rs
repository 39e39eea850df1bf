//! Loss functions of residuals, and estimates of noise that is not given.
//!
//! ```text
//! u = (model - data)/s         a residual over its standard deviation
//! squares   w = 1
//! huber     w = min(1, k/|u|)              k = 1.345
//! cauchy    w = 1/(1 + (u/c)²)             c = 2.385
//! s² = sum e²/(n - m n/N)                  of a column of n values among N, m numbers fitted; with a loss 1.4826 median |e|
//! ```
//!
//! Both constants preserve 95 % of the efficiency of least squares for normal residuals. Weights are computed again
//! after each fit until they no longer change.

use serde::{Deserialize, Serialize};

/// Loss function of a residual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LossFunction {
    /// Square of the residual.
    #[default]
    Squares,
    /// Square of the residual; beyond some standard deviations, its size (Huber).
    Huber,
    /// Very small weight for large residuals (Cauchy).
    Cauchy,
}

const HUBER: f64 = 1.345;
const CAUCHY: f64 = 2.385;

impl LossFunction {
    /// Weight of a residual of `u` standard deviations.
    pub fn weight(self, u: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::Huber => (HUBER / u.abs()).min(1.0),
            Self::Cauchy => 1.0 / (1.0 + (u / CAUCHY).powi(2)),
        }
    }

    /// Derivative of `w u` with respect to `u`.
    fn slope(self, u: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::Huber => f64::from(u8::from(u.abs() <= HUBER)),
            Self::Cauchy => {
                let q = (u / CAUCHY).powi(2);
                (1.0 - q) / (1.0 + q).powi(2)
            }
        }
    }

    /// Ratio of the variance of estimates to that of least squares with unit noise: `sum (w u)²/(N - m)` over the
    /// square of the mean slope (Huber, 1973).
    pub fn variance(self, residuals: &[f64], numbers: usize) -> f64 {
        let freedom = residuals.len().saturating_sub(numbers).max(1) as f64;
        let squares: f64 = residuals.iter().map(|u| (self.weight(*u) * u).powi(2)).sum();
        let slope = residuals.iter().map(|u| self.slope(*u)).sum::<f64>() / residuals.len() as f64;
        squares / freedom / slope.max(0.05).powi(2)
    }

    /// Standard deviation of the residuals of a column; `lost` is its share of the fitted numbers.
    pub fn deviation(self, errors: &[f64], lost: f64) -> f64 {
        let count = errors.len() as f64;
        let freedom = (count - lost).max(0.5 * count.min(1.0));
        match self {
            Self::Squares => (errors.iter().map(|e| e * e).sum::<f64>() / freedom).sqrt(),
            _ => {
                let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
                sizes.sort_by(f64::total_cmp);
                let middle = sizes.len() / 2;
                let median = match sizes.len() % 2 {
                    1 => sizes[middle],
                    _ => 0.5 * (sizes[middle - 1] + sizes[middle]),
                };
                1.4826 * median * (count / freedom).sqrt()
            }
        }
    }
}
