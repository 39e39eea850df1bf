//! `uncertainty.json`: uncertainty of the figures from uncertain numbers of a case.

use super::Kept;
pub use crate::study::uncertain::{FirstOrder, Index, Input, Spread, Uncertainty};

impl Kept for Uncertainty {}
