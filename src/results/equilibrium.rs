//! `equilibrium.json`: the last state of a path of equilibria, and the way to it.

use serde::{Deserialize, Serialize};

use super::Kept;
use super::ordered::Ordered;
use super::run::{Accuracy, Bands, Status};
use crate::run::null;
use crate::study::refine::meshes::Meshes;

/// Numbers by name, unit included; nothing where one is not finite.
pub type Numbers = Ordered<Option<f64>>;

/// A path of equilibria.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Equilibrium {
    /// Name of the case.
    pub case: String,
    /// Whether the path reached its end.
    pub status: Status,
    /// Why it did not.
    pub reason: Option<String>,
    /// Instant of the loads [s].
    pub loads_at_s: f64,
    /// Instants whose loads were to be reached before [s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via_s: Vec<f64>,
    /// Instants as of which valves stood on the way there, where these are the instants at which valves shut [s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub valves_s: Vec<f64>,
    /// Load factor of the last state: share of the loads, 1 more for every stage before; nothing without states.
    pub load_factor: Option<f64>,
    /// States on the path.
    pub states: usize,
    /// What is read off the last state.
    pub quantities: Option<Numbers>,
    /// What uncertain numbers leave open of them.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
    /// Whether the last state holds, where that is known.
    pub stability: Option<Stability>,
    /// What happens on the way.
    pub events: Vec<Event>,
    /// Derivatives of the quantities, by JSON pointers of numbers of the case.
    pub sensitivities: Ordered<Derivatives>,
    /// Work.
    pub solver: Work,
    /// Wall time.
    pub wall_s: Wall,
    /// What to think of first.
    pub warnings: Vec<String>,
    /// Estimated errors, when an accuracy was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// What meshes do to the last state, where no accuracy was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshes: Option<Meshes>,
}

impl Kept for Equilibrium {}

/// Whether a state holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Whether nothing gives way.
    pub stable: bool,
    /// Ways in which it gives way.
    pub unstable_modes: usize,
    /// The eigenvalue of least magnitude [1/s^2], where it was computed.
    pub softest_1_s2: Option<f64>,
}

/// Something that happens on the way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Load factor: share of the loads, 1 more for every stage before.
    pub load_factor: f64,
    /// Stage in which it happens, from 1, where there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<usize>,
    /// In words.
    pub what: String,
}

/// Derivatives by one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Derivatives {
    /// The number.
    pub value: f64,
    /// By quantity.
    pub derivatives: Numbers,
}

/// Work along the path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Work {
    /// Newton steps.
    pub newton_iterations: u64,
    /// Residuals.
    pub residual_evaluations: u64,
    /// Factorisations.
    pub factorizations: u64,
    /// Steps along the path that were taken back.
    pub rejected_steps: u64,
    /// Newton correction that was left, scaled.
    #[serde(deserialize_with = "null::number")]
    pub largest_correction_left: f64,
}

/// Wall time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// Everything [s].
    pub total: f64,
}
