//! Pressures over time under loads that are splines. The run computes IDA's sensitivities to the value at every knot [E41].

use nalgebra::{DMatrix, DVector};

use super::basis::{Amplitude, loaded};
use super::estimate::ForwardModel;
use crate::case::parameter::Parameter;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::functions::signals::Table;
use crate::functions::{Interpolation, Signal};
use crate::run::dynamics;
use crate::run::sensitivity::forward::DerivativeParameters;
use crate::study::analysis::derivatives;
use crate::study::followed::ColumnRecorder;

/// Equally spaced knots of natural cubic splines. One lies before the start and one after the end: a natural spline has zero curvature at
/// its ends, a load need not.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    /// Knots [s].
    pub at: Vec<f64>,
    /// Cardinal splines: 1 at one knot and 0 at the others.
    each: Vec<Signal>,
}

impl Knots {
    /// `count` knots for the time from 0 to `end` [s]; at least [`Knots::FEWEST`].
    pub fn new(count: usize, end: f64) -> Self {
        let every = end / (count - 3) as f64;
        let at: Vec<f64> = (0..count).map(|m| (m as f64 - 1.0) * every).collect();
        let one = |m: usize| {
            let values = (0..count).map(|k| f64::from(u8::from(k == m)));
            curve(&at, values.collect())
        };
        Self {
            each: (0..count).map(one).collect(),
            at,
        }
    }

    /// Smallest number of knots: start, middle, end and one beyond each end.
    pub const FEWEST: usize = 5;

    /// Spacing of the knots [s].
    pub fn every(&self) -> f64 {
        self.at[1] - self.at[0]
    }

    /// Weight of the value at each knot at an instant.
    pub fn weights(&self, t: f64) -> Vec<f64> {
        self.each.iter().map(|one| one.value(t)).collect()
    }
}

/// Cubic spline through given values.
fn curve(at: &[f64], values: Vec<f64>) -> Signal {
    Signal::Table(Table::new(at.to_vec(), values, Interpolation::Cubic))
}

/// Pressures at the instants, row by row, as a function of the loads at the knots over their sizes. Knots vary slowest, loads fastest.
pub struct InTime<'a> {
    case: &'a Case,
    amplitudes: &'a [Amplitude],
    knots: &'a Knots,
    instants: &'a [f64],
    /// Names of the pressure columns.
    names: Vec<String>,
    /// System whose effects are used in every run; chosen for loads that alternate from knot to knot.
    system: System,
    /// Stop request, checked at every step.
    stop: &'a dyn Fn() -> bool,
}

/// Loads, in their sizes, for which the effects are chosen.
const CHOOSING: f64 = 0.1;

impl<'a> InTime<'a> {
    /// For a case with probes at its bladders; `names` are the pressure columns.
    ///
    /// # Errors
    /// Those of [`System::new`] for the case with such loads.
    pub fn new(
        case: &'a Case,
        names: Vec<String>,
        amplitudes: &'a [Amplitude],
        knots: &'a Knots,
        instants: &'a [f64],
        stop: &'a dyn Fn() -> bool,
    ) -> Result<Self> {
        let count = amplitudes.len();
        let to_and_fro = |k: usize| {
            if (k / count).is_multiple_of(2) {
                CHOOSING
            } else {
                -CHOOSING
            }
        };
        let values: Vec<f64> = (0..knots.at.len() * count).map(to_and_fro).collect();
        Ok(Self {
            system: System::new(&with(case, amplitudes, knots, &values))?,
            case,
            amplitudes,
            knots,
            instants,
            names,
            stop,
        })
    }

    /// The case with loads of the given values at the knots, over their sizes.
    pub fn loaded(&self, values: &[f64]) -> Case {
        with(self.case, self.amplitudes, self.knots, values)
    }

    /// System of a case, with the common effects if it has the same unknowns.
    ///
    /// # Errors
    /// Those of [`System::new`].
    pub fn system(&self, case: &Case) -> Result<System> {
        derivatives::alike_or_own(case, Some(&self.system))
    }
}

fn with(case: &Case, amplitudes: &[Amplitude], knots: &Knots, values: &[f64]) -> Case {
    let count = amplitudes.len();
    let signals = amplitudes.iter().enumerate().map(|(k, amplitude)| {
        let own = (0..knots.at.len()).map(|m| values[m * count + k] * amplitude.size);
        curve(&knots.at, own.collect())
    });
    loaded(case, amplitudes, signals)
}

impl ForwardModel for InTime<'_> {
    fn at(&mut self, values: &[f64]) -> Result<(DVector<f64>, DMatrix<f64>)> {
        if (self.stop)() {
            return Err(interrupted());
        }
        let case = self.loaded(values);
        let count = self.amplitudes.len();
        let parameters: Vec<Parameter> = (0..values.len())
            .map(|k| Parameter {
                pointer: format!("{} at {} s", self.amplitudes[k % count].name, self.knots.at[k / count]),
                value: 1.0,
            })
            .collect();
        let changed = |k: usize, value: f64| {
            let mut there = values.to_vec();
            there[k] += value - parameters[k].value;
            Ok(self.loaded(&there))
        };
        let names: Vec<&str> = parameters.iter().map(|one| one.pointer.as_str()).collect();
        let mut recorder = ColumnRecorder::new(&self.names, &names, self.instants.len(), self.stop);
        let by = DerivativeParameters {
            changed: Some(&changed),
            states_only: true,
            ..DerivativeParameters::pointers(&parameters)
        };
        let outcome = dynamics::run_at(&case, self.system(&case)?, by, self.instants, &mut recorder)?;
        if (self.stop)() {
            return Err(interrupted());
        }
        let rows = recorder.rows(outcome)?;
        let each = self.names.len();
        let size = rows.len() * each;
        let pressures = DVector::from_fn(size, |k, _| rows[k / each].0[k % each]);
        let slopes = DMatrix::from_fn(size, values.len(), |k, j| rows[k / each].1[j][k % each]);
        Ok((pressures, slopes))
    }

    fn grain(&self) -> f64 {
        self.case.solver.rtol
    }

    fn patience(&self) -> [u32; 2] {
        [12, 4]
    }
}

pub(super) fn interrupted() -> Error {
    Error::Interrupted("interrupted before the loads were estimated. No results are written".into())
}
