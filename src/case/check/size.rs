//! How large a function of time or place gets.

use crate::case::profile::Profile;
use crate::case::signals::{Clock, Signal};

/// Samples of a piece.
const SAMPLES: u32 = 64;

/// Largest absolute value that a signal is seen to reach by `end` [s], looked for in each interval between its switching times.
/// What is found is reached, so that nothing is refused for what it does not do.
pub(super) fn size_of(signal: &Signal, end: f64) -> f64 {
    let value = |t: f64, within: f64| signal.jet(Clock { t, within }).value.abs();
    let pieces = signal.smooth_intervals(end).into_iter();
    let sizes = pieces.flat_map(|(from, to)| {
        let middle = 0.5 * (from + to);
        (0..=SAMPLES).map(move |k| value(from + (to - from) * f64::from(k) / f64::from(SAMPLES), middle))
    });
    sizes.fold(0.0, f64::max)
}

/// Largest absolute value that a profile is seen to have.
pub(super) fn size_along(profile: &Profile) -> f64 {
    let values = (0..=200).map(|k| profile.value(f64::from(k) / 200.0).abs());
    values.fold(0.0, f64::max)
}

/// Largest absolute value of the integral of a sum of signals from 0 to times up to `end`; none where one of them is too fast
/// to be told by samples.
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
