//! Checkpoints: everything from which a run goes on as if it had not been interrupted.
//!
//! At every planned checkpoint time the uninterrupted run too starts its integrator afresh, with new factors and
//! integrals from zero, so that a resumed run repeats it bit for bit.

use serde::{Deserialize, Serialize};

use super::observe::Observed;
use super::summary::Counters;

/// State of a run at a checkpoint time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Version of the program that wrote it.
    pub version: String,
    /// The case as resolved, word for word; a run with another case does not go on from here.
    pub case: String,
    /// Simulated time [s].
    pub t: f64,
    /// Which of the run's stops this is.
    pub stop: usize,
    /// Unknowns, scaled.
    pub y: Vec<f64>,
    /// Their rates, scaled.
    pub yp: Vec<f64>,
    /// Integrals up to here.
    pub integrals: Vec<f64>,
    /// Number of the next output.
    pub next_output: u64,
    /// Work done so far.
    pub counters: Counters,
    /// What the observer has seen.
    pub observed: Observed,
}

/// Version written into checkpoints.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
