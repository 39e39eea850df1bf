//! `modes.json`: modes of small motions.

use serde::{Deserialize, Serialize};

use super::Kept;
use super::ordered::Ordered;
use super::run::{Accuracy, Bands};
pub use crate::run::modes::{Kind, Limit, Sort};

/// State about which a case moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum About {
    /// The start of the case.
    Start,
    /// The equilibrium under the loads of an instant.
    Equilibrium,
}

/// Modes of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Modes {
    /// Name of the case.
    pub case: String,
    /// State about which, in words.
    pub about: String,
    /// The same as one word; absent in results of before it was told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<About>,
    /// Instant of loads and valves [s].
    pub at_s: f64,
    /// Frequency near which modes were looked for [Hz].
    pub near_hz: f64,
    /// The one kind that was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of_kind: Option<Sort>,
    /// Unknowns.
    pub unknowns: usize,
    /// Finite eigenvalues that there are.
    pub finite_eigenvalues: usize,
    /// Whether none of the modes grows.
    pub stable: bool,
    /// The same in a sentence.
    pub verdict: String,
    /// The modes.
    pub modes: Vec<Mode>,
    /// Whether the coupling can give more than it takes; nothing without bladders.
    pub coupling: Option<Coupling>,
    /// Derivatives of all modes, by JSON pointers of numbers of the case.
    pub sensitivities: Ordered<Derivatives>,
    /// Work.
    pub solver: Work,
    /// What to know before trusting them.
    pub warnings: Vec<String>,
    /// Estimated errors, when an accuracy was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
}

impl Kept for Modes {}

/// One mode; of a pair of conjugates that with positive frequency.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mode {
    /// What it does.
    pub kind: Kind,
    /// Frequency [Hz], where it swings.
    pub frequency_hz: Option<f64>,
    /// Damping ratio, where it swings.
    pub damping_ratio: Option<f64>,
    /// Growth rate [1/s].
    pub growth_per_s: f64,
    /// Time in which it changes by a factor e [s].
    pub time_s: Option<f64>,
    /// Angular frequency [1/s].
    pub angular_frequency_per_s: f64,
    /// Bound of the error of both [1/s].
    pub error_per_s: Option<f64>,
    /// Backward error of the pair.
    pub residual: Option<f64>,
    /// Share of the motion that is across the beam.
    pub transverse_share: Option<f64>,
    /// The same mode with every bladder sealed.
    pub undrained: Option<Limit>,
    /// The same mode with one pressure in each network.
    pub drained: Option<Limit>,
    /// The same mode on half the cells.
    pub on_half_the_cells: Option<Limit>,
    /// Frequency to which both meshes point [Hz].
    pub extrapolated_frequency_hz: Option<f64>,
    /// Growth rate to which both meshes point [1/s].
    pub extrapolated_growth_per_s: Option<f64>,
    /// Error of the frequency by the mesh, relative.
    pub mesh_error: Option<f64>,
    /// Error of the growth rate by the mesh, relative.
    pub rate_mesh_error: Option<f64>,
    /// What uncertain numbers leave open of frequency, damping ratio and growth rate, by these keys.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
}

/// Whether the coupling can give more than it takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coupling {
    /// It cannot.
    pub passive: bool,
    /// Least eigenvalue of the symmetric part, 1 without coupling.
    pub least_eigenvalue: f64,
    /// Antisymmetric part over the coupling.
    pub reciprocity_defect: f64,
    /// Loads that take least work.
    pub direction: Direction,
    /// In a sentence.
    pub words: String,
}

/// Loads on a section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Direction {
    /// Moment [N m].
    pub moment_n_m: f64,
    /// Force [N].
    pub force_n: f64,
    /// Pressure of the upper row [Pa].
    pub upper_pressure_pa: f64,
    /// Pressure of the lower row [Pa].
    pub lower_pressure_pa: f64,
}

/// Derivatives of all modes by one number of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Derivatives {
    /// The number.
    pub value: f64,
    /// Of growth rates [1/s], mode after mode.
    pub growth_rate_1_s: Vec<Option<f64>>,
    /// Of frequencies [Hz], mode after mode.
    pub frequency_hz: Vec<Option<f64>>,
}

/// Work of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Factorisations.
    pub factorizations: u64,
    /// Solves.
    pub solves: u64,
    /// Whether all eigenvalues were computed at once.
    pub all_at_once: bool,
}
