//! What is asked for.

use serde::{Deserialize, Serialize};

use super::scheme::Scheme;
use crate::case::schema::{Case, Method};
use crate::discrete::System;
use crate::error::{Error, Result};

/// One way to compute a case.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Beam cells per segment; half as many fluid cells per bladder.
    pub cells: usize,
    /// How time is integrated.
    pub scheme: Scheme,
    /// Tolerance.
    pub rtol: f64,
}

/// Finite volumes along a bladder, refined with the beam's cells per segment.
pub fn fluid_cells(cells: usize) -> usize {
    (cells / 2).max(1)
}

/// The case on a mesh of so many beam cells per segment, at a tolerance.
pub fn refined(case: &Case, cells: usize, rtol: f64) -> Case {
    let mut case = case.clone();
    case.mesh.cells_per_segment = cells;
    case.mesh.cells_per_bladder = fluid_cells(cells);
    case.solver.rtol = rtol;
    case
}

/// The case for its figures alone: without checkpoints, each of which is a fresh start of the integrator, and thinned outputs.
pub fn unrecorded(case: &Case) -> Case {
    let mut case = case.clone();
    case.time.checkpoint_interval_s = None;
    case.time.history = Default::default();
    case
}

/// The case on meshes of fourth order, where it does not name an order and can be computed so.
pub fn of_best_order(case: &Case) -> Case {
    let mut fourth = case.clone();
    fourth.mesh.order.get_or_insert(4);
    if System::new(&fourth).is_ok() {
        fourth
    } else {
        case.clone()
    }
}

impl Setting {
    /// The case so computed.
    pub fn case(&self, case: &Case) -> Case {
        let mut case = refined(case, self.cells, self.rtol);
        self.scheme.apply(&mut case.solver);
        unrecorded(&case)
    }
}

/// What may be spent on a whole study.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Budget {
    /// Wall time [s].
    Wall(f64),
    /// Steps of the integrator: the same on every machine.
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

    /// A cost in words.
    pub fn words(self, cost: f64) -> String {
        match self {
            Self::Wall(_) => format!("{cost:.2} s"),
            Self::Steps(_) => format!("{cost:.0} steps"),
        }
    }
}

/// Settings asked for, each list in the order in which it is run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Tolerances, loose to tight.
    pub rtols: Vec<f64>,
    /// Meshes, coarse to fine.
    pub cells: Vec<usize>,
    /// Methods, IDA with each order.
    pub schemes: Vec<Scheme>,
    /// Timed runs of each setting, after one to warm up.
    pub repeats: usize,
    /// For everything.
    pub budget: Budget,
    /// Runs at once; times suffer.
    pub parallel: bool,
}

/// Tightest tolerance of a reference: below it round-off of the residual is in the way.
const TIGHTEST: f64 = 1e-11;

impl Plan {
    /// Checks and sorts.
    ///
    /// # Errors
    /// [`Error::Usage`] for an empty list or a value out of range.
    pub fn checked(mut self) -> Result<Self> {
        let wrong = |what: &str| Err(Error::Usage(what.into()));
        if self.rtols.is_empty() || self.rtols.iter().any(|t| !(1e-11..=0.1).contains(t)) {
            return wrong("--rtol: tolerances from 1e-11 to 0.1, comma between them");
        }
        if self.cells.is_empty() || self.cells.iter().any(|k| !(1..=1000).contains(k)) {
            return wrong("--cells: beam cells per segment from 1 to 1000, comma between them");
        }
        if self.schemes.is_empty() || self.schemes.iter().any(|s| !(1..=5).contains(&s.order)) {
            return wrong("--orders: highest BDF orders from 1 to 5, comma between them");
        }
        if self.repeats == 0 {
            return wrong("--repeats: at least 1");
        }
        let size = self.budget.size();
        if size.is_nan() || size <= 0.0 {
            return wrong("--budget: a time above zero, such as 120s or 2m");
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

    /// Meshes for references: those of the points, and one beyond the finest, for the limit to which they point.
    pub fn reference_cells(&self) -> Vec<usize> {
        let mut all = self.cells.clone();
        if let [.., before, finest] = self.cells.as_slice() {
            // The ratio of the last two, so that three meshes in a row show an order.
            all.push(if finest % before == 0 {
                finest * (finest / before)
            } else {
                2 * finest
            });
        }
        all
    }

    /// Schemes for references: each is the check of the other. Where one-step methods are asked for, the one of order 4
    /// takes the place of IDA at order 2: it costs less.
    pub fn reference_schemes(&self) -> [Scheme; 2] {
        let other = if self.schemes.iter().all(|s| s.is_ida()) {
            None
        } else {
            Scheme::one_step(Method::Esdirk46)
        };
        [Scheme::ida(5), other.unwrap_or(Scheme::ida(2))]
    }
}
