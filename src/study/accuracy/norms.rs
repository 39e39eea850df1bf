//! Norms of vectors and of their differences.

use serde::{Deserialize, Serialize};

use crate::run::json_null;

/// Root mean square and maximum norm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Norms {
    /// Root of the mean square.
    #[serde(deserialize_with = "json_null::number")]
    pub l2: f64,
    /// Largest absolute value.
    #[serde(deserialize_with = "json_null::number")]
    pub max: f64,
}

impl Norms {
    /// Sets both norms to one value.
    pub fn both(value: f64) -> Self {
        Self { l2: value, max: value }
    }

    /// Computes the norms of a vector; zero for an empty one.
    pub fn from_values(values: impl ExactSizeIterator<Item = f64>) -> Self {
        let count = values.len().max(1) as f64;
        let (sum, max) = values.fold((0.0, 0.0_f64), |(sum, max), x| (sum + x * x, larger(max, x.abs())));
        Self {
            l2: (sum / count).sqrt(),
            max,
        }
    }

    /// Computes the norms of the difference of two vectors.
    pub fn between(a: &[f64], b: &[f64]) -> Self {
        debug_assert_eq!(a.len(), b.len());
        Self::from_values(a.iter().zip(b).map(|(a, b)| a - b))
    }

    /// Combines both norms with those of another by `f`.
    pub fn with(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            l2: f(self.l2, other.l2),
            max: f(self.max, other.max),
        }
    }

    /// Applies `f` to both norms.
    pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self {
            l2: f(self.l2),
            max: f(self.max),
        }
    }

    /// Divides both norms by those of a size; a size of zero leaves them unchanged.
    pub fn over(self, size: Self) -> Self {
        self.with(size, |x, s| if s > 0.0 { x / s } else { x })
    }

    /// Returns the larger value of each norm.
    pub fn or_larger(self, other: Self) -> Self {
        self.with(other, larger)
    }
}

/// Returns the larger number, or NaN if one of them is NaN: an error that cannot be computed is not small.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
