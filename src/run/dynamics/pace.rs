//! Whether a run moves on.

/// Steps over which progress is judged.
pub(super) const STALL_STEPS: u64 = 20_000;

/// Notices when steps no longer move the time on.
pub(super) struct Pace {
    steps: u64,
    t: f64,
}

impl Pace {
    /// From a time on [s].
    pub(super) fn new(t: f64) -> Self {
        Self { steps: 0, t }
    }

    /// True when the last [`STALL_STEPS`] steps advanced by less than 1e-8 of the run: the rest would take more than
    /// 10^12 steps.
    pub(super) fn stalled(&mut self, steps: u64, t: f64, end: f64) -> bool {
        if steps < self.steps + STALL_STEPS {
            return false;
        }
        let stalled = t - self.t < 1e-8 * end;
        (self.steps, self.t) = (steps, t);
        stalled
    }
}
