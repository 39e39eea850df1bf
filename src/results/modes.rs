//! `modes.json`: modes of small motions.

use serde::{Deserialize, Serialize};

use super::ResultFile;
use super::ordered::Ordered;
use super::run::{Accuracy, Bands};
pub use crate::run::modes::{LimitingMode, ModeFilter, TimeBehavior};

/// State about which a case is linearized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinearisedState {
    /// The start of the case.
    Start,
    /// The equilibrium under the loads of an instant.
    Equilibrium,
    /// A steady cycle.
    Cycle,
}

/// Modes of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModesRecord {
    /// Name of the case.
    pub case: String,
    /// State of linearization as text.
    pub about: String,
    /// State of linearization; absent in older results.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<LinearisedState>,
    /// Instant of loads and valves [s].
    pub at_s: f64,
    /// Frequency near which modes were searched [Hz].
    pub near_hz: f64,
    /// The only kind of modes requested, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of_kind: Option<ModeFilter>,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Number of finite eigenvalues.
    pub finite_eigenvalues: usize,
    /// True if no mode grows.
    pub stable: bool,
    /// Stability in a sentence.
    pub verdict: String,
    /// The modes.
    pub modes: Vec<ModeRecord>,
    /// Passivity of the coupling; null without bladders.
    pub coupling: Option<CouplingPassivity>,
    /// Derivatives of all modes, by JSON pointers of numbers of the case.
    pub sensitivities: Ordered<ModeDerivatives>,
    /// Work.
    pub solver: SearchWork,
    /// Effects that the modes leave out and that errors include.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// Reason why errors exclude effects that are left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub excluded: Option<String>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Estimated errors, if an accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
}

impl ResultFile for ModesRecord {}

/// One mode; of a conjugate pair the one with positive frequency.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModeRecord {
    /// Kind of the mode.
    pub kind: TimeBehavior,
    /// Frequency [Hz], if the mode oscillates.
    pub frequency_hz: Option<f64>,
    /// Damping ratio, if the mode oscillates.
    pub damping_ratio: Option<f64>,
    /// Growth rate [1/s].
    pub growth_per_s: f64,
    /// Time in which the mode changes by a factor e [s].
    pub time_s: Option<f64>,
    /// Angular frequency [1/s].
    pub angular_frequency_per_s: f64,
    /// Error bound of growth rate and angular frequency [1/s].
    pub error_per_s: Option<f64>,
    /// Backward error of the eigenpair.
    pub residual: Option<f64>,
    /// Transverse share of the motion.
    pub transverse_share: Option<f64>,
    /// Similar mode with every bladder sealed.
    pub undrained: Option<LimitingMode>,
    /// Similar mode with one pressure in each network.
    pub drained: Option<LimitingMode>,
    /// Similar mode on half the cells.
    pub on_half_the_cells: Option<LimitingMode>,
    /// Frequency extrapolated from both meshes [Hz].
    pub extrapolated_frequency_hz: Option<f64>,
    /// Growth rate extrapolated from both meshes [1/s].
    pub extrapolated_growth_per_s: Option<f64>,
    /// Relative error of the frequency by the mesh.
    pub mesh_error: Option<f64>,
    /// Relative error of the growth rate by the mesh.
    pub rate_mesh_error: Option<f64>,
    /// Relative error of the frequency by the effects left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effects_error: Option<f64>,
    /// Relative error of the growth rate by the effects left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_effects_error: Option<f64>,
    /// Uncertainty bands of frequency, damping ratio and growth rate, by these keys.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
}

/// Passivity of the coupling: whether loads and pressures can gain energy from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CouplingPassivity {
    /// True if loads and pressures cannot gain energy.
    pub passive: bool,
    /// Least eigenvalue of the symmetric part; 1 without coupling.
    pub least_eigenvalue: f64,
    /// Antisymmetric part, relative to the coupling.
    pub reciprocity_defect: f64,
    /// Loads that do the least work.
    pub direction: LoadDirection,
    /// Verdict in a sentence.
    pub words: String,
}

/// Loads on a section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoadDirection {
    /// Moment [N m].
    pub moment_n_m: f64,
    /// Force [N].
    pub force_n: f64,
    /// Pressure of the upper row [Pa].
    pub upper_pressure_pa: f64,
    /// Pressure of the lower row [Pa].
    pub lower_pressure_pa: f64,
}

/// Derivatives of all modes with respect to one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModeDerivatives {
    /// Value of the number.
    pub value: f64,
    /// Derivatives of growth rates [1/s], mode after mode.
    pub growth_rate_1_s: Vec<Option<f64>>,
    /// Derivatives of frequencies [Hz], mode after mode.
    pub frequency_hz: Vec<Option<f64>>,
}

/// Work of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SearchWork {
    /// Number of factorizations.
    pub factorizations: u64,
    /// Number of solves.
    pub solves: u64,
    /// True if all eigenvalues were computed at once.
    pub all_at_once: bool,
}
