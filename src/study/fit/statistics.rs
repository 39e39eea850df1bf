//! Errors of estimates from the derivatives at the minimum.
//!
//! ```text
//! cov x = v (J^T J)^-1        x positions between the bounds; v = 1 for given noise, else the variance of residuals
//!        cov p = (dp/dx) cov x (dp/dx)^T
//!        p(x ± q √cov x_kk)          q of Student's distribution, of the normal one where noise is given
//! ```
//!
//! Numbers at a bound count as known. Undetermined numbers have no error. A number has no error either if the data
//! determine it only in combination with one at a bound: its value depends on the choice of that bound.

use nalgebra::{DMatrix, DVector};

use super::identifiability::UndeterminedDirection;
use crate::numerics::{normal, student_t};
use crate::study::search_bounds::ParameterBounds;

/// Errors of estimates.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimateErrors {
    /// Standard errors, in units of the numbers.
    pub standard: Vec<Option<f64>>,
    /// Intervals of 95 %, limited to the bounds.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Covariance.
    pub covariance: Vec<Vec<Option<f64>>>,
    /// Correlation.
    pub correlation: Vec<Vec<Option<f64>>>,
}

/// Input of the error estimate.
pub struct CovarianceInput<'a> {
    /// Numbers and bounds.
    pub spans: &'a [ParameterBounds],
    /// Estimates.
    pub values: &'a [f64],
    /// Indices of the numbers that are not at a bound.
    pub free: &'a [usize],
    /// Directions that the data do not determine.
    pub unseen: &'a [UndeterminedDirection],
    /// Derivatives of the values over their standard deviations, with respect to positions between the bounds.
    pub jacobian: &'a DMatrix<f64>,
    /// `v` of the equations above.
    pub variance: f64,
    /// Degrees of freedom; `None` if the noise is known.
    pub freedom: Option<f64>,
}

impl CovarianceInput<'_> {
    /// Computes the errors of the estimates.
    pub fn errors(&self) -> EstimateErrors {
        let m = self.spans.len();
        let lost = |k: &usize| {
            let at_bound = |one: &UndeterminedDirection| one.numbers.iter().any(|other| !self.free.contains(other));
            let own = self.unseen.iter().filter(|one| one.numbers.contains(k));
            own.into_iter().any(|one| one.entirely || at_bound(one))
        };
        let own: Vec<usize> = self.free.iter().copied().filter(|k| !lost(k)).collect();
        let places = self.covariance_of_places(&own);
        let of = |i: usize, k: usize| {
            let at = |wanted: usize| own.iter().position(|k| *k == wanted);
            Some(places[(at(i)?, at(k)?)])
        };
        let slope = |k: usize| self.spans[k].slope(self.values[k]);
        let q = match self.freedom {
            Some(freedom) => student_t::quantile(0.05, freedom.max(1.0)),
            None => normal::quantile(0.975),
        };
        let interval = |k: usize| {
            let half = q * of(k, k)?.sqrt();
            let (span, place) = (&self.spans[k], self.spans[k].place(self.values[k]));
            Some([place - half, place + half].map(|place| span.value(place.clamp(0.0, 1.0))))
        };
        let table = |value: &dyn Fn(usize, usize) -> Option<f64>| -> Vec<Vec<Option<f64>>> {
            (0..m).map(|i| (0..m).map(|k| value(i, k)).collect()).collect()
        };
        EstimateErrors {
            standard: (0..m).map(|k| Some(of(k, k)?.sqrt() * slope(k).abs())).collect(),
            intervals: (0..m).map(interval).collect(),
            covariance: table(&|i, k| Some(of(i, k)? * slope(i) * slope(k))),
            correlation: table(&|i, k| Some((of(i, k)? / (of(i, i)? * of(k, k)?).sqrt()).clamp(-1.0, 1.0))),
        }
    }

    /// `v (J^T J)^-1`, from singular values of the columns scaled to unit length.
    fn covariance_of_places(&self, own: &[usize]) -> DMatrix<f64> {
        // an empty matrix has no singular values
        if own.is_empty() {
            return DMatrix::zeros(0, 0);
        }
        let mut jacobian = self.jacobian.select_columns(own);
        let lengths: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
        for (mut column, length) in jacobian.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        let svd = jacobian.svd(false, true);
        let Some(v_t) = svd.v_t else {
            return DMatrix::zeros(own.len(), own.len());
        };
        let inverse = DVector::from_iterator(
            svd.singular_values.len(),
            svd.singular_values.iter().map(|s| s.powi(-2)),
        );
        let whole = v_t.transpose() * DMatrix::from_diagonal(&inverse) * v_t;
        DMatrix::from_fn(own.len(), own.len(), |i, k| {
            self.variance * whole[(i, k)] / (lengths[i] * lengths[k])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::fit::identifiability::{IdentificationInput, unseen};

    /// Goal: if the data determine only a product and one factor ends at its bound, the other factor has no interval.
    #[test]
    fn a_factor_beside_one_at_its_bound_has_no_interval() {
        let spans = ["/a", "/b", "/c"].map(|pointer| ParameterBounds {
            pointer: pointer.into(),
            low: 1.0,
            high: 3.0,
        });
        let rows = [[10.0, 10.0, 1.0], [20.0, 20.0, -3.0], [5.0, 5.0, 20.0]];
        let jacobian = DMatrix::from_fn(3, 3, |i, k| rows[i][k]);
        let values = [2.0, 3.0, 2.0];
        let seen = IdentificationInput {
            spans: &spans,
            values: &values,
            jacobian: &jacobian,
            spread: 1.0,
            exact: 1e-8,
        };
        let basis = CovarianceInput {
            spans: &spans,
            values: &values,
            free: &[0, 2],
            unseen: &unseen(&seen),
            jacobian: &jacobian,
            variance: 1.0,
            freedom: None,
        };
        let intervals = basis.errors().intervals;
        assert!(intervals[0].is_none() && intervals[1].is_none(), "{intervals:?}");
        assert!(intervals[2].is_some(), "{intervals:?}");
    }
}
