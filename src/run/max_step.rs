//! Largest steps of a run on successive intervals: small only where a signal is fast.

use super::schedule;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::functions::bounds::{TimeStretch, merged};
use crate::model::Model;

/// Intervals whose largest steps differ by at most this factor share the smaller one.
const NEAR: f64 = 4.0;
/// An interval at least as long as this many steps of its neighbor has its own largest step.
const WORTH: f64 = 20.0;

/// Largest step up to a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// Start of the next interval [s], at which the integrator stops.
    pub to: f64,
    /// Largest step [s].
    pub largest: f64,
}

/// Largest steps from the start to the end of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct StepLimits(Vec<StepLimit>);

impl StepLimits {
    /// Largest steps of a case: the given one, or a 16th of the shortest time scale of its signals on an interval, at most a tenth
    /// of the run. At tolerances looser than 1e-3 they grow with its fourth root, so that errors still follow the tolerance. If
    /// signals change without inertia, at most a hundredth of the run: a high order would step over what the ledger integrates.
    pub fn new(case: &Case, system: &System) -> Self {
        let end = case.time.end_s;
        if let Some(largest) = case.solver.max_step_s {
            return Self(vec![StepLimit { to: end, largest }]);
        }
        let strides = system.layout.inertia || !schedule::changes(&system.model);
        let part = if strides { 0.1 } else { 0.01 };
        let parts = 16.0 * (1e-3 / case.solver.rtol.max(1e-3)).powf(0.25);
        let mut all = Self(vec![]);
        for TimeStretch { to, scale } in stretches(&system.model, end) {
            all.add(StepLimit {
                to,
                largest: (part * end).min(scale / parts),
            });
        }
        all
    }

    /// The smallest of the largest steps [s].
    pub fn least(&self) -> f64 {
        self.0.iter().map(|stride| stride.largest).fold(f64::INFINITY, f64::min)
    }

    /// Largest step that applies from time `t` [s] on.
    pub fn at(&self, t: f64) -> StepLimit {
        let next = self.0.partition_point(|stride| stride.to <= t);
        let last = self.0.len().saturating_sub(1);
        self.0[next.min(last)]
    }

    /// Adds the next interval: merged with the last one, or separate if it is worth a stop.
    fn add(&mut self, next: StepLimit) {
        let from = self.0.len().checked_sub(2).map_or(0.0, |k| self.0[k].to);
        match self.0.last_mut() {
            Some(last) => {
                let least = last.largest.min(next.largest);
                let slow = if next.largest > last.largest {
                    next.to - last.to
                } else {
                    last.to - from
                };
                if last.largest.max(next.largest) <= NEAR * least || slow < WORTH * least {
                    *last = StepLimit {
                        to: next.to,
                        largest: least,
                    };
                } else {
                    self.0.push(next);
                }
            }
            None => self.0.push(next),
        }
    }
}

/// Shortest time scales of all signals on successive intervals, without kinks and jumps, which are stops.
pub(super) fn stretches(model: &Model, end: f64) -> Vec<TimeStretch> {
    let mut all = vec![TimeStretch {
        to: end,
        scale: f64::INFINITY,
    }];
    model.each_signal(|s| {
        all = merged(&all, &s.stretches(end), f64::min);
    });
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(parts: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let mut all = StepLimits(vec![]);
        parts
            .iter()
            .for_each(|&(to, largest)| all.add(StepLimit { to, largest }));
        all.0.iter().map(|stride| (stride.to, stride.largest)).collect()
    }

    #[test]
    fn stretches_that_are_not_worth_a_stop_are_joined() {
        let apart = [(1.0, 1.0), (1.1, 1e-3), (10.0, 1.0)];
        assert_eq!(joined(&apart), apart);
        assert_eq!(joined(&[(1.0, 1.0), (1.1, 0.3), (10.0, 1.0)]), [(10.0, 0.3)]);
        assert_eq!(joined(&[(1.0, 1e-3), (1.01, 1.0), (2.0, 1e-3)]), [(2.0, 1e-3)]);
        let all = StepLimits(vec![
            StepLimit { to: 1.0, largest: 1.0 },
            StepLimit { to: 2.0, largest: 0.1 },
        ]);
        assert_eq!([0.0, 0.5, 1.0, 2.0].map(|t| all.at(t).largest), [1.0, 1.0, 0.1, 0.1]);
        assert_eq!(all.least(), 0.1);
    }
}
