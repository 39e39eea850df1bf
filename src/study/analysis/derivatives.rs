//! Derivatives of figures with respect to numbers of a case, and systems of cases that differ in such numbers.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::Result;
use crate::run::record::Control;
use crate::run::summary::{Status, Summary};

/// Derivatives of each figure with respect to the numbers, in their order.
pub type FigureSlopes = BTreeMap<String, Vec<f64>>;

/// Stops a run, or a path of equilibria, once `stop` returns true; checked after every step.
pub fn until<T>(stop: &dyn Fn() -> bool) -> impl FnMut(&T) -> Control + '_ {
    |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    }
}

/// Returns the system of a case with the effects of `alike`, if that is given and has the same unknowns; otherwise a
/// new system.
///
/// # Errors
/// Those of [`System::new`].
pub fn alike_or_own(case: &Case, alike: Option<&System>) -> Result<System> {
    let found = alike.map_or(Ok(None), |own| own.like(case))?;
    found.map_or_else(|| System::new(case), Ok)
}

/// Derivatives of the figures of a summary; empty if the run did not finish.
pub(super) fn of_summary(summary: &Summary, parameters: &[Parameter]) -> GatheredDerivatives {
    let mut all = GatheredDerivatives::new(parameters.len());
    if summary.status != Status::Finished {
        return all;
    }
    for (k, parameter) in parameters.iter().enumerate() {
        let Some(found) = summary.sensitivities.get(&parameter.pointer) else {
            continue;
        };
        for (name, quantity) in found.quantities.iter().chain(&found.probes) {
            for (figure, slope) in quantity.figures() {
                all.put(k, format!("{name}.{figure}"), slope);
            }
        }
    }
    all
}

/// Derivatives by figure, possibly incomplete.
pub struct GatheredDerivatives {
    count: usize,
    all: BTreeMap<String, Vec<Option<f64>>>,
}

impl GatheredDerivatives {
    /// Creates an empty collection for `count` numbers.
    pub fn new(count: usize) -> Self {
        Self {
            count,
            all: BTreeMap::new(),
        }
    }

    /// Stores the derivative of a figure with respect to one of the numbers.
    pub fn put(&mut self, number: usize, name: String, slope: f64) {
        let slopes = self.all.entry(name).or_insert_with(|| vec![None; self.count]);
        slopes[number] = Some(slope).filter(|slope| slope.is_finite());
    }

    /// Returns the figures whose derivatives with respect to all numbers are known.
    pub fn whole(self) -> FigureSlopes {
        let known = |(name, slopes): (String, Vec<Option<f64>>)| {
            let slopes: Option<Vec<f64>> = slopes.into_iter().collect();
            Some((name, slopes?))
        };
        self.all.into_iter().filter_map(known).collect()
    }
}
