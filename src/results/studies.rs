//! `study.json`, `effects.json`, and comparisons of runs.

use super::Kept;
pub use crate::study::accuracy::Study;
pub use crate::study::compare::Comparison;
pub use crate::study::effects::{Ablation, Verdict};

impl Kept for Study {}

impl Kept for Ablation {}

impl Kept for Comparison {}

impl Kept for crate::study::compare::Beside {}
