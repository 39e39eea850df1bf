//! The size of the next step.
//!
//! Estimates of the error behave as `e ~ φ h^k` with a slowly changing `φ`. After an accepted step the next one is the
//! smaller of `h (ρ/eₙ)^(1/k)` and `h (ρ/eₙ)^(1/k) · hₙ/hₙ₋₁ (eₙ₋₁/eₙ)^(1/k)`, which foresees the change of `φ`
//! (Gustafsson's predictive controller; Hairer & Wanner IV.8), `ρ = safety^k`. After a rejected one it is `h (ρ/e)^(1/k)`,
//! and growth beyond that size waits.

/// Fraction of the step that the estimate allows.
const SAFETY: f64 = 0.9;
/// Step sizes change by at most this factor, upwards and downwards.
const GROWTH: f64 = 5.0;
/// Growth below which the step stays as it is, and with it the factors of Newton's matrix.
const KEEP: f64 = 1.5;
/// Errors are taken as no smaller than this: a moment of rest does not stand for the past.
const LEAST: f64 = 1e-4;

/// Longest wait for growth, in accepted steps.
const LONGEST_WAIT: u32 = 32;
/// Ratio of successive sizes from which on a step has grown.
const GROWN: f64 = 1.01;

/// Wait for growth after a rejected step.
///
/// Estimates of superposed oscillations fluctuate: a small one permits growth that the next one rejects, and each change of
/// size costs a new matrix. A rejection of growth doubles the wait, growth that is accepted halves it.
#[derive(Clone, Debug)]
struct Wait {
    /// Largest size while it lasts [s].
    ceiling: f64,
    /// Accepted steps until it ends.
    left: u32,
    /// Length of the next one, in accepted steps.
    next: u32,
}

impl Wait {
    fn new() -> Self {
        Self {
            ceiling: f64::INFINITY,
            left: 0,
            next: 1,
        }
    }

    /// A step is rejected, `grown` from the one before; `size` [s] follows.
    fn begin(&mut self, size: f64, grown: bool) {
        if grown {
            self.next = (2 * self.next).min(LONGEST_WAIT);
        }
        (self.ceiling, self.left) = (size, self.next);
    }

    /// A step is accepted, `grown` from the one before; limits the size of the next [s].
    fn limit(&mut self, size: f64, grown: bool) -> f64 {
        if self.left > 0 {
            self.left -= 1;
            return size.min(self.ceiling);
        }
        if grown {
            self.next = (self.next / 2).max(1);
        }
        size
    }
}

/// Step sizes from errors.
#[derive(Clone, Debug)]
pub(super) struct Control {
    /// Size of the next step [s].
    pub size: f64,
    largest: f64,
    power: f64,
    /// Size [s] and error of the last step accepted.
    last: Option<(f64, f64)>,
    /// Whether the present step has failed before.
    failed: bool,
    wait: Wait,
}

impl Control {
    pub fn new(largest: Option<f64>, power: u8) -> Self {
        Self {
            size: 0.0,
            largest: largest.unwrap_or(f64::INFINITY),
            power: power.into(),
            last: None,
            failed: false,
            wait: Wait::new(),
        }
    }

    /// Largest step [s] from now on.
    pub fn limit(&mut self, largest: f64) {
        self.largest = largest;
        self.size = self.size.min(largest);
    }

    /// Begins with a step [s], without a past.
    pub fn begin(&mut self, size: f64) {
        (self.size, self.last, self.failed) = (size.min(self.largest), None, false);
        self.wait = Wait::new();
    }

    /// Tries no more than this as the next step [s].
    pub fn shorten(&mut self, size: f64) {
        self.size = self.size.min(size);
    }

    /// The step to try from `t` [s], and its end: not beyond `stop`, which is hit exactly, nor so near to it that a
    /// sliver is left.
    pub fn attempt(&self, t: f64, stop: f64) -> (f64, f64) {
        let left = stop - t;
        // a fixed step is to fit into a whole interval in spite of rounding
        if left <= self.size * (1.0 + 1e-9) {
            (left, stop)
        } else if left < 2.0 * self.size {
            (0.5 * left, t + 0.5 * left)
        } else {
            (self.size, t + self.size)
        }
    }

    /// True if a step of size `h` [s] is larger than the last one accepted.
    fn grown(&self, h: f64) -> bool {
        self.last.is_some_and(|(last, _)| h > GROWN * last)
    }

    /// A step of size `h` [s] is accepted with an error relative to the tolerance.
    pub fn accepted(&mut self, h: f64, error: f64) {
        let error = (error / SAFETY.powf(self.power)).max(LEAST);
        let per_step = 1.0 / self.power;
        let mut factor = error.powf(-per_step);
        if let Some((last, last_error)) = self.last {
            factor = factor.min(factor * h / last * (last_error / error).powf(per_step));
        }
        if self.failed {
            factor = factor.min(1.0);
        }
        let limit = if self.last.is_none() { 2.0 * GROWTH } else { GROWTH };
        factor = factor.clamp(1.0 / GROWTH, limit);
        let grown = self.grown(h);
        let next = self.wait.limit(h * factor, grown);
        // a step cut short by a stop says little about the next
        let keep = (1.0..KEEP).contains(&(next / self.size)) || (h < self.size && next < self.size && !self.failed);
        if !keep {
            self.size = next.min(self.largest);
        }
        (self.last, self.failed) = (Some((h, error)), false);
    }

    /// A step of size `h` [s] is rejected for its error.
    pub fn rejected(&mut self, h: f64, error: f64) {
        let factor = (error / SAFETY.powf(self.power)).powf(-1.0 / self.power);
        // written so that an error that is no number counts as large
        self.size = h * if factor > 1.0 / GROWTH { factor } else { 1.0 / GROWTH };
        if !self.failed {
            let grown = self.grown(h);
            self.wait.begin(self.size, grown);
        }
        self.failed = true;
    }

    /// Newton's iteration, or the equations, have failed with a step of size `h` [s].
    pub fn failed(&mut self, h: f64) {
        self.size = 0.25 * h;
        self.failed = true;
    }
}
