//! Settings and budget of an accuracy study.

use serde::{Deserialize, Serialize};

use super::scheme::Scheme;
use crate::case::schema::{Case, Method};
use crate::discrete::System;
use crate::error::{Error, Result};

/// Mesh, time integration and tolerance of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudySetting {
    /// Beam cells per segment; half as many fluid cells per bladder.
    pub cells: usize,
    /// Time integration: method and order.
    pub scheme: Scheme,
    /// Tolerance.
    pub rtol: f64,
}

/// Finite volumes along a bladder, refined with the beam's cells per segment.
pub fn fluid_cells(cells: usize) -> usize {
    (cells / 2).max(1)
}

/// Returns the case on a mesh of `cells` beam cells per segment, at a tolerance.
pub fn refined(case: &Case, cells: usize, rtol: f64) -> Case {
    let mut case = case.clone();
    case.mesh.cells_per_segment = cells;
    case.mesh.cells_per_bladder = fluid_cells(cells);
    case.solver.rtol = rtol;
    case
}

/// Returns the case without thinned output and without checkpoints, each of which restarts the integrator.
pub fn unrecorded(case: &Case) -> Case {
    let mut case = case.clone();
    case.time.checkpoint_interval_s = None;
    case.time.history = Default::default();
    case
}

/// Returns the case on a fourth-order mesh if it sets no order and the system can be built so; otherwise an unchanged
/// copy.
pub fn of_best_order(case: &Case) -> Case {
    let mut fourth = case.clone();
    fourth.mesh.order.get_or_insert(4);
    if !case.is_structure() && System::new(&fourth).is_ok() {
        fourth
    } else {
        case.clone()
    }
}

impl StudySetting {
    /// Returns the case with this setting.
    pub fn case(&self, case: &Case) -> Case {
        let mut case = refined(case, self.cells, self.rtol);
        self.scheme.apply(&mut case.solver);
        unrecorded(&case)
    }
}

/// Budget of a whole study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Budget {
    /// Wall time [s].
    Wall(f64),
    /// Steps of the integrator, independent of the machine.
    Steps(u64),
}

impl Budget {
    /// Seconds or steps.
    pub fn size(self) -> f64 {
        match self {
            Self::Wall(seconds) => seconds,
            Self::Steps(steps) => steps as f64,
        }
    }

    /// Formats a cost with its unit.
    pub fn describe(self, cost: f64) -> String {
        match self {
            Self::Wall(_) => format!("{cost:.2} s"),
            Self::Steps(_) => format!("{cost:.0} steps"),
        }
    }
}

/// Requested settings, each list in the order of the runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyPlan {
    /// Tolerances, loose to tight.
    pub rtols: Vec<f64>,
    /// Meshes, coarse to fine.
    pub cells: Vec<usize>,
    /// Methods, IDA with each order.
    pub schemes: Vec<Scheme>,
    /// Timed runs of each setting, after one to warm up.
    pub repeats: usize,
    /// Budget of all runs.
    pub budget: Budget,
    /// True if settings run in parallel, which distorts wall times.
    pub parallel: bool,
}

/// Tightest tolerance of a reference; below it, rounding errors of the residual limit the accuracy.
const TIGHTEST: f64 = 1e-11;

impl StudyPlan {
    /// Validates the plan and sorts its lists.
    ///
    /// # Errors
    /// [`Error::Usage`] for an empty list or a value out of range.
    pub fn checked(mut self) -> Result<Self> {
        let wrong = |what: &str| Err(Error::Usage(what.into()));
        if self.rtols.is_empty() || self.rtols.iter().any(|t| !(1e-11..=0.1).contains(t)) {
            return wrong("--rtol: expected tolerances from 1e-11 to 0.1, separated by commas");
        }
        if self.cells.is_empty() || self.cells.iter().any(|k| !(1..=1000).contains(k)) {
            return wrong("--cells: expected beam cells per segment from 1 to 1000, separated by commas");
        }
        if self.schemes.is_empty() || self.schemes.iter().any(|s| !(1..=5).contains(&s.order)) {
            return wrong("--orders: expected highest BDF orders from 1 to 5, separated by commas");
        }
        if self.repeats == 0 {
            return wrong("--repeats: expected at least 1");
        }
        let size = self.budget.size();
        if size.is_nan() || size <= 0.0 {
            return wrong("--budget: expected a time above zero, such as 120s or 2m");
        }
        self.rtols.sort_by(|a, b| b.total_cmp(a));
        self.rtols.dedup();
        self.cells.sort_unstable();
        self.cells.dedup();
        self.schemes.sort_unstable();
        self.schemes.dedup();
        Ok(self)
    }

    /// Tolerances for a reference, tightest first.
    pub fn reference_rtols(&self) -> Vec<f64> {
        let least = self.rtols.last().copied().unwrap_or(1e-7);
        let mut all: Vec<f64> = [1e-3, 1e-2, 1e-1]
            .iter()
            .map(|f| f * least)
            .filter(|t| *t >= TIGHTEST)
            .collect();
        if all.is_empty() && least > TIGHTEST {
            all.push(TIGHTEST);
        }
        all
    }

    /// Meshes of the references: those of the points, and one finer mesh for the extrapolation to the limit.
    pub fn reference_cells(&self) -> Vec<usize> {
        let mut all = self.cells.clone();
        if let [.., before, finest] = self.cells.as_slice() {
            // Use the ratio of the last two meshes, so that three successive meshes show an order of convergence.
            all.push(if finest % before == 0 {
                finest * (finest / before)
            } else {
                2 * finest
            });
        }
        all
    }

    /// Schemes of the references; each checks the other. If one-step methods are requested, the one of order 4 replaces
    /// IDA at order 2: it costs less.
    pub fn reference_schemes(&self) -> [Scheme; 2] {
        let other = if self.schemes.iter().all(|s| s.is_ida()) {
            None
        } else {
            Scheme::one_step(Method::Esdirk46)
        };
        [Scheme::ida(5), other.unwrap_or(Scheme::ida(2))]
    }
}
