//! Functions of time as text.

use crate::functions::Signal;
use crate::functions::bounds::Interval;
use crate::functions::signals::{Ramp, Sine};
use crate::output::numbers::{counted, quantity, trimmed};

/// Largest length of the text of a sum or product.
const LONGEST: usize = 90;

/// Text of a signal in a unit: `±12 mm at 20 Hz`.
pub fn describe(signal: &Signal, unit: &str) -> String {
    let q = |x: f64| trimmed(&quantity(x, unit, 3));
    let all = |parts: &[Signal], unit: &str| parts.iter().map(|s| describe(s, unit)).collect::<Vec<_>>();
    match signal {
        Signal::Constant(value) => q(*value),
        Signal::Sine(Sine {
            amplitude,
            frequency_hz,
            ramp_cycles,
            ..
        }) => {
            let start = match *ramp_cycles {
                0.0 => String::new(),
                cycles => format!(
                    ", growing over {} cycle{}",
                    short(cycles, "1"),
                    if cycles == 1.0 { "" } else { "s" }
                ),
            };
            format!("±{} at {}{start}", q(amplitude.abs()), short(*frequency_hz, "Hz"))
        }
        Signal::Sigmoid(s) => format!("step to {} around {}", q(s.amplitude), short(s.midpoint_s, "s")),
        Signal::Ramp(Ramp {
            from,
            to,
            start_s,
            duration_s,
            ..
        }) => format!(
            "from {} to {} between {} and {}",
            q(*from),
            q(*to),
            short(*start_s, "s"),
            short(start_s + duration_s, "s")
        ),
        Signal::Polynomial(_) => "polynomial in time".into(),
        Signal::Table(table) if table.repeat => format!(
            "curve through {}, repeated every {}",
            counted(table.times_s.len() as u64, "point"),
            short(table.period_s().unwrap_or_default(), "s")
        ),
        Signal::Table(table) => format!("curve through {}", counted(table.times_s.len() as u64, "point")),
        Signal::Controller(one) => format!("set by the controller \"{}\"", one.name),
        Signal::Sum(parts) => brief(all(parts, unit).join(" + ")),
        Signal::Product(parts) => brief(all(parts, "1").join(" × ")),
    }
}

/// Replaces a long text by a reference to the case.
fn brief(text: String) -> String {
    if text.chars().count() > LONGEST {
        "varies as given in the case".into()
    } else {
        text
    }
}

fn short(x: f64, unit: &str) -> String {
    trimmed(&quantity(x, unit, 3))
}

/// Value of largest magnitude within `[0, end]`, with its sign; positive for an oscillation about zero.
pub fn peak(signal: &Signal, end: f64) -> f64 {
    let Interval { low, high } = signal.range(0.0, end);
    let (low, high) = (low.min(0.0), high.max(0.0));
    if -low > 1.001 * high { low } else { high }
}

/// True if the signal is zero throughout.
pub fn is_zero(signal: &Signal) -> bool {
    matches!(signal, Signal::Constant(x) if *x == 0.0)
}
