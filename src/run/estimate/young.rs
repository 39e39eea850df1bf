//! A wave that an end or a pulse sends out, while it has not yet become a vibration of the whole beam.

use crate::case::schema::Case;
use crate::case::{Rotation, Translation};
use crate::discrete::System;
use crate::functions::signals::Signal;
use crate::model::Model;

/// What a motion grows like that a smooth step begins: the third power of time, and two more by inertia.
const POWER: f64 = 5.0;
/// Part of its range by which a signal has begun to change.
const BEGUN: f64 = 1e-3;
/// Halvings of the end of the run in which its beginning is looked for.
const HALVINGS: usize = 40;
/// Kinds of what drives a beam, of which pressures of ports act both ways; those before act across, those behind along.
const KINDS: usize = 7;
const PORTS: usize = 4;

/// How many times as large as that of the first vibration the square of the wave number is of what is sent out across and along, at
/// least 1. `omega`: angular frequencies of the first vibrations [1/s], 0 where there are none.
pub fn shorter(case: &Case, system: &System, omega: [f64; 2]) -> [f64; 2] {
    let [across, along] =
        [0, 1].map(|k| Some(omega[k]).filter(|omega| *omega > 0.0 && system.layout.lines[k].v.is_some()));
    let drives = drives(&system.model);
    let end = case.time.end_s;
    [
        across.map_or(1.0, |omega| {
            begun(&drives[..PORTS], case, omega).max(pulses(&drives[..=PORTS], end, omega))
        }),
        along.map_or(1.0, |omega| pulses(&drives[PORTS..], end, omega).powi(2)),
    ]
}

fn drives(model: &Model) -> [Vec<&Signal>; KINDS] {
    let mut kinds: [Vec<&Signal>; KINDS] = Default::default();
    for at in &model.ends {
        let across = match &at.transverse {
            Translation::Displacement(signal) => (0, signal),
            Translation::Force(signal) => (1, signal),
        };
        let turning = match &at.rotation {
            Rotation::Slope(signal) => (2, signal),
            Rotation::Moment(signal) => (3, signal),
        };
        let along = match &at.axial {
            Translation::Displacement(signal) => (5, signal),
            Translation::Force(signal) => (6, signal),
        };
        for (kind, signal) in [across, turning, along] {
            kinds[kind].push(signal);
        }
    }
    let ports = model.wet.iter().flat_map(|wet| &wet.network.ports);
    kinds[PORTS].extend(ports.map(|port| &port.pressure));
    kinds
}

/// Of ends that have begun to act not long before the run ends:
///
/// ```text
/// what grows like t^n grows at the rate n/t:  m (n/t)² u + EI u'''' = 0,  |β|² = n/(t √(EI/m))
/// ```
///
/// At a distance x it is `e^(-βx/√2)` of what it is at the end: what the mesh changes of β counts `βx` times.
fn begun(drives: &[Vec<&Signal>], case: &Case, omega: f64) -> f64 {
    let (held, end) = (case.start.equilibrium.is_some(), case.time.end_s);
    let from = (end - POWER / omega).max(0.0);
    let begins = drives
        .iter()
        .flatten()
        .filter_map(|signal| begins(signal, held, [from, end]));
    let first = begins.reduce(f64::min);
    first.map_or(1.0, |first| (POWER / ((end - first) * omega)).max(1.0))
}

/// Of pulses that are over long before the beam has followed them: what such a one sends out has the wave number of `n = 1` at its end,
/// `|β|² ~ 1/t` of bending (of stretch `1/t²`), and does to the beam what its time over that of the first vibration is of what it would
/// at rest. Between drives of one kind that is weighed.
fn pulses(drives: &[Vec<&Signal>], end: f64, omega: f64) -> f64 {
    let of = |signals: &Vec<&Signal>| {
        let all = signals.iter().map(|signal| signal.lasting(end, 1.0 / omega));
        let [sizes, done] = all.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        if done > 0.0 { sizes / done } else { 1.0 }
    };
    drives.iter().map(of).fold(1.0, f64::max)
}

/// When within a time [s] a signal begins to be another one than at the start, or than nothing; the begin of that time where it has begun
/// before, none where it never does.
fn begins(signal: &Signal, held: bool, [from, end]: [f64; 2]) -> Option<f64> {
    let at_start = if held { signal.value(0.0) } else { 0.0 };
    let away = |until: f64| {
        let range = signal.range(0.0, until);
        (range.high - at_start).max(at_start - range.low)
    };
    let whole = away(end);
    if whole <= 0.0 {
        return None;
    }
    let begun = |until: f64| away(until) > BEGUN * whole;
    if from > 0.0 && begun(from) {
        return Some(from);
    }
    let (mut low, mut high) = (from, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if begun(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(low)
}
