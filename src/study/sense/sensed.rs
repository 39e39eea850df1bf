//! Result of an estimate of loads, and the observability of loads.

use serde::{Deserialize, Serialize};

use super::basis::Basis;
use super::estimate::Smoothing;

/// Loads estimated from measured pressures, or only their observability without measurements.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sensed {
    /// Name of the case.
    pub case: String,
    /// Command that repeats the estimate, in the folder of the result.
    #[serde(default)]
    pub command: String,
    /// File of the measurements.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub data: Option<String>,
    /// Columns of the file that contain no pressure.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_alone: Vec<String>,
    /// Estimated loads.
    pub loads: Vec<Basis>,
    /// Instant [s] whose own loads of the case also act.
    pub loads_at_s: f64,
    /// Pointers of these own loads.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own_loads: Vec<String>,
    /// Amplitudes of the loads.
    pub amplitudes: Vec<Unknown>,
    /// Labels of the measured bladders, upper row first; all without measurements.
    pub bladders: Vec<i64>,
    /// Observability of the amplitudes by these bladders, independent of the measured values.
    pub seen: ObservableAmplitudes,
    /// Noise of the pressures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
    /// Prior of smooth loads.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smoothing: Option<Smoothed>,
    /// Meaning of the bands.
    #[serde(default)]
    pub band: BandKind,
    /// Properties of time-dependent loads; none if each row is at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over_time: Option<OverTime>,
    /// One per row of the measurements.
    pub rows: Vec<MeasurementRow>,
    /// Best sets of bladders to measure, if requested.
    pub choice: Vec<ChosenSensors>,
    /// Noise [Pa] assumed for `choice`.
    pub choice_noise_pa: f64,
    /// Doubts about the result, such as pressures that the loads do not explain. They are among the warnings, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<String>,
    /// Warnings, including the doubts.
    pub warnings: Vec<String>,
}

/// Unknown amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Name without unit.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Share of the length at which the load acts, if it has a place.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<f64>,
    /// Standard error for pressure noise of 1 Pa; none if pressures alone do not determine the amplitude.
    pub error_per_pa: Option<f64>,
}

/// Observability of the amplitudes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ObservableAmplitudes {
    /// Ratio of the largest to the smallest nonzero singular value, for amplitudes in sizes that bend the beam by about its length.
    pub condition: f64,
    /// Combinations of amplitudes that are determined together, but not each by itself.
    pub together: Vec<Combination>,
    /// Unobservable changes: change of each amplitude that leaves all pressures as they are.
    pub blind: Vec<Vec<f64>>,
}

/// Sum of amplitudes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// Formula in words, with factors in SI units.
    pub name: String,
    /// Unit of the sum.
    pub unit: String,
    /// Factor of each amplitude.
    pub factors: Vec<f64>,
}

/// Origin of the deviation of the noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NoiseFrom {
    /// Option `--noise`.
    Given,
    /// Columns of the measurements.
    Table,
    /// Residuals of the pressures.
    Estimated,
}

/// Default of `widened`, for results written before bands were widened.
fn one() -> f64 {
    1.0
}

/// Noise of the measured pressures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Origin of its deviation.
    pub from: NoiseFrom,
    /// Standard deviation [Pa]; none if the table has one for each pressure.
    pub sd_pa: Option<f64>,
    /// Degrees of freedom: number of pressures less that of fitted parameters.
    pub freedom: f64,
    /// Sum of `misfit` and `roughness`; about `freedom` if the model is right.
    pub chi_square: f64,
    /// Sum of the squared residuals of the pressures over their noise.
    #[serde(default)]
    pub misfit: f64,
    /// Sum of the squared second differences of the loads over their prior deviation.
    #[serde(default)]
    pub roughness: f64,
    /// Factor by which bands are widened because residuals exceed the noise.
    #[serde(default = "one")]
    pub widened: f64,
    /// Half-width of a 95 % band in standard errors: of the normal distribution, or of Student's if the noise is estimated.
    pub quantile: f64,
}

/// Prior: second differences of a profile, or of a load over time, are small.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Smoothed {
    /// Method that chose their deviation.
    pub by: Smoothing,
    /// Prior deviation of second differences of a profile at rest [N/m].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation_n_m: Option<f64>,
    /// Prior standard deviation of the load at the most likely scale and shape [N/m]; the largest of all rows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load_deviation_n_m: Option<f64>,
}

/// Properties of time-dependent loads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OverTime {
    /// Number of knots of each load, which is a natural cubic spline.
    pub knots: usize,
    /// Spacing of the knots [s]. The first lies one spacing before the start of the run, the last one spacing after the last measurement.
    pub every_s: f64,
    /// Number of knot values of each load that the pressures determine; the smoothness prior determines the others.
    #[serde(rename = "told")]
    pub determined: Vec<f64>,
    /// Lag-1 autocorrelation of the residuals of a pressure; about 0 for white noise.
    pub correlation: f64,
    /// Number of runs.
    pub runs: u32,
}

/// Meaning of a 95 % band.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BandKind {
    /// The load, if loads act at the assumed positions: noise is the only error.
    #[default]
    AssumedForm,
    /// The mean of the load around its place, for any shape between places.
    LocalMean,
    /// The load, if it is piecewise linear and as smooth as assumed.
    AssumedSmoothness,
    /// The load at an instant, if loads change as smoothly as estimated.
    SmoothInTime,
}

/// A number with its 95 % band.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Banded {
    /// Estimated value.
    pub value: f64,
    /// Standard error.
    pub sd: f64,
    /// Lower end of the band.
    pub low: f64,
    /// Upper end of the band.
    pub high: f64,
}

/// One row of the measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasurementRow {
    /// Line in the file.
    pub line: usize,
    /// Instant [s], if the file has a time column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t_s: Option<f64>,
    /// Amplitudes; none for an undetermined one.
    pub amplitudes: Vec<Option<Banded>>,
    /// Combinations of `seen`; none for an undetermined one.
    pub together: Vec<Option<Banded>>,
    /// Measured pressures [Pa], in the order of `bladders`.
    pub measured_pa: Vec<Option<f64>>,
    /// Modelled pressures under the estimated loads [Pa].
    pub modelled_pa: Vec<f64>,
}

/// A set of bladders to measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChosenSensors {
    /// The bladders.
    pub bladders: Vec<i64>,
    /// Standard errors of the amplitudes; none for an undetermined one.
    pub errors: Vec<Option<f64>>,
}
