//! Linear least squares with covariance.
//!
//! ```text
//! y = X b + e,  b = (X^T X)^-1 X^T y,  s^2 = |y - X b|^2/(n - m),  cov b = s^2 (X^T X)^-1
//! ```

use nalgebra::{DMatrix, DVector};

use super::student_t;

/// A fit: `m` coefficients through `n` points.
#[derive(Clone, Debug, PartialEq)]
pub struct Regression {
    /// Coefficients, in the order of the columns.
    pub coefficients: Vec<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
    /// Residuals of the points.
    pub residuals: Vec<f64>,
    /// Standard deviation of the residuals, s.
    pub deviation: f64,
    /// Degrees of freedom, n - m.
    pub freedom: f64,
}

/// Fits by least squares; none unless there are more points than coefficients and the columns are independent.
pub fn fit(columns: &[Vec<f64>], y: &[f64]) -> Option<Regression> {
    let (n, m) = (y.len(), columns.len());
    if n <= m || m == 0 {
        return None;
    }
    // normalize columns, so that units do not affect rounding errors
    let lengths: Vec<f64> = columns
        .iter()
        .map(|c| c.iter().map(|x| x * x).sum::<f64>().sqrt())
        .collect();
    if lengths.iter().any(|length| !length.is_normal()) {
        return None;
    }
    let matrix = DMatrix::from_fn(n, m, |i, j| columns[j][i] / lengths[j]);
    let (q, r) = matrix.qr().unpack();
    if (0..m).any(|k| r[(k, k)].abs() < 1e-10) {
        return None;
    }
    let scaled = r.solve_upper_triangular(&(q.transpose() * DVector::from_column_slice(y)))?;
    let inverse = r.solve_upper_triangular(&DMatrix::identity(m, m))?;
    let coefficients: Vec<f64> = (0..m).map(|j| scaled[j] / lengths[j]).collect();
    let residuals: Vec<f64> = (0..n)
        .map(|i| {
            y[i] - columns
                .iter()
                .zip(&coefficients)
                .map(|(column, b)| column[i] * b)
                .sum::<f64>()
        })
        .collect();
    let freedom = (n - m) as f64;
    let variance = residuals.iter().map(|e| e * e).sum::<f64>() / freedom;
    let spread = &inverse * inverse.transpose();
    let covariance = DMatrix::from_fn(m, m, |i, j| variance * spread[(i, j)] / (lengths[i] * lengths[j]));
    Some(Regression {
        coefficients,
        covariance,
        residuals,
        deviation: variance.sqrt(),
        freedom,
    })
}

impl Regression {
    /// Standard error of the weighted sum of coefficients.
    pub fn error(&self, weights: &[f64]) -> f64 {
        let w = DVector::from_column_slice(weights);
        (w.transpose() * &self.covariance * &w)[(0, 0)].max(0.0).sqrt()
    }

    /// Weighted sum of coefficients.
    pub fn value(&self, weights: &[f64]) -> f64 {
        weights.iter().zip(&self.coefficients).map(|(w, b)| w * b).sum()
    }

    /// Half width of the 95 % confidence interval of the weighted sum, for normal errors.
    pub fn half_width(&self, weights: &[f64]) -> f64 {
        student_t::quantile(0.05, self.freedom) * self.error(weights)
    }

    /// Probability of a coefficient of at least this size if its true value is zero (p-value of coefficient `k`).
    pub fn chance(&self, k: usize) -> f64 {
        let error = self.covariance[(k, k)].max(0.0).sqrt();
        match (error > 0.0, self.coefficients[k] == 0.0) {
            (true, _) => student_t::two_sided(self.coefficients[k] / error, self.freedom),
            (false, zero) => f64::from(u8::from(zero)),
        }
    }
}
