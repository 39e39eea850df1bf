//! Functions of time with exact derivatives: types and JSON format.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::control::Controller;
use super::curve::{Interpolation, PiecewiseCurve};
pub use super::jet::{Jet, SmoothTime};
use super::number_or_object::number_or_object;

/// A function of time: a number for a constant, else one named form.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// A constant.
    Constant(f64),
    /// A sine, with or without a smooth start.
    Sine(Sine),
    /// A logistic step.
    Sigmoid(Sigmoid),
    /// From one value to another in a given time.
    Ramp(Ramp),
    /// A polynomial in time.
    Polynomial(Polynomial),
    /// A curve through points.
    Table(Table),
    /// Sum of signals.
    Sum(Vec<Signal>),
    /// Product of signals.
    Product(Vec<Signal>),
    /// Output of a controller.
    Controller(Box<Controller>),
}

/// The forms of a signal that are objects.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum NamedSignal {
    /// `amplitude sin(2 pi f t + phase)`, with a smooth start over the first `ramp_cycles`.
    Sine(Sine),
    /// `amplitude/(1 + exp(-steepness (t - midpoint)))`.
    Sigmoid(Sigmoid),
    /// From one value to another in a given time, constant before and after.
    Ramp(Ramp),
    /// `c0 + c1 t + c2 t^2 + ...`
    Polynomial(Polynomial),
    /// A curve through points, constant beyond its ends.
    Table(Table),
    /// Sum of signals.
    Sum(#[schemars(length(min = 1, max = 1000))] Vec<Signal>),
    /// Product of signals.
    Product(#[schemars(length(min = 1, max = 1000))] Vec<Signal>),
    /// Output of a controller, which measures a quantity of the run.
    Controller(Box<Controller>),
}

/// `amplitude r(min(t f/ramp_cycles, 1)) sin(2 pi f t + phase)`, `r(s) = 10 s^3 - 15 s^4 + 6 s^5`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Amplitude, in the unit of the quantity.
    pub amplitude: f64,
    /// Frequency `f` [Hz].
    #[schemars(range(min = 0.0))]
    pub frequency_hz: f64,
    /// Phase at t = 0 [rad].
    #[serde(default)]
    pub phase_rad: f64,
    /// Cycles over which the sine grows to its amplitude; 0: impulsive start.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub ramp_cycles: f64,
}

/// `amplitude/(1 + exp(-steepness (t - midpoint)))`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sigmoid {
    /// Value reached in the end, in the unit of the quantity.
    pub amplitude: f64,
    /// Steepness [1/s].
    pub steepness_per_s: f64,
    /// When half the amplitude is reached [s].
    pub midpoint_s: f64,
}

/// From one value to another in a given time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// Value before.
    #[serde(default)]
    pub from: f64,
    /// Value after.
    pub to: f64,
    /// When it starts [s].
    #[serde(default)]
    pub start_s: f64,
    /// Duration [s]; 0: a step.
    #[schemars(range(min = 0.0))]
    pub duration_s: f64,
    /// Form of the transition.
    #[serde(default)]
    pub shape: RampShape,
}

/// Form of a ramp.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RampShape {
    /// A straight line: the rate jumps at both ends.
    Linear,
    /// `r(s) = 10 s^3 - 15 s^4 + 6 s^5`: rate and acceleration are continuous.
    #[default]
    Smooth,
}

/// `c0 + c1 x + c2 x^2 + ...`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Polynomial {
    /// `c0, c1, c2, ...`
    #[schemars(length(min = 1))]
    pub coefficients: Vec<f64>,
}

/// A curve through points, given here or in a CSV file; constant beyond its ends, or repeated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "TableText", into = "TableText")]
#[schemars(!try_from, !into, with = "TableText")]
pub struct Table {
    /// Times, ascending [s]; two equal times define a jump.
    pub times_s: Vec<f64>,
    /// Values at these times.
    pub values: Vec<f64>,
    /// Interpolation between the points, by default monotone cubics, which stay within the values of the points; a natural spline (`cubic`) is
    /// smoother and swings beyond the values of points that jump.
    pub interpolation: Interpolation,
    /// True if the table repeats periodically in both directions.
    pub repeat: bool,
    pub(super) curve: PiecewiseCurve,
}

/// A curve through points: either `times_s` and `values`, or a CSV file with a heading for each column.
#[derive(Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Table")]
pub(super) struct TableText {
    /// Times, ascending [s]. A time that stands twice is a jump from the first of its values to the second.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    times_s: Vec<f64>,
    /// Values at these times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    values: Vec<f64>,
    /// CSV file to take the points from, relative to the case file: a line of headings, then numbers. A heading gives
    /// the unit of its column behind its name or in brackets (`t_ms`, `p_kpa`, `flow [ml/min]`); without one it is in
    /// SI units.
    #[serde(default, skip_serializing)]
    csv: Option<String>,
    /// Heading of the column with the times; absent: the first column. In the unit that it names, else in s.
    #[serde(default, skip_serializing)]
    time_column: Option<String>,
    /// Heading of the column with the values; absent: the second column. In the unit that it names, which must be one
    /// of the quantity's, else in the unit of the key under which the table stands.
    #[serde(default, skip_serializing)]
    value_column: Option<String>,
    /// Checksum of the points that the file holds, as the program writes it; a file with other points is refused.
    #[serde(default, skip_serializing)]
    checksum: Option<String>,
    /// Interpolation between the points, by default monotone cubics, which stay within the values of the points; a natural spline (`cubic`) is
    /// smoother and swings beyond the values of points that jump.
    #[serde(default)]
    interpolation: Interpolation,
    /// Repeats the table for ever, with the time from its first point to its last as period. Where the last value is
    /// not the first, it jumps from one to the other.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    repeat: bool,
}

impl TryFrom<TableText> for Table {
    type Error = &'static str;
    fn try_from(text: TableText) -> Result<Self, Self::Error> {
        // CSV files are read with the case, see `tables`.
        match (text.csv, text.time_column, text.value_column, text.checksum) {
            (None, None, None, None) => Ok(Self::repeated(
                text.times_s,
                text.values,
                text.interpolation,
                text.repeat,
            )),
            _ => Err("a table whose CSV file has not been read"),
        }
    }
}

impl From<Table> for TableText {
    fn from(table: Table) -> Self {
        let Table {
            times_s,
            values,
            interpolation,
            repeat,
            ..
        } = table;
        Self {
            times_s,
            values,
            interpolation,
            repeat,
            ..Self::default()
        }
    }
}

impl Table {
    /// Table through points. Points that do not define a curve (times not ascending, or numbers of times and values
    /// differ) give a zero signal; [`super::check`] rejects them.
    pub fn new(times_s: Vec<f64>, values: Vec<f64>, interpolation: Interpolation) -> Self {
        Self::repeated(times_s, values, interpolation, false)
    }

    fn repeated(times_s: Vec<f64>, values: Vec<f64>, interpolation: Interpolation, repeat: bool) -> Self {
        let curve = match repeat {
            true => PiecewiseCurve::repeated(&times_s, &values, interpolation),
            false => PiecewiseCurve::with_jumps(&times_s, &values, interpolation),
        };
        Self {
            times_s,
            values,
            interpolation,
            repeat,
            curve: curve.unwrap_or_default(),
        }
    }

    /// Table with a given curve.
    pub fn from_curve(curve: PiecewiseCurve) -> Self {
        let (times_s, values) = curve.points();
        Self {
            times_s,
            values,
            interpolation: Interpolation::Monotone,
            repeat: false,
            curve,
        }
    }

    /// Period [s] of a repeated table; none for others.
    pub fn period_s(&self) -> Option<f64> {
        let [first, last] = self.curve.ends().filter(|_| self.repeat)?;
        Some(last - first)
    }

    /// True if the points define a curve.
    pub fn is_sound(&self) -> bool {
        self.curve != PiecewiseCurve::default()
    }
}

number_or_object!(Signal, NamedSignal, "a number or a named signal such as {\"sine\": {...}}", {
    Sine = "sine", Sigmoid = "sigmoid", Ramp = "ramp", Polynomial = "polynomial",
    Table = "table", Sum = "sum", Product = "product", Controller = "controller",
});
