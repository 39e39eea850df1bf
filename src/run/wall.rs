//! Where the wall time of a run goes: every moment belongs to one part, and parts add up to the whole.

use std::time::Instant;

use serde::{Deserialize, Serialize};

/// Where wall time went [s]; `total` is the sum of all others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallTimes {
    /// Everything: of `slcbeam run` from the start of the program until the summary is written for the last time, else from the start of
    /// the run to its end. A run that is gone on with tells of the going on alone.
    pub total: f64,
    /// Reading and checking the case, choosing effects.
    #[serde(default)]
    pub start_up: f64,
    /// System, method, pattern, colours, symbolic analysis.
    #[serde(default)]
    pub set_up: f64,
    /// Other runs, by which mesh and tolerance were chosen.
    #[serde(default)]
    pub pilots: f64,
    /// Consistent states, at the start and after switches.
    #[serde(default)]
    pub consistent_start: f64,
    /// Residuals.
    pub residual: f64,
    /// Jacobians.
    pub jacobian: f64,
    /// Factorisations and solves.
    pub linear_solver: f64,
    /// What else steps take: predictions, sums and norms of vectors.
    #[serde(default)]
    pub steps: f64,
    /// What is watched at every step: ledgers, largest values, limits of the model.
    #[serde(default)]
    pub watching: f64,
    /// Samples: rows of the history, instants of the fields; checkpoints.
    pub output: f64,
    /// Time after the run until its companion and the runs that attribute errors have ended.
    #[serde(default)]
    pub companion: f64,
    /// Pictures.
    #[serde(default)]
    pub pictures: f64,
    /// Samples of uncertain numbers.
    #[serde(default, skip_serializing_if = "none")]
    pub samples: f64,
    /// The page.
    #[serde(default)]
    pub report: f64,
    /// Packing arrays, bringing files to the disk.
    #[serde(default)]
    pub files: f64,
    /// None of these.
    #[serde(default)]
    pub other: f64,
}

fn none(seconds: &f64) -> bool {
    *seconds == 0.0
}

impl WallTimes {
    /// What a run took until its result was known, by names in plain words.
    pub fn until_known(&self) -> [(&'static str, f64); 11] {
        [
            ("start-up", self.start_up),
            ("set-up", self.set_up),
            ("runs to choose by", self.pilots),
            ("consistent start", self.consistent_start),
            ("equations", self.residual),
            ("Jacobians", self.jacobian),
            ("linear solver", self.linear_solver),
            ("rest of the steps", self.steps),
            ("watching", self.watching),
            ("output", self.output),
            ("error bars", self.companion),
        ]
    }

    /// Sum of these [s].
    pub fn known(&self) -> f64 {
        self.until_known().iter().map(|(_, s)| s).sum()
    }

    /// Sets the total [s], and as the rest what no part tells of.
    pub fn close(&mut self, total: f64) {
        self.total = total;
        self.other = total - self.known() - self.samples - self.pictures - self.report - self.files;
    }

    /// Adds what was done before the run.
    pub fn begin_with(&mut self, before: &Self) {
        self.start_up += before.start_up;
        self.set_up += before.set_up;
        self.total += before.start_up + before.set_up;
    }
}

/// A clock that is read wherever one thing ends and another begins.
#[derive(Clone, Copy, Debug)]
pub struct Laps {
    began: Instant,
    last: Instant,
}

impl Laps {
    /// From an instant on.
    pub fn since(began: Instant) -> Self {
        Self { began, last: began }
    }

    /// Wall time since the last lap, or the begin [s].
    pub fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now - self.last;
        self.last = now;
        lap.as_secs_f64()
    }

    /// Wall time since the begin [s].
    pub fn total(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }
}
