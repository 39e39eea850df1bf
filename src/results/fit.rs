//! `fit.json`: numbers of a case estimated from measured data; and the output of `compare` for a run over data.

use super::ResultFile;
pub use crate::study::fit::comparison::DataComparison;
pub use crate::study::fit::outcome::*;

impl ResultFile for Fit {}

impl ResultFile for DataComparison {}
