//! Checkpoints: the data from which a run resumes as if it had not been interrupted.
//!
//! The uninterrupted run also restarts its integrator at every planned checkpoint time, with new factors and integrals
//! from zero. A resumed run therefore repeats it bit for bit.

use serde::{Deserialize, Serialize};

use super::control_loop::LoopState;
use super::observe::Observed;
use super::sensitivity::kept::StoredSensitivities;
use super::summary::Counters;
use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::{Error, Result};

/// State of a run at a checkpoint time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the program that wrote it.
    pub version: String,
    /// Resolved case as JSON text. A run of another case does not resume from this checkpoint.
    pub case: String,
    /// Simulated time [s].
    pub t: f64,
    /// Index of this stop among the stops of the run.
    pub stop: usize,
    /// Unknowns, scaled.
    pub y: Vec<f64>,
    /// Rates of the unknowns, scaled.
    pub yp: Vec<f64>,
    /// Integrals up to this time.
    pub integrals: Vec<f64>,
    /// Number of the next output.
    pub next_output: u64,
    /// Work done so far.
    pub counters: Counters,
    /// Data accumulated by the observer.
    pub observed: Observed,
    /// States of the controllers before the samples at this time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub controllers: Vec<LoopState>,
    /// Sensitivities, if the run computes any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub forward: Option<StoredSensitivities>,
}

impl Checkpoint {
    /// Checks that a run of this case can resume from this checkpoint.
    ///
    /// # Errors
    ///
    /// Another case or version of the program wrote it, its arrays do not fit the case, or a number is not finite.
    pub fn fits(&self, case: &Case, system: &System) -> Result<()> {
        let fault = |why: &str| Err(Error::Usage(format!("the checkpoint {why}; nothing was changed")));
        if self.case != case.resolved_json() || self.version != VERSION {
            return fault("belongs to another case or another version of the program");
        }
        let unknowns = system.layout.len;
        if self.y.len() != unknowns || self.yp.len() != unknowns {
            return fault("has a different number of unknowns than the case");
        }
        if self.controllers.len() != system.model.controllers.len() {
            return fault("has a different number of controllers than the case");
        }
        if self
            .y
            .iter()
            .chain(&self.yp)
            .chain(&self.integrals)
            .any(|x| !x.is_finite())
            || !self.t.is_finite()
        {
            return fault("has numbers that are not finite");
        }
        if let Some(kept) = &self.forward {
            if !kept.fits(unknowns, self.integrals.len()) {
                return fault("has derivatives with a different number of unknowns than the case");
            }
            for kept in &kept.parameters {
                if Parameter::find(case, &kept.pointer)? != *kept {
                    return fault("has derivatives by a number whose value differs in the case");
                }
            }
        }
        Ok(())
    }
}

/// Version written into checkpoints.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
