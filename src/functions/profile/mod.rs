//! Functions of place, `x = theta/l_s` along the beam or `s/l_b` along a bladder.

mod integrals;
mod waves;

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::curve::{Interpolation, PiecewiseCurve};
use super::jet::Jet;
use super::number_or_object::number_or_object;
use super::signals::Polynomial;

pub use integrals::Integrals;

/// A function of place `x` in [0, 1]: a number for a uniform one, else one named form.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Constant(f64),
    /// `amplitude cos(2 pi waves x + phase)`.
    Cosine(Wave),
    /// `amplitude sin(2 pi waves x + phase)`.
    Sine(Wave),
    /// Values at x = 0 and 1, linear between them.
    Linear([f64; 2]),
    /// A polynomial in x.
    Polynomial(Polynomial),
    /// A curve through points.
    Table(PlaceTable),
    /// Sum of profiles.
    Sum(Vec<Profile>),
    /// Product of profiles.
    Product(Vec<Profile>),
}

/// The forms of a profile that are objects.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum NamedProfile {
    /// `amplitude cos(2 pi waves x + phase)`.
    Cosine(Wave),
    /// `amplitude sin(2 pi waves x + phase)`.
    Sine(Wave),
    /// Values at x = 0 and 1, linear between them.
    Linear([f64; 2]),
    /// `c0 + c1 x + c2 x^2 + ...`
    Polynomial(Polynomial),
    /// A curve through points, constant beyond its ends.
    Table(PlaceTable),
    /// Sum of profiles.
    Sum(#[schemars(length(min = 1, max = 1000))] Vec<Profile>),
    /// Product of profiles.
    Product(#[schemars(length(min = 1, max = 1000))] Vec<Profile>),
}

/// A wave along the beam.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Amplitude, in the unit of the quantity.
    #[serde(default = "one")]
    pub amplitude: f64,
    /// Waves along the whole length.
    pub waves: f64,
    /// Phase at x = 0 [rad].
    #[serde(default)]
    pub phase_rad: f64,
}

fn one() -> f64 {
    1.0
}

/// A curve through points, constant beyond its ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "PlaceTableText", into = "PlaceTableText")]
#[schemars(!from, !into, with = "PlaceTableText")]
pub struct PlaceTable {
    /// Places in [0, 1], ascending.
    pub positions: Vec<f64>,
    /// Values there.
    pub values: Vec<f64>,
    /// Interpolation between the points, by default monotone cubics, which stay within the values of the points; a natural spline (`cubic`) is
    /// smoother and swings beyond the values of points that jump.
    pub interpolation: Interpolation,
    pub(super) curve: PiecewiseCurve,
}

/// A curve through points, constant beyond its ends.
#[derive(Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PlaceTable")]
struct PlaceTableText {
    /// Places in [0, 1], ascending.
    #[schemars(length(min = 1), inner(range(min = 0.0, max = 1.0)))]
    positions: Vec<f64>,
    /// Values there.
    #[schemars(length(min = 1))]
    values: Vec<f64>,
    /// Interpolation between the points, by default monotone cubics, which stay within the values of the points; a natural spline (`cubic`) is
    /// smoother and swings beyond the values of points that jump.
    #[serde(default)]
    interpolation: Interpolation,
}

impl From<PlaceTableText> for PlaceTable {
    fn from(text: PlaceTableText) -> Self {
        let PlaceTableText {
            positions,
            values,
            interpolation,
        } = text;
        Self::new(positions, values, interpolation)
    }
}

impl From<PlaceTable> for PlaceTableText {
    fn from(table: PlaceTable) -> Self {
        Self {
            positions: table.positions,
            values: table.values,
            interpolation: table.interpolation,
        }
    }
}

impl PlaceTable {
    /// Table through points; zero if the points do not define a curve.
    pub fn new(positions: Vec<f64>, values: Vec<f64>, interpolation: Interpolation) -> Self {
        let curve = PiecewiseCurve::through(&positions, &values, interpolation).unwrap_or_default();
        Self {
            positions,
            values,
            interpolation,
            curve,
        }
    }

    /// True if the points define a curve.
    pub fn is_sound(&self) -> bool {
        self.curve != PiecewiseCurve::default()
    }
}

number_or_object!(Profile, NamedProfile, "a number or a named profile such as {\"cosine\": {...}}", {
    Cosine = "cosine", Sine = "sine", Linear = "linear", Polynomial = "polynomial", Table = "table", Sum = "sum", Product = "product",
});

impl Profile {
    /// Value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.jet(x).value
    }

    /// True for a constant.
    pub fn is_uniform(&self) -> bool {
        matches!(self, Self::Constant(_))
    }

    /// Derivative by `x` at `x`.
    pub fn slope(&self, x: f64) -> f64 {
        self.jet(x).rate
    }

    /// Largest overshoot of a spline in the profile, relative to the range of its values; 0 without splines.
    pub fn overshoot(&self) -> f64 {
        match self {
            Self::Table(table) => table.curve.overshoot(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().map(Self::overshoot).fold(0.0, f64::max),
            _ => 0.0,
        }
    }

    /// Value and derivatives with respect to `x`.
    pub fn jet(&self, x: f64) -> Jet {
        match self {
            Self::Constant(value) => Jet::constant(*value),
            Self::Cosine(wave) => wave.cosine(x),
            Self::Sine(wave) => wave.sine(x),
            Self::Linear(ends) => line(ends).jet(x),
            Self::Polynomial(polynomial) => polynomial.jet(x),
            Self::Table(table) => table.curve.at(x),
            Self::Sum(terms) => terms.iter().fold(Jet::default(), |sum, term| sum + term.jet(x)),
            Self::Product(factors) => factors.iter().fold(Jet::constant(1.0), |product, f| product * f.jet(x)),
        }
    }
}

/// Polynomial with these values at 0 and 1.
pub(super) fn line([root, tip]: &[f64; 2]) -> Polynomial {
    Polynomial {
        coefficients: vec![*root, tip - root],
    }
}

impl Wave {
    fn sine(&self, x: f64) -> Jet {
        let (a, k) = (self.amplitude, TAU * self.waves);
        let (sin, cos) = (k * x + self.phase_rad).sin_cos();
        Jet {
            value: a * sin,
            rate: a * k * cos,
            acceleration: -a * k * k * sin,
            jerk: -a * k * k * k * cos,
        }
    }

    fn cosine(&self, x: f64) -> Jet {
        let (a, k) = (self.amplitude, TAU * self.waves);
        let (sin, cos) = (k * x + self.phase_rad).sin_cos();
        Jet {
            value: a * cos,
            rate: -a * k * sin,
            acceleration: -a * k * k * cos,
            jerk: a * k * k * k * sin,
        }
    }
}
