//! Coefficients of a beam from laboratory data, with errors: the experiments of A.4.1 and A.4.2 of the paper.
//!
//! ```text
//! y = g x + a [+ c x^3]                                             least squares, equal weights
//! pressure-volume     a_p  = g/(n l_b)                              n bladders are pumped
//! moment-volume       a_M  = g/(n l_b), where bending opens and closes
//! force-volume        a_N  = g/(n l_b), under tension and compression
//! force-extension     f_e  = l/(g E h w)
//! moment-curvature    f_i  = 12/(g E h^3 w)
//! pressure-curvature  psi' = |g| E/phi,  a_M = |g|/(phi l_b)        one row is pumped, reciprocal coupling
//! flow-pressure       q_1  = g mu L                                 along a duct of length L
//! ```
//!
//! The interval contains the truth in 95 of 100 repetitions if deviations are normal, independent and of equal variance (Student's t). Two
//! terms test whether a straight line is right: x^3, and |x|, which gives each side of zero its own slope.

pub mod table;

use crate::case::Case;
use crate::error::numbers::counted;
use crate::error::{Error, Result};
use crate::numerics::regression::{self, Regression};
use table::{MeasuredQuantity, Points};

/// Experiment: the relation that was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Volume of pumped bladders over pressure.
    PressureVolume,
    /// Volume of bladders over the bending moment.
    MomentVolume,
    /// Volume of bladders over the normal force.
    ForceVolume,
    /// Change of the beam's length over the normal force.
    ForceExtension,
    /// Curvature over the bending moment.
    MomentCurvature,
    /// Curvature over the pressure of one row, or its excess over that of the other.
    PressureCurvature,
    /// Flow through a duct over the difference of pressure along it.
    FlowPressure,
}

impl Experiment {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::PressureVolume,
        Self::MomentVolume,
        Self::ForceVolume,
        Self::ForceExtension,
        Self::MomentCurvature,
        Self::PressureCurvature,
        Self::FlowPressure,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::PressureVolume => "pressure-volume",
            Self::MomentVolume => "moment-volume",
            Self::ForceVolume => "force-volume",
            Self::ForceExtension => "force-extension",
            Self::MomentCurvature => "moment-curvature",
            Self::PressureCurvature => "pressure-curvature",
            Self::FlowPressure => "flow-pressure",
        }
    }

    /// Returns the quantity that is set, and the quantity that is measured.
    pub fn columns(self) -> [MeasuredQuantity; 2] {
        match self {
            Self::PressureVolume => [MeasuredQuantity::Pressure, MeasuredQuantity::Volume],
            Self::MomentVolume => [MeasuredQuantity::Moment, MeasuredQuantity::Volume],
            Self::ForceVolume => [MeasuredQuantity::Force, MeasuredQuantity::Volume],
            Self::ForceExtension => [MeasuredQuantity::Force, MeasuredQuantity::Extension],
            Self::MomentCurvature => [MeasuredQuantity::Moment, MeasuredQuantity::Curvature],
            Self::PressureCurvature => [MeasuredQuantity::Pressure, MeasuredQuantity::Curvature],
            Self::FlowPressure => [MeasuredQuantity::Pressure, MeasuredQuantity::Flow],
        }
    }
}

/// Options of the fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeasureOptions {
    /// True if the line passes through zero.
    pub through_zero: bool,
    /// True if the fit has a cubic term.
    pub cubic: bool,
    /// Number of bladders that are pumped or observed; by default those of one row.
    pub bladders: Option<u32>,
    /// True if the duct is a bladder, false if it is a tube.
    pub through_bladder: bool,
}

/// A number with its errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredNumber {
    /// Most likely value.
    pub value: f64,
    /// Standard error.
    pub error: f64,
    /// Interval of 95 %.
    pub interval: [f64; 2],
}

impl MeasuredNumber {
    fn from_fit(fit: &Regression, weights: &[f64]) -> Self {
        let (value, half) = (fit.value(weights), fit.half_width(weights));
        Self {
            value,
            error: fit.error(weights),
            interval: [value - half, value + half],
        }
    }

    /// Multiplies by a factor.
    fn times(self, factor: f64) -> Self {
        let [a, b] = self.interval.map(|x| x * factor);
        Self {
            value: self.value * factor,
            error: self.error * factor.abs(),
            interval: [a.min(b), a.max(b)],
        }
    }

    /// Divides a factor by the estimate; `None` if the interval contains zero.
    fn under(self, factor: f64) -> Option<Self> {
        let [a, b] = self.interval;
        (a * b > 0.0).then(|| Self {
            value: factor / self.value,
            error: (factor * self.error / (self.value * self.value)).abs(),
            interval: [(factor / a).min(factor / b), (factor / a).max(factor / b)],
        })
    }

    /// Returns the estimate with positive sign: areas are positive where the bladder opens.
    fn upright(self) -> Self {
        if self.value < 0.0 { self.times(-1.0) } else { self }
    }
}

/// Slopes on both sides of zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sides {
    /// Probability of slopes that differ at least as much if the true slopes are equal.
    pub chance: f64,
    /// Slope above zero.
    pub above: MeasuredNumber,
    /// Slope below zero.
    pub below: MeasuredNumber,
}

/// A coefficient of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// JSON pointer of its key.
    pub pointer: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Estimate.
    pub estimate: MeasuredNumber,
}

/// Result of a measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// The experiment.
    pub experiment: Experiment,
    /// The data [SI].
    pub points: Points,
    /// Fit: slope, then offset and cubic term, if it has them.
    pub fit: Regression,
    /// Slope.
    pub slope: MeasuredNumber,
    /// Value at zero, if it is fitted.
    pub offset: Option<MeasuredNumber>,
    /// Share of the data's variance that the fit explains; for lines through zero, of the mean square.
    pub explained: f64,
    /// Probability of a cubic term as large if there is none; `None` if there are too few points.
    pub cubic_chance: Option<f64>,
    /// Slopes on both sides of zero; `None` with fewer than three points on one of them.
    pub sides: Option<Sides>,
    /// Coefficients of the case.
    pub coefficients: Vec<Coefficient>,
    options: MeasureOptions,
}

/// Significance level below which a deviation from the straight line is reported and slopes of both sides are used.
pub const SIGNIFICANT: f64 = 0.05;

/// Regressors of the fit at a value of the set quantity.
fn regressors(options: MeasureOptions, x: f64) -> Vec<f64> {
    let offset = (!options.through_zero).then_some(1.0);
    let cubic = options.cubic.then_some(x.powi(3));
    [Some(x), offset, cubic].into_iter().flatten().collect()
}

fn columns(points: &Points, of: impl Fn(f64) -> Vec<f64>) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = points.x.iter().map(|x| of(*x)).collect();
    let width = rows.first().map_or(0, Vec::len);
    (0..width).map(|k| rows.iter().map(|row| row[k]).collect()).collect()
}

/// Fits the data and turns the slope into coefficients of a case.
///
/// # Errors
/// [`Error::Usage`]: too few points, a slope not significantly different from zero, or a case without data that the coefficient needs.
pub fn measure(experiment: Experiment, points: Points, case: &Case, options: MeasureOptions) -> Result<Measurement> {
    let [x, y] = experiment.columns();
    let fit = regression::fit(&columns(&points, |x| regressors(options, x)), &points.y).ok_or_else(|| {
        let needed = regressors(options, 1.0).len() + 1;
        Error::Usage(format!(
            "too few for the fit: {} of {}. The fit needs {needed}, with as many different values of {}",
            counted(points.x.len() as u64, "point"),
            y.name(),
            x.name()
        ))
    })?;
    let unit = |k: usize| {
        (0..fit.coefficients.len())
            .map(|j| f64::from(u8::from(j == k)))
            .collect::<Vec<_>>()
    };
    let slope = MeasuredNumber::from_fit(&fit, &unit(0));
    let offset = (!options.through_zero).then(|| MeasuredNumber::from_fit(&fit, &unit(1)));
    let with = |extra: fn(f64) -> f64| {
        let of = |x: f64| {
            let mut row = regressors(
                MeasureOptions {
                    cubic: false,
                    ..options
                },
                x,
            );
            row.push(extra(x));
            row
        };
        regression::fit(&columns(&points, of), &points.y)
    };
    let cubic_chance = with(|x| x.powi(3)).map(|fit| fit.chance(fit.coefficients.len() - 1));
    let both = points.x.iter().filter(|x| **x > 0.0).count() > 2 && points.x.iter().filter(|x| **x < 0.0).count() > 2;
    let sides = with(f64::abs).filter(|_| both).map(|fit| {
        let last = fit.coefficients.len() - 1;
        let side = |sign: f64| {
            let weights: Vec<f64> = (0..=last)
                .map(|k| {
                    if k == 0 {
                        1.0
                    } else if k == last {
                        sign
                    } else {
                        0.0
                    }
                })
                .collect();
            MeasuredNumber::from_fit(&fit, &weights)
        };
        Sides {
            chance: fit.chance(last),
            above: side(1.0),
            below: side(-1.0),
        }
    });
    let mean = if options.through_zero {
        0.0
    } else {
        points.y.iter().sum::<f64>() / points.y.len() as f64
    };
    let total: f64 = points.y.iter().map(|y| (y - mean).powi(2)).sum();
    let left: f64 = fit.residuals.iter().map(|e| e * e).sum();
    let coefficients = coefficients(experiment, case, options, slope, sides)?;
    for Coefficient { pointer, estimate, .. } in &coefficients {
        let sizes = [estimate.value, estimate.error, total, left];
        if estimate.value <= 0.0 || sizes.iter().any(|size| !size.is_finite()) {
            let value = estimate.value;
            return Err(Error::Usage(format!(
                "these data give {pointer} = {value:.4e}, but a case needs a finite positive number. Check signs and \
                 units of the columns"
            )));
        }
    }
    Ok(Measurement {
        experiment,
        explained: if total > 0.0 { 1.0 - left / total } else { 0.0 },
        slope,
        offset,
        fit,
        points,
        cubic_chance,
        sides,
        coefficients,
        options,
    })
}

impl Measurement {
    /// Fit at a value of the set quantity, and half the width of the band that contains the true curve there in 95 of 100 repetitions.
    pub fn at(&self, x: f64) -> [f64; 2] {
        let row = regressors(self.options, x);
        [self.fit.value(&row), self.fit.half_width(&row)]
    }
}

/// Computes coefficients by the equations above.
fn coefficients(
    experiment: Experiment,
    case: &Case,
    options: MeasureOptions,
    slope: MeasuredNumber,
    sides: Option<Sides>,
) -> Result<Vec<Coefficient>> {
    let lacks = |what: &str| Error::Usage(format!("the case has no {what}, which {} needs", experiment.name()));
    let beam = &case.beam;
    let (l, h, w, young) = (beam.length_m, beam.height_m, beam.width_m, beam.young_modulus_pa);
    let bladders = || case.bladders.as_ref().ok_or_else(|| lacks("bladders"));
    let per_length = || bladders().map(|b| 1.0 / (options.bladders.map_or(b.per_row as f64, f64::from) * b.length_m));
    let nonzero = |estimate: Option<MeasuredNumber>| {
        let what = "the slope is not significantly different from zero: its interval contains both signs";
        estimate.ok_or_else(|| Error::Usage(what.into()))
    };
    let one = |pointer, unit, estimate| Coefficient {
        pointer,
        unit,
        estimate,
    };
    // slopes above and below zero; a single slope if they do not differ significantly
    let split = |factor: f64| {
        let apart = sides.filter(|sides| sides.chance < SIGNIFICANT);
        let pair = apart.map_or([slope, slope], |sides| [sides.above, sides.below]);
        pair.map(|estimate| estimate.times(factor).upright())
    };
    Ok(match experiment {
        Experiment::PressureVolume => vec![one(
            "/bladders/area_per_pressure_m2_per_pa",
            "m^2/Pa",
            slope.times(per_length()?),
        )],
        Experiment::MomentVolume => {
            let [above, below] = split(per_length()?);
            // a moment above zero opens the bladders if their volume grows with it
            let [opening, closing] = if slope.value > 0.0 {
                [above, below]
            } else {
                [below, above]
            };
            vec![
                one("/bladders/area_per_moment_m2_per_n_m/opening", "m^2/(N m)", opening),
                one("/bladders/area_per_moment_m2_per_n_m/closing", "m^2/(N m)", closing),
            ]
        }
        Experiment::ForceVolume => {
            let [tension, compression] = split(per_length()?);
            vec![
                one("/bladders/area_per_force_m2_per_n/tension", "m^2/N", tension),
                one("/bladders/area_per_force_m2_per_n/compression", "m^2/N", compression),
            ]
        }
        Experiment::ForceExtension => {
            let factor = nonzero(slope.under(l / (young * h * w)))?;
            vec![one("/beam/axial_stiffness_factor", "1", factor)]
        }
        Experiment::MomentCurvature => {
            let factor = nonzero(slope.under(12.0 / (young * h.powi(3) * w)))?.upright();
            vec![one("/beam/bending_stiffness_factor", "1", factor)]
        }
        Experiment::PressureCurvature => {
            let bladders = bladders()?;
            let pitch = l / bladders.per_row as f64;
            let area = slope.upright().times(pitch / bladders.length_m);
            vec![
                one("/bladders/area_per_moment_m2_per_n_m/opening", "m^2/(N m)", area),
                one("/bladders/area_per_moment_m2_per_n_m/closing", "m^2/(N m)", area),
                one(
                    "/bladders/coupling/published/slope_per_pressure_rad",
                    "rad",
                    slope.upright().times(young * pitch),
                ),
            ]
        }
        Experiment::FlowPressure => {
            let viscosity = case.fluid.as_ref().ok_or_else(|| lacks("fluid"))?.viscosity_pa_s;
            let (pointer, length) = match options.through_bladder {
                true => ("/bladders/permeability_m4", bladders()?.length_m),
                false => (
                    "/tubes/permeability_m4",
                    case.tubes.as_ref().ok_or_else(|| lacks("tubes"))?.length_m,
                ),
            };
            vec![one(pointer, "m^4", slope.upright().times(viscosity * length))]
        }
    })
}
