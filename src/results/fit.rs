//! `fit.json`: numbers of a case from measured data; what `compare` prints of a run over such.

use super::Kept;
pub use crate::study::fit::beside::Beside;
pub use crate::study::fit::found::*;

impl Kept for Fit {}

impl Kept for Beside {}
