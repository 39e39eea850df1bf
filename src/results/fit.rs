//! `fit.json`: numbers of a case estimated from measured data; and the output of `compare` for a run over data.

use super::Kept;
pub use crate::study::fit::beside::Beside;
pub use crate::study::fit::found::*;

impl Kept for Fit {}

impl Kept for Beside {}
