//! A bending wave that an end sends out, while it has not yet become a vibration of the whole beam.

use crate::case::schema::Case;
use crate::case::signals::Signal;
use crate::case::{Rotation, Translation};
use crate::discrete::System;

/// What a motion grows like that a smooth step begins: the third power of time, and two more by inertia.
const POWER: f64 = 5.0;
/// Part of its range by which a signal has begun to change.
const BEGUN: f64 = 1e-3;
/// Halvings of the run in which its beginning is looked for.
const HALVINGS: usize = 40;

/// How many times as large as that of the first vibration, of frequency `first √(EI/m)/l²`, the square of the wave number is that a drive
/// of an end has by the end of the run, at least 1.
///
/// ```text
/// what grows like t^n grows at the rate n/t:  m (n/t)² u + EI u'''' = 0,  |β|² = n/(t √(EI/m))
/// ```
///
/// At a distance x it is `e^(-βx/√2)` of what it is at the end: what the mesh changes of β counts `βx` times.
pub fn shorter(case: &Case, system: &System, first: f64) -> f64 {
    let (model, end) = (&system.model, case.time.end_s);
    if first <= 0.0 || !system.layout.waves[0] {
        return 1.0;
    }
    let s = &model.section;
    let unit = (s.bending_stiffness / s.mass_per_length).sqrt() / (model.length * model.length);
    let held = case.start.equilibrium.is_some();
    let signals = model.ends.iter().flat_map(|end| {
        let (Translation::Displacement(across) | Translation::Force(across)) = &end.transverse;
        let (Rotation::Slope(turning) | Rotation::Moment(turning)) = &end.rotation;
        [across, turning]
    });
    let begins = signals.filter_map(|signal| begins(signal, held, end)).reduce(f64::min);
    begins.map_or(1.0, |begins| (POWER / ((end - begins) * unit * first)).max(1.0))
}

/// The same of pulses, by ends and by ports, that are over long before the beam has followed them, across and along: what such a one sends
/// out has the wave number of `n = 1` at its end, `|β|² ~ 1/ω` of bending and `1/ω²` of stretch, and does to the beam what its time over
/// that of the first vibration is of what it would at rest. Between drives of one kind that is weighed. `first`: frequencies of the first
/// vibrations over `√(EI/m)/l²` and `√(EA/m)/l`.
pub fn pulses(case: &Case, system: &System, first: [f64; 2]) -> [f64; 2] {
    let (model, end) = (&system.model, case.time.end_s);
    let s = &model.section;
    let across = (s.bending_stiffness / s.mass_per_length).sqrt() / (model.length * model.length);
    let along = (s.axial_stiffness / s.mass_per_length).sqrt() / model.length;
    let mut kinds: [Vec<&Signal>; 7] = Default::default();
    for at in &model.ends {
        match &at.transverse {
            Translation::Displacement(signal) => kinds[0].push(signal),
            Translation::Force(signal) => kinds[1].push(signal),
        }
        match &at.rotation {
            Rotation::Slope(signal) => kinds[2].push(signal),
            Rotation::Moment(signal) => kinds[3].push(signal),
        }
        match &at.axial {
            Translation::Displacement(signal) => kinds[5].push(signal),
            Translation::Force(signal) => kinds[6].push(signal),
        }
    }
    let ports = model.wet.iter().flat_map(|wet| &wet.network.ports);
    kinds[4].extend(ports.map(|port| &port.pressure));
    let shorter = |kinds: &[Vec<&Signal>], omega: f64| {
        let of = |signals: &Vec<&Signal>| {
            let all = signals.iter().map(|signal| signal.lasting(end, 1.0 / omega));
            let [sizes, done] = all.fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
            if done > 0.0 { sizes / done } else { 1.0 }
        };
        kinds.iter().map(of).fold(1.0, f64::max)
    };
    let [bends, stretches] = [0, 1].map(|k| first[k] > 0.0 && system.layout.waves[k]);
    [
        if bends {
            shorter(&kinds[..5], across * first[0])
        } else {
            1.0
        },
        if stretches {
            shorter(&kinds[4..], along * first[1]).powi(2)
        } else {
            1.0
        },
    ]
}

/// When a signal begins to be another one than at the start, or than nothing [s]; none that never does.
fn begins(signal: &Signal, held: bool, end: f64) -> Option<f64> {
    let at_start = if held { signal.value(0.0) } else { 0.0 };
    let away = |until: f64| {
        let range = signal.range(0.0, until);
        (range.high - at_start).max(at_start - range.low)
    };
    let whole = away(end);
    if whole <= 0.0 {
        return None;
    }
    let (mut low, mut high) = (0.0, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if away(middle) > BEGUN * whole {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(low)
}
