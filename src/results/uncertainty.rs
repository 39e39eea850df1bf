//! `uncertainty.json`: what uncertain numbers of a case leave open of its figures.

use super::Kept;
pub use crate::study::uncertain::{FirstOrder, Index, Input, Spread, Uncertainty};

impl Kept for Uncertainty {}
