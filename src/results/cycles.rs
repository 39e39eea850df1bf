//! `floquet.json`, `cycle.json`, `map.json`, `sweep.json`: steady cycles and whether they hold.

use serde::{Deserialize, Serialize};

use super::{Integrator, Kept};
use crate::run::band::Bands;
pub use crate::run::floquet::{Floquet, Stability};
pub use crate::run::periodic::Search;
use crate::run::periodic::scene::METHOD;
use crate::run::periodic::settle::Refined;
use crate::run::periodic::subharmonic::Periods;
use crate::run::summary::Accuracy;
use crate::study::refine::meshes::Meshes;
pub use crate::study::stability::{Along, Map};

/// A steady cycle and its stability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Name of the case.
    pub case: String,
    /// How the cycle was found.
    pub cycle: Search,
    /// After how many periods it comes back, when several were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periods: Option<Periods>,
    /// Its multipliers.
    pub floquet: Floquet,
    /// What uncertain numbers leave open of figures, by the names of `uncertainty.json`.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
    /// What to know of case and cycle.
    pub warnings: Vec<String>,
    /// Why the tolerance of the cycle is not the case's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refined: Option<Refined>,
    /// Estimated errors, when an accuracy was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// What meshes do to it, where no accuracy was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshes: Option<Meshes>,
}

impl Cycle {
    /// The relative error of a figure that an accuracy reached, or that meshes make, where it is known.
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

/// The method of all cycles.
fn shooting() -> Option<Integrator> {
    Some(Integrator {
        name: METHOD.into(),
        order: METHOD.order(),
    })
}

impl Kept for Cycle {
    fn integrator(&self) -> Option<Integrator> {
        shooting()
    }
}

impl Kept for Map {
    fn integrator(&self) -> Option<Integrator> {
        shooting()
    }
}

impl Kept for Along {
    fn integrator(&self) -> Option<Integrator> {
        shooting()
    }
}
