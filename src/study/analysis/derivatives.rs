//! Derivatives of figures by numbers of a case, and the systems of cases that differ in such numbers.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::parameter::Parameter;
use crate::discrete::System;
use crate::error::Result;
use crate::run::record::Control;
use crate::run::summary::{Status, Summary};

/// Derivatives by figure, each by the numbers in their order.
pub type Slopes = BTreeMap<String, Vec<f64>>;

/// Stops a run, or a path of equilibria, once `stop` is true; asked after every step.
pub fn until<T>(stop: &dyn Fn() -> bool) -> impl FnMut(&T) -> Control + '_ {
    |_| match stop() {
        true => Control::Stop("interrupted".into()),
        false => Control::Continue,
    }
}

/// The system of a case with the effects of another, where that is given and has the same unknowns.
///
/// # Errors
/// Those of [`System::new`].
pub fn alike_or_own(case: &Case, alike: Option<&System>) -> Result<System> {
    let found = alike.map_or(Ok(None), |own| own.like(case))?;
    found.map_or_else(|| System::new(case), Ok)
}

/// Derivatives of the figures of a summary; none of what did not finish.
pub(super) fn of_summary(summary: &Summary, parameters: &[Parameter]) -> Gathered {
    let mut all = Gathered::new(parameters.len());
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

/// Slopes by figure, as far as they are known.
pub struct Gathered {
    count: usize,
    all: BTreeMap<String, Vec<Option<f64>>>,
}

impl Gathered {
    /// Of so many numbers.
    pub fn new(count: usize) -> Self {
        Self {
            count,
            all: BTreeMap::new(),
        }
    }

    /// The derivative of a figure by one of the numbers.
    pub fn put(&mut self, number: usize, name: String, slope: f64) {
        let slopes = self.all.entry(name).or_insert_with(|| vec![None; self.count]);
        slopes[number] = Some(slope).filter(|slope| slope.is_finite());
    }

    /// Those that are known by every number.
    pub fn whole(self) -> Slopes {
        let known = |(name, slopes): (String, Vec<Option<f64>>)| {
            let slopes: Option<Vec<f64>> = slopes.into_iter().collect();
            Some((name, slopes?))
        };
        self.all.into_iter().filter_map(known).collect()
    }
}
