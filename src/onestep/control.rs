//! Step size control.
//!
//! Error estimates behave as `e ~ φ h^k` with a slowly changing `φ`. After an accepted step the next size is the smaller of
//! `h (ρ/eₙ)^(1/k)` and `h (ρ/eₙ)^(1/k) · hₙ/hₙ₋₁ (eₙ₋₁/eₙ)^(1/k)`, which extrapolates the change of `φ` (Gustafsson's predictive
//! controller; Hairer & Wanner IV.8), `ρ = safety^k`. After a rejected step it is `h (ρ/e)^(1/k)`, and growth beyond that size is
//! delayed.

/// Fraction of the step size that the estimate permits.
const SAFETY: f64 = 0.9;
/// Largest factor by which step sizes change, upwards or downwards.
const GROWTH: f64 = 5.0;
/// Growth below which the step size is kept, and with it the factors of Newton's matrix.
const KEEP: f64 = 1.5;
/// Lower limit of errors: a short phase of rest does not represent the past.
const LEAST: f64 = 1e-4;

/// Longest delay of growth, in accepted steps.
const LONGEST_WAIT: u32 = 32;
/// Ratio of successive sizes above which a step counts as grown.
const GROWN: f64 = 1.01;

/// Delay of growth after a rejected step.
///
/// Estimates of superposed oscillations fluctuate: a small one permits growth that the next one rejects, and each change of size needs a
/// new matrix. A rejection after growth doubles the delay, accepted growth halves it.
#[derive(Clone, Debug)]
struct Wait {
    /// Largest size during the delay [s].
    ceiling: f64,
    /// Accepted steps until the delay ends.
    left: u32,
    /// Length of the next delay, in accepted steps.
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

    /// Starts a delay after a rejected step; `grown` refers to the step before, `size` [s] is the new size.
    fn begin(&mut self, size: f64, grown: bool) {
        if grown {
            self.next = (2 * self.next).min(LONGEST_WAIT);
        }
        (self.ceiling, self.left) = (size, self.next);
    }

    /// Limits the size [s] of the next step after an accepted one; `grown` refers to the step before it.
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

/// Computes step sizes from errors.
#[derive(Clone, Debug)]
pub(super) struct StepControl {
    /// Size of the next step [s].
    pub size: f64,
    largest: f64,
    power: f64,
    /// Size [s] and error of the last accepted step.
    last: Option<(f64, f64)>,
    /// True if the present step has failed before.
    failed: bool,
    wait: Wait,
}

impl StepControl {
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

    /// Sets the largest step size [s] from now on.
    pub fn limit(&mut self, largest: f64) {
        self.largest = largest;
        self.size = self.size.min(largest);
    }

    /// Starts with a step size [s], without a history.
    pub fn begin(&mut self, size: f64) {
        (self.size, self.last, self.failed) = (size.min(self.largest), None, false);
        self.wait = Wait::new();
    }

    /// Limits the size of the next step [s].
    pub fn shorten(&mut self, size: f64) {
        self.size = self.size.min(size);
    }

    /// Returns size and end of the next attempt from `t` [s]. The step does not pass `stop`, hits it exactly, and
    /// avoids a very short remainder before it.
    pub fn attempt(&self, t: f64, stop: f64) -> (f64, f64) {
        let left = stop - t;
        // despite rounding errors, an integer number of fixed steps must fit into an interval
        if left <= self.size * (1.0 + 1e-9) {
            (left, stop)
        } else if left < 2.0 * self.size {
            (0.5 * left, t + 0.5 * left)
        } else {
            (self.size, t + self.size)
        }
    }

    /// True if a step of size `h` [s] is larger than the last accepted one.
    fn grown(&self, h: f64) -> bool {
        self.last.is_some_and(|(last, _)| h > GROWN * last)
    }

    /// Records an accepted step of size `h` [s] with an error relative to the tolerance.
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
        // a step shortened by a stop does not determine the next size
        let keep = (1.0..KEEP).contains(&(next / self.size)) || (h < self.size && next < self.size && !self.failed);
        if !keep {
            self.size = next.min(self.largest);
        }
        (self.last, self.failed) = (Some((h, error)), false);
    }

    /// Records a step of size `h` [s] rejected by its error.
    pub fn rejected(&mut self, h: f64, error: f64) {
        let factor = (error / SAFETY.powf(self.power)).powf(-1.0 / self.power);
        // written so that a NaN counts as a large error
        self.size = h * if factor > 1.0 / GROWTH { factor } else { 1.0 / GROWTH };
        if !self.failed {
            let grown = self.grown(h);
            self.wait.begin(self.size, grown);
        }
        self.failed = true;
    }

    /// Records a failure of Newton's iteration or of the equations with a step of size `h` [s].
    pub fn failed(&mut self, h: f64) {
        self.size = 0.25 * h;
        self.failed = true;
    }
}
