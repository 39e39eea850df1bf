//! Pressures in time under loads that are curves through knots: the run itself, with IDA's sensitivities to every value at a knot [E41].

use nalgebra::{DMatrix, DVector};

use super::basis::{Amplitude, loaded};
use super::estimate::Forward;
use crate::case::parameter::Parameter;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::functions::signals::Table;
use crate::functions::{Interpolation, Signal};
use crate::run::dynamics;
use crate::run::sensitivity::forward::By;
use crate::study::analysis::derivatives;
use crate::study::followed::Followed;

/// Equally spaced instants between which a load is a natural cubic spline: one before the start and one after the end, since a natural spline has no
/// curvature at its ends, which a load may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    /// The instants [s].
    pub at: Vec<f64>,
    /// Splines that are 1 at a knot and 0 at the others.
    each: Vec<Signal>,
}

impl Knots {
    /// So many for the time up to an instant; at least [`Knots::FEWEST`].
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

    /// Knots at least: start, middle, end and those beyond.
    pub const FEWEST: usize = 5;

    /// Time between two [s].
    pub fn every(&self) -> f64 {
        self.at[1] - self.at[0]
    }

    /// How much the value at each knot counts at an instant.
    pub fn weights(&self, t: f64) -> Vec<f64> {
        self.each.iter().map(|one| one.value(t)).collect()
    }
}

/// The spline through values at instants.
fn curve(at: &[f64], values: Vec<f64>) -> Signal {
    Signal::Table(Table::new(at.to_vec(), values, Interpolation::Cubic))
}

/// Pressures at instants, row by row, over the values of loads at knots in their sizes: knot by knot all loads.
pub struct InTime<'a> {
    case: &'a Case,
    amplitudes: &'a [Amplitude],
    knots: &'a Knots,
    instants: &'a [f64],
    /// Columns of a run with the pressures.
    names: Vec<String>,
    /// Whose effects every run has: of loads that change as fast as they can.
    system: System,
    /// Asked at every step whether to stop.
    stop: &'a dyn Fn() -> bool,
}

/// Share of the sizes of loads by which effects are chosen.
const CHOOSING: f64 = 0.1;

impl<'a> InTime<'a> {
    /// Of a case with probes at its bladders, `names` their columns.
    ///
    /// # Errors
    /// The case is none with such loads.
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

    /// The case with loads of so many of their sizes at the knots.
    pub fn loaded(&self, values: &[f64]) -> Case {
        with(self.case, self.amplitudes, self.knots, values)
    }

    /// The system of such a case, with the effects that all have.
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

impl Forward for InTime<'_> {
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
        let mut recorder = Followed::new(&self.names, &names, self.instants.len(), self.stop);
        let by = By {
            changed: Some(&changed),
            states_only: true,
            ..By::pointers(&parameters)
        };
        let outcome = dynamics::run_at(&case, self.system(&case)?, by, self.instants, &mut recorder)?;
        if (self.stop)() {
            return Err(interrupted());
        }
        let rows = recorder.of(outcome)?;
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
    Error::Interrupted("interrupted before the loads were found; nothing is written".into())
}
