//! `equilibrium.json`: the last state of a path of equilibria, and the path to it.

use serde::{Deserialize, Serialize};

use super::ResultFile;
use super::ordered::Ordered;
use super::run::{Accuracy, Bands, Status};
use crate::run::json_null;
use crate::study::refine::meshes::Meshes;

/// Numbers by name, which contains the unit; null if not finite.
pub type NamedNumbers = Ordered<Option<f64>>;

/// A path of equilibria.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquilibriumPath {
    /// Name of the case.
    pub case: String,
    /// Status; `finished` if the path reached its end.
    pub status: Status,
    /// Reason why the path did not reach its end.
    pub reason: Option<String>,
    /// Instant of the loads [s].
    pub loads_at_s: f64,
    /// Instants whose loads are reached before [s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via_s: Vec<f64>,
    /// Instants that determine the positions of valves in these stages, if the stages are those of closing valves [s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub valves_s: Vec<f64>,
    /// Load factor of the last state: share of the loads, plus 1 for every previous stage; null without states.
    pub load_factor: Option<f64>,
    /// Number of states on the path.
    pub states: usize,
    /// Quantities of the last state.
    pub quantities: Option<NamedNumbers>,
    /// Uncertainty bands of the quantities.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
    /// Stability of the last state, if known.
    pub stability: Option<StabilityRecord>,
    /// Events on the path.
    pub events: Vec<PathEvent>,
    /// Derivatives of the quantities, by JSON pointers of numbers of the case.
    pub sensitivities: Ordered<EquilibriumDerivatives>,
    /// Work.
    pub solver: PathWork,
    /// Wall time.
    pub wall_s: WallRecord,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Estimated errors, if an accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Effect of the mesh on the last state, if no accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meshes: Option<Meshes>,
}

impl ResultFile for EquilibriumPath {}

/// Stability of a state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StabilityRecord {
    /// True if there is no unstable mode.
    pub stable: bool,
    /// Number of unstable modes.
    pub unstable_modes: usize,
    /// The eigenvalue of least magnitude [1/s^2], where it was computed.
    pub softest_1_s2: Option<f64>,
}

/// An event on the path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathEvent {
    /// Load factor: share of the loads, plus 1 for every previous stage.
    pub load_factor: f64,
    /// Stage of the event, from 1, if there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stage: Option<usize>,
    /// Description.
    pub what: String,
}

/// Derivatives with respect to one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EquilibriumDerivatives {
    /// Value of the number.
    pub value: f64,
    /// Derivatives by quantity.
    pub derivatives: NamedNumbers,
}

/// Work along the path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathWork {
    /// Number of Newton steps.
    pub newton_iterations: u64,
    /// Number of residual evaluations.
    pub residual_evaluations: u64,
    /// Number of factorizations.
    pub factorizations: u64,
    /// Rejected steps along the path.
    pub rejected_steps: u64,
    /// Remaining Newton correction, scaled.
    #[serde(deserialize_with = "json_null::number")]
    pub largest_correction_left: f64,
}

/// Wall time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallRecord {
    /// Total [s].
    pub total: f64,
}
