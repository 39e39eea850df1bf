//! What was found, and what of it can be told.

use serde::{Deserialize, Serialize};

use super::basis::Basis;
use super::estimate::Smoothing;

/// Loads behind measured pressures, or what measurements would tell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sensed {
    /// Name of the case.
    pub case: String,
    /// What does it again, within the folder of the result.
    #[serde(default)]
    pub command: String,
    /// The file with the measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<String>,
    /// Columns of it that hold no pressure.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_alone: Vec<String>,
    /// Loads that were looked for.
    pub loads: Vec<Basis>,
    /// Instant whose own loads of the case act besides [s].
    pub loads_at_s: f64,
    /// Pointers of those that do.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own_loads: Vec<String>,
    /// Their amplitudes.
    pub amplitudes: Vec<Unknown>,
    /// Bladders whose pressures are taken, upper ones first; all without measurements.
    pub bladders: Vec<i64>,
    /// What pressures of these bladders tell, before anything is known of their values.
    pub seen: Sight,
    /// Noise of the pressures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
    /// What was known before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothed>,
    /// What the bands hold.
    #[serde(default)]
    pub band: BandKind,
    /// How loads over time were found; none where each row is at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_time: Option<OverTime>,
    /// One a row of the measurements.
    pub rows: Vec<Row>,
    /// The best bladders to measure, where that was asked.
    pub choice: Vec<Chosen>,
    /// Noise of their pressures [Pa].
    pub choice_noise_pa: f64,
    /// What to know before any number: pressures that the loads do not explain. They stand among the warnings too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<String>,
    /// What to know first.
    pub warnings: Vec<String>,
}

/// An amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Name without unit.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Share of the length at which it acts, of those that have a place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<f64>,
    /// Its standard error, for pressures whose noise is 1 Pa; none where pressures alone do not tell it.
    pub error_per_pa: Option<f64>,
}

/// What of the amplitudes leaves traces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    /// Largest over least singular value of what is told, amplitudes in sizes that bend the beam by about its length.
    pub condition: f64,
    /// Combinations of several amplitudes that are told together, and not each by itself.
    pub together: Vec<Combination>,
    /// Changes of amplitudes that leave no trace: how much each changes.
    pub blind: Vec<Vec<f64>>,
}

/// A sum of amplitudes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// In words, factors in SI units.
    pub name: String,
    /// Unit of the sum.
    pub unit: String,
    /// How many times each amplitude counts.
    pub factors: Vec<f64>,
}

/// Where the deviation of the noise is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseFrom {
    /// `--noise`.
    Given,
    /// Columns of the measurements.
    Table,
    /// What the loads leave of the pressures.
    Estimated,
}

/// Of results before bands were widened.
fn one() -> f64 {
    1.0
}

/// Noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Where its deviation is from.
    pub from: NoiseFrom,
    /// Standard deviation [Pa]; none where the table has one for each pressure.
    pub sd_pa: Option<f64>,
    /// Degrees of freedom: pressures less what was taken from them.
    pub freedom: f64,
    /// Sum of `misfit` and `roughness`: about `freedom` where the model holds.
    pub chi_square: f64,
    /// Sum of the squares of what is left of the pressures, over their noise.
    #[serde(default)]
    pub misfit: f64,
    /// Sum of the squares of second differences of the loads, over what was known of them.
    #[serde(default)]
    pub roughness: f64,
    /// By how much bands are wider than the noise makes them, since more is left than it explains by chance.
    #[serde(default = "one")]
    pub widened: f64,
    /// Half of a band of 95 % in standard errors: of the normal distribution, or Student's where the noise is estimated.
    pub quantile: f64,
}

/// What was known before: that a profile, or a load over time, has small second differences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Smoothed {
    /// How their deviation was chosen.
    pub by: Smoothing,
    /// That of a profile at rest [N/m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation_n_m: Option<f64>,
    /// Standard deviation of the load before the measurements, of the most likely scale and shape [N/m]; the largest of all rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_deviation_n_m: Option<f64>,
}

/// Loads over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverTime {
    /// Equally spaced instants between which each load is a natural cubic spline.
    pub knots: usize,
    /// Time between two of them; the first lies as much before the start of the run, the last as much after the last measurement [s].
    pub every_s: f64,
    /// Of each load how many of the values at knots the pressures tell; the others are known by its smoothness.
    pub told: Vec<f64>,
    /// Correlation of what is left of a pressure with what is left of it an instant before: about nothing, where that is noise.
    pub correlation: f64,
    /// Runs that it took.
    pub runs: u32,
}

/// What a band of 95 % holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BandKind {
    /// The load, if loads act where and as they are looked for: noise is the only error.
    #[default]
    AssumedForm,
    /// The mean of the load around its place, whatever its shape between places.
    LocalMean,
    /// The load, if it is straight between places and as smooth as assumed.
    AssumedSmoothness,
    /// The load at an instant, if loads change as smoothly as estimated.
    SmoothInTime,
}

/// A number with its band of 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Banded {
    /// The number.
    pub value: f64,
    /// Standard error.
    pub sd: f64,
    /// Lower end of the band.
    pub low: f64,
    /// Upper end of the band.
    pub high: f64,
}

/// A row of the measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Line in the file.
    pub line: usize,
    /// Instant [s], where the file has them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t_s: Option<f64>,
    /// Amplitudes; none where one is not told.
    pub amplitudes: Vec<Option<Banded>>,
    /// Combinations of `seen`; none where one is not told.
    pub together: Vec<Option<Banded>>,
    /// Measured pressures [Pa], in the order of `bladders`.
    pub measured_pa: Vec<Option<f64>>,
    /// What the loads make of them [Pa].
    pub modelled_pa: Vec<f64>,
}

/// A set of bladders to measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// The bladders.
    pub bladders: Vec<i64>,
    /// Standard errors of the amplitudes; none where one is not told.
    pub errors: Vec<Option<f64>>,
}
