//! Wall time of a run by part: every moment belongs to one part, and the parts add up to the total.

use std::time::Instant;

use serde::{Deserialize, Serialize};

/// Wall time of each part [s]; `total` is the sum of all others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WallTimes {
    /// Total: for `slcbeam run` from the start of the program until the summary is written for the last time, else from the start of
    /// the run to its end. A resumed run counts only the time since it was resumed.
    pub total: f64,
    /// Reading and checking the case, choosing effects.
    #[serde(default)]
    pub start_up: f64,
    /// System, method, pattern, coloring, symbolic analysis.
    #[serde(default)]
    pub set_up: f64,
    /// Other runs that determine mesh and tolerance.
    #[serde(default)]
    pub pilots: f64,
    /// Consistent states, at the start and after switches.
    #[serde(default)]
    pub consistent_start: f64,
    /// Residuals.
    pub residual: f64,
    /// Jacobians.
    pub jacobian: f64,
    /// Factorizations and solves.
    pub linear_solver: f64,
    /// Rest of the steps: predictions, sums and norms of vectors.
    #[serde(default)]
    pub steps: f64,
    /// Observation of every step: ledgers, largest values, limits of the model.
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
    /// Report page.
    #[serde(default)]
    pub report: f64,
    /// Packing of arrays, and writing of files to the disk.
    #[serde(default)]
    pub files: f64,
    /// Remaining time.
    #[serde(default)]
    pub other: f64,
}

fn none(seconds: &f64) -> bool {
    *seconds == 0.0
}

impl WallTimes {
    /// Wall time of each part until the result was known, with its name in plain words.
    pub fn until_known(&self) -> [(&'static str, f64); 11] {
        [
            ("start-up", self.start_up),
            ("set-up", self.set_up),
            ("earlier runs", self.pilots),
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

    /// Sum of [`WallTimes::until_known`] [s].
    pub fn known(&self) -> f64 {
        self.until_known().iter().map(|(_, s)| s).sum()
    }

    /// Sets the total [s], and the remaining time that belongs to no part.
    pub fn close(&mut self, total: f64) {
        self.total = total;
        self.other = total - self.known() - self.samples - self.pictures - self.report - self.files;
    }

    /// Adds the wall time before the run.
    pub fn begin_with(&mut self, before: &Self) {
        self.start_up += before.start_up;
        self.set_up += before.set_up;
        self.total += before.start_up + before.set_up;
    }
}

/// A stopwatch that is read whenever one part ends and another begins.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    began: Instant,
    last: Instant,
}

impl Stopwatch {
    /// Starts at a given instant.
    pub fn since(began: Instant) -> Self {
        Self { began, last: began }
    }

    /// Wall time since the last reading, or the start [s].
    pub fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now - self.last;
        self.last = now;
        lap.as_secs_f64()
    }

    /// Wall time since the start [s].
    pub fn total(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }
}
