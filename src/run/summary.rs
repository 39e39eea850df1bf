//! The summary of a run: `summary.json`.

use crate::error::numbers::counted;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::growth::GrowingResponse;
use super::json_null;
use super::sensitivity::figures::FigureSensitivity;
use super::step_response::StepResponse;
use super::uncertainty_band::Bands;
pub use super::wall_time::WallTimes;
use super::waves::GrowingWave;
use crate::discrete::quantities::probes;
pub use crate::integrate::Counters;

/// Final status of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Reached the end time.
    Finished,
    /// Stopped on request.
    Stopped,
    /// Ended because the result left the validity limits of the model.
    OutOfRange,
    /// The solver failed to continue.
    Failed,
}

/// Reason why a ratio has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MissingRatio {
    /// Its denominator is below the numerical error of the run.
    BelowNumericalError,
}

/// A quantity over the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Value at the end.
    #[serde(rename = "final", skip_serializing_if = "Option::is_none")]
    pub last: Option<f64>,
    /// Largest absolute value of the motion, also between the output times.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_abs: Option<f64>,
    /// Time of the largest absolute value [s].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_abs_at_s: Option<f64>,
    /// Value at this time with its sign, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extreme: Option<f64>,
    /// Largest absolute value in the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window_max_abs: Option<f64>,
    /// Value of largest magnitude in the window with its sign, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_extreme: Option<f64>,
    /// Root mean square over the time in the window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_rms: Option<f64>,
    /// Increment over the window; for an efficiency, the energy harvested over all energy spent in the window.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<f64>,
    /// Mean power over the window, for energies [W].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_power_w: Option<f64>,
    /// For energies: largest residual of the balance over the run, relative to `final`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub final_error: Option<f64>,
    /// For energies: largest residual of the balance over the window, relative to `window`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_error: Option<f64>,
    /// Reason why a ratio has no value over the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub final_absent: Option<MissingRatio>,
    /// Reason why a ratio has no value over the window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_absent: Option<MissingRatio>,
}

impl Quantity {
    /// Largest value over the run, with its sign if known.
    pub fn largest(&self) -> Option<f64> {
        self.extreme.or(self.max_abs)
    }

    /// Magnitude of the largest figure.
    pub fn size(&self) -> f64 {
        self.figures().fold(0.0, |s, (_, x)| s.max(x.abs()))
    }

    /// Known figures, by the names in `summary.json`.
    pub fn figures(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        let all = [
            ("final", self.last),
            ("max_abs", self.max_abs),
            ("window_max_abs", self.window_max_abs),
            ("window_rms", self.window_rms),
            ("window", self.window),
        ];
        all.into_iter().filter_map(|(name, value)| Some((name, value?)))
    }

    /// Known figures including signed extremes and mean power, by the names in `summary.json`.
    pub fn all_figures(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        let further = [
            ("extreme", self.extreme),
            ("window_extreme", self.window_extreme),
            ("window_power_w", self.window_power_w),
        ];
        let further = further.into_iter().filter_map(|(name, value)| Some((name, value?)));
        self.figures().chain(further)
    }

    /// Figures that differ least between motions of the same kind: root mean square and increment over the window.
    pub fn statistics(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        self.figures()
            .filter(|(name, _)| matches!(*name, "window_rms" | "window"))
    }
}

/// Figures by quantity and name.
pub type Figures = BTreeMap<String, BTreeMap<String, f64>>;

/// Companion run from which the errors of figures are measured: see [`companion`](crate::study::companion).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompanionRun {
    /// Reason why there are no errors; absent if there are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Beam cells per segment.
    pub cells_per_segment: usize,
    /// Fluid cells per bladder.
    pub cells_per_bladder: usize,
    /// Tolerance.
    pub rtol: f64,
    /// Effects that the run neglects and the companion includes.
    pub added_effects: Vec<String>,
    /// Unknowns.
    pub unknowns: usize,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the residual.
    pub residual_evaluations: u64,
    /// Wall time [s].
    pub wall_s: f64,
    /// Figures of the companion.
    pub figures: Figures,
    /// Errors of figures by their cause, the JSON pointer of a setting; absent if no error can exceed 5 %.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub causes: BTreeMap<String, Figures>,
    /// Earlier runs without effects that their companions found to be significant.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub earlier_runs: Vec<EarlierRun>,
}

/// A run that was repeated with more effects.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EarlierRun {
    /// Effects that it neglects and the next run includes.
    pub added_effects: Vec<String>,
    /// Unknowns.
    pub unknowns: usize,
    /// Steps.
    pub steps: u64,
    /// Wall time [s].
    pub wall_s: f64,
    /// Figures of the run.
    pub figures: Figures,
}

/// Residuals of the balances.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balances {
    /// Largest residual of the energy balance over the largest energy.
    #[serde(deserialize_with = "json_null::number")]
    pub energy_residual_relative: f64,
    /// Largest residual of any network's volume balance over the largest volume displaced in it or passed through its
    /// ports.
    #[serde(deserialize_with = "json_null::number")]
    pub volume_residual_relative: f64,
    /// Largest relative volume residual of networks without ports, which close to round-off at any tolerance.
    #[serde(default, deserialize_with = "json_null::number")]
    pub closed_volume_residual_relative: f64,
    /// Largest difference between the volumes that left a network by its ports' law and by its storage, over the volume passed.
    #[serde(default, deserialize_with = "json_null::number")]
    pub port_flow_residual_relative: f64,
    /// Error of the mesh: difference between two evaluations of the reactions of driven ends, over the reactions (root mean square).
    /// One is from the momentum of half a cell, the other from the section force at the end.
    #[serde(default, deserialize_with = "json_null::number")]
    pub reaction_difference_relative: f64,
    /// Largest residual of the momentum balance over the largest momentum or impulse.
    #[serde(deserialize_with = "json_null::number")]
    pub momentum_residual_relative: f64,
    /// Largest residual of the angular momentum balance over the largest angular momentum or angular impulse.
    #[serde(deserialize_with = "json_null::number")]
    pub angular_momentum_residual_relative: f64,
    /// Energies and works at the end [J].
    pub energy_j: BTreeMap<String, f64>,
}

/// A choice of the program and its reason.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProgramChoice {
    /// The choice: `on`, `off`.
    pub value: String,
    /// The number that decided.
    pub reason: String,
}

/// Errors of a quantity beside an accuracy, relative to its size there: its largest figure, and at least a tenth of the largest with the
/// same unit; absent if unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// Error of the time integration.
    pub time: Option<f64>,
    /// Error of the mesh.
    pub space: Option<f64>,
    /// Error of the neglected effects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub effects: Option<f64>,
    /// Error of time, mesh and effects together.
    pub total: Option<f64>,
}

/// A coarser or looser run before a result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PilotRun {
    /// Beam cells per segment.
    pub cells_per_segment: usize,
    /// Fluid cells per bladder.
    #[serde(default)]
    pub cells_per_bladder: usize,
    /// Tolerance.
    pub rtol: f64,
    /// Unknowns.
    #[serde(default)]
    pub unknowns: usize,
    /// Steps.
    pub steps: u64,
    /// Wall time [s].
    pub wall_s: f64,
}

/// Outcome of a requested accuracy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Requested relative error.
    pub asked: f64,
    /// True if every error is known and at most the requested one.
    pub reached: bool,
    /// Mesh chosen: beam cells per segment.
    pub cells_per_segment: usize,
    /// Mesh chosen: fluid cells per bladder.
    pub cells_per_bladder: usize,
    /// Order of the mesh.
    #[serde(default = "second")]
    pub order: u8,
    /// Tolerance chosen.
    pub rtol: f64,
    /// Added and neglected effects, as text.
    #[serde(default)]
    pub effects: String,
    /// Errors by quantity, probe and port.
    pub quantities: BTreeMap<String, ErrorEstimate>,
    /// The runs before the result.
    pub pilots: Vec<PilotRun>,
}

/// Order of the mesh in files without this key.
fn second() -> u8 {
    2
}

impl Accuracy {
    /// Describes the mesh of the beam.
    pub fn cells(&self) -> String {
        let order = if self.order == 4 { " of fourth order" } else { "" };
        format!("{} a segment{order}", counted(self.cells_per_segment as u64, "cell"))
    }
}

/// `summary.json`; see the README for its keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the case.
    pub case: String,
    /// Final status of the run.
    pub status: Status,
    /// Reason why the run did not finish.
    pub reason: Option<String>,
    /// Simulated time reached [s].
    pub time_s: f64,
    /// Number of unknowns.
    pub unknowns: usize,
    /// Quantities of interest.
    pub quantities: BTreeMap<String, Quantity>,
    /// Absolute errors of figures of quantities, probes and ports, each in the unit of its figure.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub errors: Figures,
    /// Companion run from which the errors are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub companion: Option<CompanionRun>,
    /// Quantities recorded at probes, by name and unit.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub probes: BTreeMap<String, Quantity>,
    /// Flows and pressures of ports and pressures in accumulators at the output times, by name and unit.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub ports: BTreeMap<String, Quantity>,
    /// Step responses of tip and probes, by name and unit, if requested.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub step_response: BTreeMap<String, StepResponse>,
    /// Spread of figures due to uncertain numbers, by the names of `uncertainty.json`.
    #[serde(default, skip_serializing_if = "Bands::is_empty")]
    pub bands: Bands,
    /// Balances.
    pub balances: Balances,
    /// Integrator.
    pub solver: Counters,
    /// Wall time.
    pub wall_s: WallTimes,
    /// Effects.
    pub effects: BTreeMap<String, ProgramChoice>,
    /// Characteristic numbers.
    pub characteristic: BTreeMap<String, f64>,
    /// Origin of each coefficient, by its JSON pointer: `case`, `preset ...`, `--set`, `default` or `computed from ...`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub origins: BTreeMap<String, String>,
    /// Growth of the response and its causes, if it grows.
    #[serde(default)]
    pub growth: Option<GrowingResponse>,
    /// A wave that grows in the equations linearized about states of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub growing_wave: Option<GrowingWave>,
    /// Estimated errors, if an accuracy was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Derivatives of the quantities, by the JSON pointers of the requested numbers.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub sensitivities: BTreeMap<String, FigureSensitivity>,
    /// CRC-32 of the tables beside the summary, by file; absent where no table was written.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tables_crc32: BTreeMap<String, u32>,
    /// Warnings to read before trusting the result.
    pub warnings: Vec<String>,
}

/// True for figures in the unit of their quantity: all but mean powers.
pub fn has_unit_of_quantity(figure: &str) -> bool {
    figure != "window_power_w"
}

/// Largest error of the figures in the unit of their quantity.
pub fn largest_error(errors: &BTreeMap<String, f64>) -> Option<f64> {
    let alike = errors.iter().filter(|(figure, _)| has_unit_of_quantity(figure));
    alike.map(|(_, error)| *error).reduce(f64::max)
}

impl Summary {
    /// Largest error of a quantity or probe over its largest figure; `None` if unknown.
    pub fn relative_error(&self, name: &str) -> Option<f64> {
        let Some(errors) = self.errors.get(name) else {
            return self.accuracy.as_ref()?.quantities.get(name)?.total;
        };
        let quantity = self.quantities.get(name).or_else(|| self.probes.get(name))?;
        let largest = largest_error(errors)?;
        Some(largest / quantity.size()).filter(|e| e.is_finite())
    }

    /// Absolute error of a figure of a quantity or probe, in its unit; `None` if unknown.
    pub fn error(&self, name: &str, figure: &str) -> Option<f64> {
        self.errors.get(name)?.get(figure).copied()
    }

    /// A quantity, by name and unit.
    pub fn quantity(&self, name: &str) -> Option<&Quantity> {
        self.quantities.get(name)
    }

    /// Names of the beams of a structure, in alphabetical order.
    pub fn beams(&self) -> impl Iterator<Item = &str> {
        let tips = self.probes.keys().filter_map(|name| probes::tip_of_beam(name));
        tips.filter(|(_, what)| *what == "u1_m").map(|(beam, _)| beam)
    }
}
