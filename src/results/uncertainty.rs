//! `uncertainty.json`: uncertainty of the figures from uncertain numbers of a case.

use super::ResultFile;
pub use crate::study::uncertain::{FigureSpread, FirstOrder, Index, UncertainInput, Uncertainty};

impl ResultFile for Uncertainty {}
