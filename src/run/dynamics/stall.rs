//! Detection of a stalled run.

/// Number of steps over which progress is judged.
pub(super) const STALL_STEPS: u64 = 20_000;

/// Detects steps that no longer advance the time.
pub(super) struct StallDetector {
    steps: u64,
    t: f64,
}

impl StallDetector {
    /// Starts from time `t` [s].
    pub(super) fn new(t: f64) -> Self {
        Self { steps: 0, t }
    }

    /// True if the last [`STALL_STEPS`] steps advanced by less than 1e-8 of the run. The rest would need more than 10^12 steps.
    pub(super) fn stalled(&mut self, steps: u64, t: f64, end: f64) -> bool {
        if steps < self.steps + STALL_STEPS {
            return false;
        }
        let stalled = t - self.t < 1e-8 * end;
        (self.steps, self.t) = (steps, t);
        stalled
    }
}
