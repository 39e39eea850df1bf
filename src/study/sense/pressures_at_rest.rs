//! Computes pressures at rest under given loads.

use nalgebra::{DMatrix, DVector};

use super::basis::{Amplitude, loaded};
use super::estimate::ForwardModel;
use super::in_time::interrupted;
use crate::case::parameter::change;
use crate::case::schema::{Case, Probe};
use crate::case::spans;
use crate::case::wiring::bladder_label;
use crate::error::{Error, Result};
use crate::functions::Signal;
use crate::functions::signals::{Ramp, RampShape};
use crate::run::equilibrium::{self, EquilibriumOptions, KnownEquilibrium, ParameterDirection};

/// Adds a probe in the middle of each pair of bladders. Returns the case and the names of the pressure columns, upper row first.
///
/// # Errors
/// [`Error::Usage`] if the case has no bladders with fluid.
pub fn probed(case: &Case) -> Result<(Case, Vec<String>)> {
    let per_row = match &case.bladders {
        Some(bladders) if case.fluid.is_some() => bladders.per_row,
        _ => {
            return Err(Error::Usage(
                "the case has no fluid-filled bladders, so there are no pressures to measure".into(),
            ));
        }
    };
    let mut case = case.clone();
    let taken = |name: &str| case.probes.iter().any(|probe| probe.name.starts_with(name));
    let mut begin = "sense".to_owned();
    while taken(&begin) {
        begin.push('-');
    }
    let names = [1, -1].map(|row| {
        let end = if row > 0 { "pressure_upper" } else { "pressure_lower" };
        let begin = &begin;
        (1..=per_row).map(move |j| format!("{begin}-{j}_{end}"))
    });
    let names = names.into_iter().flatten().collect();
    let ends = spans::segment_ends(&case);
    let middle = |j: usize| 0.5 * (ends[j - 1] + ends[j]) / case.beam.length_m;
    let probes = (1..=per_row).map(|j| Probe {
        name: format!("{begin}-{j}"),
        at: middle(j),
    });
    let probes: Vec<Probe> = probes.collect();
    case.probes.extend(probes);
    Ok((case, names))
}

/// Labels of the bladders, in the order of their pressures.
pub fn labels(case: &Case) -> Vec<i64> {
    let per_row = case.bladders.as_ref().map_or(0, |bladders| bladders.per_row);
    (0..2 * per_row).map(|b| bladder_label(b, per_row)).collect()
}

/// Pressures of all bladders at rest, as a function of load amplitudes over their sizes.
#[derive(Clone)]
pub struct AtRest<'a> {
    case: &'a Case,
    amplitudes: &'a [Amplitude],
    options: &'a EquilibriumOptions,
    /// Columns of the pressures in a state.
    columns: Vec<usize>,
    /// The last state.
    last: KnownEquilibrium,
    /// Closing time [s] of the last valve, if a valve traps fluid. The estimated loads begin then.
    since: Option<f64>,
    /// Stop request, checked before every state.
    stop: Option<&'a dyn Fn() -> bool>,
}

/// Sensitivity [Pa] below which a pressure counts as independent of the loads, such as that of a port. It is the change under loads that
/// bend the beam by its length.
const NOTHING: f64 = 1e-6;

impl<'a> AtRest<'a> {
    /// Starts from the case's own loads; `case` and `names` are those of [`probed`].
    ///
    /// # Errors
    /// There is no such state.
    pub fn new(
        case: &'a Case,
        names: &[String],
        amplitudes: &'a [Amplitude],
        options: &'a EquilibriumOptions,
    ) -> Result<Self> {
        // fluid behind a closed valve was trapped before the estimated loads began
        let since = options.resolved(case)?.via_s.last().copied();
        let own = with(case, amplitudes, &vec![0.0; amplitudes.len()], since);
        // the columns of a state depend on which loads there are
        let columns = equilibrium::columns(&equilibrium::system(&own, options.at_s)?);
        let place = |name: &String| columns.iter().position(|column| column.name == *name);
        let columns: Vec<usize> = names.iter().filter_map(place).collect();
        if columns.len() != names.len() {
            return Err(Error::Usage(
                "the effects of the case omit its fluid, so there are no pressures to measure".into(),
            ));
        }
        Ok(Self {
            last: KnownEquilibrium::follow(&own, options)?,
            case,
            amplitudes,
            options,
            columns,
            since,
            stop: None,
        })
    }

    /// Sets a stop request that is checked before every state.
    pub fn until(mut self, stop: &'a dyn Fn() -> bool) -> Self {
        self.stop = Some(stop);
        self
    }

    /// Pressures on the path from rest to these loads, and warnings of the path, except that of trapped fluid.
    ///
    /// # Errors
    /// There is no such path.
    pub fn followed(&self, amplitudes: &[f64]) -> Result<(DVector<f64>, Vec<String>)> {
        let case = with(self.case, self.amplitudes, amplitudes, self.since);
        let mut there = KnownEquilibrium::follow(&case, self.options)?;
        there.path.trapped = None;
        Ok((self.pressures(&there), there.path.warnings()))
    }

    fn pressures(&self, state: &KnownEquilibrium) -> DVector<f64> {
        let row = state.row();
        DVector::from_iterator(self.columns.len(), self.columns.iter().map(|k| row[*k]))
    }

    /// Pressures under loads, without derivatives.
    ///
    /// # Errors
    /// There is no such state.
    pub fn go(&mut self, amplitudes: &[f64]) -> Result<DVector<f64>> {
        if self.stop.is_some_and(|stop| stop()) {
            return Err(interrupted());
        }
        let case = with(self.case, self.amplitudes, amplitudes, self.since);
        self.last = match self.last.beside(&case, self.options)? {
            Some(there) => there,
            None => KnownEquilibrium::follow(&case, self.options)?,
        };
        Ok(self.pressures(&self.last))
    }
}

/// The case with loads of the given sizes, from the instant `since` on if there is one.
fn with(case: &Case, amplitudes: &[Amplitude], sizes: &[f64], since: Option<f64>) -> Case {
    let signal = |load: f64| match since {
        None => Signal::Constant(load),
        Some(start_s) => Signal::Ramp(Ramp {
            from: 0.0,
            to: load,
            start_s,
            duration_s: 0.0,
            shape: RampShape::Linear,
        }),
    };
    let signals = amplitudes.iter().zip(sizes).map(|(a, size)| signal(a.size * size));
    loaded(case, amplitudes, signals)
}

impl ForwardModel for AtRest<'_> {
    fn at(&mut self, amplitudes: &[f64]) -> Result<(DVector<f64>, DMatrix<f64>)> {
        let values = self.go(amplitudes)?;
        let direction = |(k, amplitude): (usize, &Amplitude)| {
            let (own, all, since) = (self.case, self.amplitudes, self.since);
            let from = amplitudes.to_vec();
            ParameterDirection {
                name: format!("--load {}", amplitude.name),
                step: change(own),
                moved: Box::new(move |steps| {
                    let mut there = from.clone();
                    there[k] += steps * change(own);
                    Ok(with(own, all, &there, since))
                }),
            }
        };
        let directions: Vec<ParameterDirection> = self.amplitudes.iter().enumerate().map(direction).collect();
        let case = with(self.case, self.amplitudes, amplitudes, self.since);
        let derivatives = self.last.along(&case, self.options, &directions)?;
        let mut jacobian = DMatrix::from_fn(self.columns.len(), derivatives.len(), |i, j| {
            derivatives[j].row[self.columns[i]]
        });
        for mut row in jacobian.row_iter_mut().filter(|row| row.amax() < NOTHING) {
            row.fill(0.0);
        }
        Ok((values, jacobian))
    }
}
