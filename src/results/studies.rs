//! `study.json`, `effects.json`, and comparisons of runs.

use super::ResultFile;
pub use crate::study::accuracy::Study;
pub use crate::study::compare::Comparison;
pub use crate::study::effects::{Ablation, EffectVerdict};

impl ResultFile for Study {}

impl ResultFile for Ablation {}

impl ResultFile for Comparison {}

impl ResultFile for crate::study::compare::ManyComparison {}
