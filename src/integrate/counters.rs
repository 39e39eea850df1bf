//! Work counters and wall times of an integrator.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::case::schema::Method;

/// Work done since the integrator was created, over all restarts.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Accepted steps.
    pub steps: u64,
    /// Residual evaluations.
    pub residual_evaluations: u64,
    /// Jacobian evaluations.
    pub jacobian_evaluations: u64,
    /// Numerical factorizations, including refactorizations with old pivots.
    pub factorizations: u64,
    /// Repeated factorizations because of bad old pivots.
    pub pivot_refreshes: u64,
    /// Steps rejected by the error test.
    pub error_test_failures: u64,
    /// Newton iterations that did not converge.
    pub newton_failures: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Linear solves.
    pub linear_solves: u64,
    /// Restarts.
    pub restarts: u64,
    /// Accepted steps by order, index 0 is order 1.
    pub steps_by_order: Vec<u64>,
    /// Highest order allowed.
    pub max_order: u8,
    /// Method to which the order refers; none if nothing was integrated, and in results of earlier versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
}

impl Counters {
    /// Adds the work of an earlier part of the same run.
    pub fn add(&mut self, earlier: &Self) {
        self.steps += earlier.steps;
        self.residual_evaluations += earlier.residual_evaluations;
        self.jacobian_evaluations += earlier.jacobian_evaluations;
        self.factorizations += earlier.factorizations;
        self.pivot_refreshes += earlier.pivot_refreshes;
        self.error_test_failures += earlier.error_test_failures;
        self.newton_failures += earlier.newton_failures;
        self.newton_iterations += earlier.newton_iterations;
        self.linear_solves += earlier.linear_solves;
        self.restarts += earlier.restarts;
        for (order, count) in earlier.steps_by_order.iter().enumerate() {
            match self.steps_by_order.get_mut(order) {
                Some(own) => *own += count,
                None => self.steps_by_order.push(*count),
            }
        }
    }
}

/// Wall time spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SolverWallTimes {
    /// Residuals.
    pub residual: Duration,
    /// Jacobians.
    pub jacobian: Duration,
    /// Factorisations and solves.
    pub linear_solver: Duration,
    /// Integrands of the integrals computed along with the solution.
    pub integrands: Duration,
}
