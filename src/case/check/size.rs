//! Largest absolute values of functions of time or place.

use crate::functions::profile::Profile;
use crate::functions::signals::Signal;

/// Largest absolute value that a signal reaches by `end` [s]. It is reached, not only a bound, so that no case is rejected for a value that
/// does not occur.
pub(super) fn size_of(signal: &Signal, end: f64) -> f64 {
    signal.reaches(end).value
}

/// Largest absolute value of a profile.
pub(super) fn size_along(profile: &Profile) -> f64 {
    profile.size()
}

/// Largest absolute value of the integral of a sum of signals from 0 to times up to `end`. None if a signal is too fast for the samples.
pub(super) fn size_of_integral(signals: &[&Signal], end: f64) -> Option<f64> {
    const STEPS: u32 = 2000;
    let slow = |s: &&Signal| s.fastest_period_s().is_none_or(|period| period * 100.0 > end);
    if !signals.iter().all(slow) {
        return None;
    }
    let h = end / f64::from(STEPS);
    let (mut sum, mut largest) = (0.0_f64, 0.0_f64);
    for k in 0..STEPS {
        let t = (f64::from(k) + 0.5) * h;
        sum += h * signals.iter().map(|s| s.value(t)).sum::<f64>();
        largest = largest.max(sum.abs());
    }
    Some(largest)
}
