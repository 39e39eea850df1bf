//! `fit.json`: numbers of a case estimated from measured data; and the output of `compare` for a run over data.

use super::ResultFile;
pub use crate::study::fit::beside::DataComparison;
pub use crate::study::fit::found::*;

impl ResultFile for Fit {}

impl ResultFile for DataComparison {}
