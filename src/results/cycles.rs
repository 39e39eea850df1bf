//! `floquet.json`, `cycle.json`, `map.json`, `sweep.json`: steady cycles and their stability.

use serde::{Deserialize, Serialize};

use super::{IntegratorRecord, ResultFile};
pub use crate::run::floquet::{CycleStability, Floquet};
pub use crate::run::periodic::ShootingRecord;
use crate::run::periodic::balanced_cycle::TighterCycle;
use crate::run::periodic::scene::METHOD;
use crate::run::periodic::subharmonic::Periods;
use crate::run::summary::Accuracy;
use crate::run::uncertainty_band::Bands;
use crate::study::refine::meshes::Meshes;
pub use crate::study::stability::special_points::SpecialKind;
pub use crate::study::stability::{CyclePath, Map};

/// A steady cycle and its stability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleResult {
    /// Name of the case.
    pub case: String,
    /// Search for the cycle.
    pub cycle: ShootingRecord,
    /// Number of periods after which the cycle repeats, if several were requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periods: Option<Periods>,
    /// Multipliers of the cycle.
    pub floquet: Floquet,
    /// Uncertainty bands of figures, by the names of `uncertainty.json`.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
    /// Warnings about case and cycle.
    pub warnings: Vec<String>,
    /// Tightened tolerance, if it differs from that of the case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refined: Option<TighterCycle>,
    /// Estimated errors, if an accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Effect of the mesh on the cycle, if no accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshes: Option<Meshes>,
}

impl CycleResult {
    /// Relative error of a figure: that of the reached accuracy, or that of the mesh; `None` if unknown.
    pub fn error(&self, name: &str) -> Option<f64> {
        match &self.accuracy {
            Some(accuracy) => accuracy.quantities.get(name)?.total,
            None => {
                let share = self.meshes.as_ref()?.quantities.get(name)?;
                share.known().then(|| share.total())
            }
        }
    }
}

/// Method of all cycles.
fn shooting() -> Option<IntegratorRecord> {
    Some(IntegratorRecord {
        name: METHOD.into(),
        order: METHOD.order(),
    })
}

impl ResultFile for CycleResult {
    fn integrator(&self) -> Option<IntegratorRecord> {
        shooting()
    }
}

impl ResultFile for Map {
    fn integrator(&self) -> Option<IntegratorRecord> {
        shooting()
    }
}

impl ResultFile for CyclePath {
    fn integrator(&self) -> Option<IntegratorRecord> {
        shooting()
    }
}
