//! Common period of all signals that act on a case, after their smooth starts.

use crate::case::schema::Case;
use crate::error::{Error, Result};
use crate::functions::signals::{Signal, Sine};
use crate::model::Model;
use crate::run::equilibrium::TIGHT;

/// Largest number of cycles of the slowest signal in a common period.
const MOST_CYCLES: u32 = 64;
/// Relative tolerance within which a frequency ratio counts as one of small integers.
const COMMENSURABLE: f64 = 1e-9;
/// Time, in units of a sigmoid's inverse steepness, after which its distance from the limit is round-off: `exp(-37)`.
const ROUND_OFF: f64 = 37.0;

/// Periodic excitation of a case in the long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicDrive {
    /// Common period [s].
    pub period: f64,
    /// True if any signal changes in the long run; otherwise the period is the requested one.
    pub driven: bool,
}

/// Returns the common period of all signals of a case, without their smooth starts. A constant has any period, ramps and
/// tables come to rest, and sines, their sums and products continue. `asked` [s] is the period of a case without periodic signal.
///
/// # Errors
/// [`Error::Usage`]: a signal is not periodic, or the frequencies have no common period. Also if no signal is periodic and no valid
/// period was requested, or if a period was requested although the case has its own.
pub fn drive(case: &Case, model: &Model, asked: Option<f64>) -> Result<PeriodicDrive> {
    let mut frequencies = vec![];
    let mut endless = None;
    model.each_signal(|s| {
        let settled = settled(s);
        if !is_periodic(&settled) {
            endless.get_or_insert(settled);
        } else {
            collect(&settled, &mut frequencies);
        }
    });
    let name = &case.name;
    if let Some(signal) = endless {
        let mut controlled = None;
        signal.each_controller(&mut |one| controlled = Some(&one.name));
        if let Some(controller) = controlled {
            return Err(Error::Usage(format!(
                "{name}: the controller \"{controller}\" is sampled, and the search for a cycle does not stop at samples. Extend the \
                 run by `slcbeam run` until its cycles repeat, or replace the controller by a signal"
            )));
        }
        let mut kinks = None;
        kinked_period(&signal, &mut kinks);
        if let Some(period) = kinks {
            return Err(Error::Usage(format!(
                "{name}: a table that repeats every {period} s has kinks or jumps, at which the search for a cycle \
                 does not stop. Give the table \"interpolation\": \"cubic\" and a last value that equals its first, \
                 or extend the run by `slcbeam run` until its cycles repeat"
            )));
        }
        return Err(Error::Usage(format!(
            "{name} has no period: the signal {} does not repeat. Use sines, their sums and products, or signals that \
             become constant",
            serde_json::to_string(&signal).unwrap_or_default()
        )));
    }
    if frequencies.is_empty() {
        return match asked {
            Some(period) if period.is_finite() && period > 0.0 => Ok(PeriodicDrive { period, driven: false }),
            Some(period) => Err(Error::Usage(format!(
                "--period {period}: must be a time > 0, in seconds"
            ))),
            None => Err(Error::Usage(format!(
                "the case {name} has no periodic signal. Use a sine at an end, a load, a valve or a port; analyze the undriven \
                 case by `slcbeam floquet --period SECONDS`, or search for its self-oscillation by `slcbeam periodic` \
                 without --sweep, --sensitivity and --uncertain"
            ))),
        };
    }
    let period = common_period(&frequencies).ok_or_else(|| {
        let list: Vec<String> = frequencies.iter().map(f64::to_string).collect();
        Error::Usage(format!(
            "the frequencies of {name}, {} Hz, have no common period of at most {MOST_CYCLES} cycles; choose them in ratios \
             of small integers",
            list.join(", ")
        ))
    })?;
    match asked {
        Some(asked) => Err(Error::Usage(format!(
            "--period {asked}: {name} has a period of its own, {period} s. Omit the option"
        ))),
        None => Ok(PeriodicDrive { period, driven: true }),
    }
}

/// True if every signal becomes constant in the long run.
pub fn comes_to_rest(model: &Model) -> bool {
    let mut rests = true;
    model.each_signal(|signal| rests &= settled(signal).is_constant());
    rests
}

/// Long-run form of a signal: sines without their smooth start, ramps and tables at their last value, unless these repeat.
///
/// Polynomials of degree one and more remain unchanged: they never become constant.
pub fn settled(signal: &Signal) -> Signal {
    match signal {
        _ if signal.is_constant() => Signal::Constant(signal.value(0.0)),
        Signal::Constant(value) => Signal::Constant(*value),
        Signal::Sine(sine) => Signal::Sine(Sine {
            ramp_cycles: 0.0,
            ..sine.clone()
        }),
        Signal::Sigmoid(s) => Signal::Constant(if s.steepness_per_s > 0.0 { s.amplitude } else { 0.0 }),
        Signal::Ramp(ramp) => Signal::Constant(ramp.to),
        Signal::Polynomial(polynomial) => Signal::Polynomial(polynomial.clone()),
        Signal::Table(table) if table.repeat => Signal::Table(table.clone()),
        Signal::Table(table) => Signal::Constant(table.values.last().copied().unwrap_or(0.0)),
        Signal::Controller(controller) => Signal::Controller(controller.clone()),
        Signal::Sum(terms) => Signal::Sum(terms.iter().map(settled).collect()),
        Signal::Product(factors) => Signal::Product(factors.iter().map(settled).collect()),
    }
}

/// Long-run form of a valve's opening: one that moves and settles at or below `TIGHT` becomes zero.
pub fn settled_opening(opening: &Signal) -> Signal {
    match settled(opening) {
        rests if !opening.is_constant() && rests.is_constant() && rests.value(0.0) <= TIGHT => Signal::Constant(0.0),
        other => other,
    }
}

/// Time from which on a signal has its long-run form [s], to round-off for a sigmoid.
pub fn settles_at(signal: &Signal) -> f64 {
    let latest = |times: &mut dyn Iterator<Item = f64>| times.fold(0.0, f64::max);
    match signal {
        _ if signal.is_constant() => 0.0,
        Signal::Constant(_) | Signal::Polynomial(_) | Signal::Controller(_) => 0.0,
        Signal::Sine(sine) => sine.ramp_cycles / sine.frequency_hz,
        Signal::Sigmoid(s) => (s.midpoint_s + ROUND_OFF / s.steepness_per_s.abs()).max(0.0),
        Signal::Ramp(ramp) => (ramp.start_s + ramp.duration_s).max(0.0),
        Signal::Table(table) if table.repeat => 0.0,
        Signal::Table(table) => latest(&mut table.times_s.last().copied().into_iter()),
        Signal::Sum(parts) | Signal::Product(parts) => latest(&mut parts.iter().map(settles_at)),
    }
}

/// Period [s] of the first repeating table that has kinks or jumps.
fn kinked_period(signal: &Signal, found: &mut Option<f64>) {
    match signal {
        Signal::Table(table) if table.repeat && !table.is_smooth() => *found = found.or(table.period_s()),
        Signal::Sum(parts) | Signal::Product(parts) => parts.iter().for_each(|part| kinked_period(part, found)),
        _ => {}
    }
}

/// True if a settled signal is periodic and without kinks or jumps. No step of a cycle ends at kinks or jumps.
fn is_periodic(signal: &Signal) -> bool {
    match signal {
        Signal::Polynomial(_) | Signal::Controller(_) => false,
        Signal::Table(table) => !table.repeat || table.is_smooth(),
        Signal::Sum(parts) | Signal::Product(parts) => parts.iter().all(is_periodic),
        _ => true,
    }
}

/// Collects the frequencies [Hz] of sines and repeating tables in a settled signal.
fn collect(signal: &Signal, out: &mut Vec<f64>) {
    match signal {
        Signal::Sine(sine) if !signal.is_constant() => out.push(sine.frequency_hz),
        Signal::Table(table) if !signal.is_constant() => out.extend(table.period_s().map(f64::recip)),
        Signal::Sum(parts) | Signal::Product(parts) => parts.iter().for_each(|part| collect(part, out)),
        _ => {}
    }
}

/// Shortest time [s] that is a whole number of cycles of every frequency [Hz]; `None` if it has too many cycles.
pub fn common_period(frequencies: &[f64]) -> Option<f64> {
    let slowest = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
    (1..=MOST_CYCLES).map(f64::from).find_map(|cycles| {
        let whole = |f: &f64| {
            let count = f / slowest * cycles;
            (count - count.round()).abs() <= COMMENSURABLE * count
        };
        frequencies.iter().all(whole).then_some(cycles / slowest)
    })
}
