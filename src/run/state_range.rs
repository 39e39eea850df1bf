//! States outside the range of the model, of analyses that record no run.

use super::range::{Limits, Range};
use crate::case::schema::Case;
use crate::dae::BeamDae;
use crate::discrete::System;
use crate::discrete::extrema::MonitoredValues;
use crate::error::Code;

/// Record of states that exceed limits of the model.
pub struct StateRange {
    limits: Limits,
    seen: Range,
    beyond: Option<String>,
}

impl StateRange {
    /// Record without states. `settled` is false if the state at t = 0 is the start of a case that is not at rest.
    pub fn new(case: &Case, system: &System, settled: bool) -> Self {
        let mut limits = Limits::new(case, system);
        limits.at_rest |= settled;
        Self {
            limits,
            seen: Range::default(),
            beyond: None,
        }
    }

    /// Adds a state of scaled unknowns at an instant [s].
    pub fn add(&mut self, dae: &mut BeamDae, t: f64, y: &[f64]) {
        let (system, now, w) = dae.evaluate(t, y, &vec![0.0; y.len()]);
        let values = MonitoredValues::new(system, now, t, w);
        self.beyond = self.beyond.take().or_else(|| self.limits.beyond(&values));
        self.seen.take(&self.limits, None, &values);
    }

    /// Warnings about the states.
    pub fn warnings(&self) -> Vec<String> {
        let beyond = self.beyond.iter().map(|beyond| {
            Code::BeyondRange.warning(format!(
                "{beyond}. Results about such a state are not reliable. Reduce the load."
            ))
        });
        beyond.chain(self.seen.warnings(&self.limits)).collect()
    }
}
