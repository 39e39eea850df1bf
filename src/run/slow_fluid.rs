//! Warning about fluid that needs longer to reach equilibrium than the run lasts.

use crate::case::controls;
use crate::case::schema::{Case, Effect};
use crate::discrete::System;
use crate::error::Code;
use crate::functions::signals::Signal;
use crate::model::relaxation_times::Slowest;

/// Relative lag of the slowest decay above which the warning is given.
const LEFT: f64 = 0.05;

/// Number of time constants after which an earlier change has decayed.
const FORGOTTEN: f64 = 20.0;

/// Number of instants at which a signal is sampled; the lag is then accurate to about 0.01.
const LOOKS: u16 = 2000;

/// Warns that an equilibrium under the loads at `at_s` [s] differs from the run, because fluid settles more slowly. States the lag
/// of the slowest decay of a network, with the valves as they are at this time.
pub fn warning(case: &Case, system: &System, at_s: f64) -> Option<String> {
    let model = &system.model;
    let wet = model.wet.as_ref().filter(|_| model.effects.has(Effect::Flow))?;
    let slowest = Slowest::at(wet, at_s)?;
    let until = if at_s > 0.0 { at_s } else { case.time.end_s };
    // loads that act from the start cause no lag if the run begins at equilibrium under them
    let mut share = match case.start.equilibrium {
        None => (-until / slowest.time).exp(),
        Some(_) => 0.0,
    };
    for (_, _, signal) in controls(case) {
        share = share.max(lag(signal, slowest.time, until));
    }
    let [from, to] = &slowest.between;
    (share > LEFT).then(|| {
        Code::LateRest.warning(format!(
            "the slowest flow of the network (time constant {}, mainly between {from} and {to}) lags by {:.0} % at {} \
             in the run. Pressures of the run then differ from those of the equilibrium. Extend the run, slow the \
             loads, or widen tubes or valves; `slcbeam run` gives the state at that time.",
            span(slowest.time),
            100.0 * share,
            span(until)
        ))
    })
}

/// Lag of a first-order response behind its signal at time `until` [s], over the range of the signal; 1 after a late jump.
///
/// ```text
/// T dy/dt = s - y      y(0) = s(0)
/// ```
fn lag(signal: &Signal, time_constant: f64, until: f64) -> f64 {
    if signal.is_constant() {
        return 0.0;
    }
    // earlier changes have decayed
    let begin = (until - FORGOTTEN * time_constant).max(0.0);
    let step = (until - begin) / f64::from(LOOKS);
    let kept = (-step / time_constant).exp();
    // weight of a change that is linear between two instants
    let mean = (1.0 - kept) * time_constant / step;
    let (mut lag, mut last) = (0.0, signal.value(begin));
    for k in 1..=LOOKS {
        let value = signal.value(begin + f64::from(k) * step);
        lag = kept * lag + mean * (value - last);
        last = value;
    }
    let all = signal.range(0.0, until);
    let reach = all.high - all.low;
    if reach > 0.0 { (lag / reach).abs() } else { 0.0 }
}

/// Formats a time with a readable unit.
fn span(seconds: f64) -> String {
    let units = [
        (86400.0 * 365.0, "years"),
        (86400.0, "days"),
        (3600.0, "h"),
        (60.0, "min"),
        (1.0, "s"),
        (1e-3, "ms"),
    ];
    // less than three minutes, hours, days or years are given in the next smaller unit
    let (size, unit) = units
        .into_iter()
        .find(|(size, unit)| seconds >= if matches!(*unit, "s" | "ms") { *size } else { 3.0 * size })
        .unwrap_or((1e-6, "µs"));
    let number: f64 = format!("{:.2e}", seconds / size).parse().unwrap_or(seconds / size);
    format!("{number} {unit}")
}

#[cfg(test)]
mod tests {
    use super::{lag, span};
    use crate::functions::signals::{Ramp, RampShape, Signal, Sine};

    /// Compares the lag with closed forms for a ramp and a sine.
    #[test]
    fn what_follows_lags_as_first_order_does() {
        let ramp = Signal::Ramp(Ramp {
            from: 1.0,
            to: 3.0,
            start_s: 0.5,
            duration_s: 1.0,
            shape: RampShape::Linear,
        });
        let expected = 0.4 * (1.0 - (-1.0_f64 / 0.4).exp()) * (-0.5_f64 / 0.4).exp();
        assert!((lag(&ramp, 0.4, 2.0) - expected).abs() < 1e-3 * expected);
        let sine = Signal::Sine(Sine {
            amplitude: 2.0,
            frequency_hz: 10.0,
            phase_rad: 0.0,
            ramp_cycles: 0.0,
        });
        // s - y has the relative amplitude ωT/√(1 + (ωT)²) over a range of two, and leads by its phase
        let turns = std::f64::consts::TAU * 10.0 * 0.01;
        let expected = 0.5 * turns / (1.0 + turns * turns);
        assert!((lag(&sine, 0.01, 3.0) - expected).abs() < 1e-2 * expected);
        assert!(lag(&Signal::Constant(5.0), 1.0, 1.0) == 0.0);
        // a jump half a time constant before the end, however long the run
        for end in [1.0, 100.0, 1e4] {
            let late = Signal::Ramp(Ramp {
                from: 0.0,
                to: -1.0,
                start_s: end - 1e-3,
                duration_s: 1e-6,
                shape: RampShape::Linear,
            });
            let computed = lag(&late, 2e-3, end);
            assert!((computed - (-0.5_f64).exp()).abs() < 0.01, "{end}: {computed}");
        }
    }

    #[test]
    fn times_have_units_of_their_size() {
        let all = [738_079.0, 5.5417, 0.3, 1.5, 4e9, 120.0].map(span);
        assert_eq!(all, ["8.54 days", "5.54 s", "300 ms", "1.5 s", "127 years", "120 s"]);
    }
}
