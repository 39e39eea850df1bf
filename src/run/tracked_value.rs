//! Track of one number over a run: last and largest value, and its figures in the window at the end.

use serde::{Deserialize, Serialize};

use super::summary::Quantity;

/// Relative excess over the largest value so far above which the state at an extremum between two steps is evaluated. Below it
/// the cubic through values and rates at the ends of the step is accurate enough.
const WORTH: f64 = 1e-3;

/// Largest and last value of one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrackedValue {
    last: f64,
    max_abs: f64,
    /// True if the value was negative there.
    negative: bool,
    /// Time at which the largest value was first reached [s].
    max_abs_at: f64,
    window_max_abs: f64,
    /// True if the value was negative there.
    #[serde(default)]
    window_negative: bool,
    /// Time at which the largest value was first reached [s]; used only within its step.
    #[serde(skip)]
    window_max_abs_at: f64,
    window_start: Option<f64>,
    /// Integral of the square over the window so far.
    window_squares: f64,
}

impl TrackedValue {
    /// Adds the value at an output time, or at an end of the window.
    pub fn take(&mut self, value: f64, in_window: bool) {
        self.last = value;
        if in_window {
            self.window_start.get_or_insert(value);
        }
    }

    /// Adds a value at any time [s].
    pub fn see(&mut self, value: f64, t: f64, in_window: bool) {
        let size = value.abs();
        if size > self.max_abs {
            (self.max_abs, self.max_abs_at, self.negative) = (size, t, value < 0.0);
        }
        if in_window && size > self.window_max_abs {
            (self.window_max_abs, self.window_max_abs_at, self.window_negative) = (size, t, value < 0.0);
        }
    }

    /// Adds to the integral of the square over the window.
    pub fn square(&mut self, integral: f64) {
        self.window_squares += integral;
    }

    /// Times after `after` [s] at which the largest values of run and window were reached.
    pub fn reached(&self, after: f64) -> impl Iterator<Item = f64> + use<> {
        let both = [self.max_abs_at, self.window_max_abs_at];
        both.into_iter().filter(move |t| *t > after)
    }

    /// Last value at an output time or an end of the window.
    pub fn last(&self) -> f64 {
        self.last
    }

    /// Change over the window.
    pub fn increment(&self) -> f64 {
        self.last - self.window_start.unwrap_or(self.last)
    }

    /// True if the window has begun.
    pub fn in_window(&self) -> bool {
        self.window_start.is_some()
    }

    /// True if the state at a magnitude between two steps must be evaluated.
    pub fn worth(&self, size: f64, in_window: bool) -> bool {
        size > (1.0 + WORTH) * self.max_abs || in_window && size > (1.0 + WORTH) * self.window_max_abs
    }

    /// Figures of an oscillating value. `reached` is true if the run has reached its window, of which it covered `window_time` [s].
    pub fn swing(&self, reached: bool, window_time: f64) -> Quantity {
        let signed = |size: f64, negative: bool| if negative { -size } else { size };
        Quantity {
            last: Some(self.last),
            max_abs: Some(self.max_abs),
            max_abs_at_s: (self.max_abs > 0.0).then_some(self.max_abs_at),
            extreme: Some(signed(self.max_abs, self.negative)),
            window_max_abs: reached.then_some(self.window_max_abs),
            window_extreme: reached.then(|| signed(self.window_max_abs, self.window_negative)),
            window_rms: (window_time > 0.0).then(|| (self.window_squares / window_time).sqrt()),
            ..Quantity::default()
        }
    }
}
