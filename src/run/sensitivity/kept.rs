//! Sensitivities in a checkpoint.

use serde::{Deserialize, Serialize};

use super::figures::DerivativeAccumulator;
use crate::case::parameter::Parameter;

/// Sensitivities stored in a checkpoint, from which a run resumes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredSensitivities {
    /// Numbers by which the run is differentiated.
    pub parameters: Vec<Parameter>,
    /// Sensitivities on the left side of the checkpoint, and their rates.
    pub(super) s: Vec<Vec<f64>>,
    pub(super) sp: Vec<Vec<f64>>,
    /// Derivatives of the integrals up to the checkpoint.
    pub(super) carried: Vec<Vec<f64>>,
    pub(super) figures: Vec<DerivativeAccumulator>,
}

impl StoredSensitivities {
    /// True if there is one finite number for each unknown and each parameter.
    pub fn fits(&self, unknowns: usize, integrals: usize) -> bool {
        let fits = |all: &[Vec<f64>], len: usize| {
            let sound = |of: &Vec<f64>| of.len() == len && of.iter().all(|x| x.is_finite());
            all.len() == self.parameters.len() && all.iter().all(sound)
        };
        fits(&self.s, unknowns)
            && fits(&self.sp, unknowns)
            && fits(&self.carried, integrals)
            && self.figures.len() == self.parameters.len()
    }
}
