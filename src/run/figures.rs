//! Quantities of interest of a run: last value, largest value, and figures of the window at its end.
//!
//! Largest values and root mean squares describe the motion: they use the end of every step, the extrema between, and the
//! output times. Last values and increments use the states at the ends of run and window, also if there is no output.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cubic::{self, Cubic};
use super::schedule::SAME;
use super::summary::Quantity;
use super::tracked_value::TrackedValue;
use crate::case::schema::Case;
use crate::case::spans;
use crate::discrete::System;
use crate::discrete::extrema::{MonitoredQuantity, MonitoredValues};
use crate::discrete::quantities::{Interest, InterestSource, ObservableRow};

/// Fraction of the characteristic size below which a value does not count as motion.
const FLOOR: f64 = 1e-9;

/// Accumulates the quantities of interest from the motion and the history.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FigureAccumulator {
    window_start: f64,
    /// Time in the window over which squares have been integrated [s].
    window_time: f64,
    /// Tracks of the available quantities, in the order of [`Interest::ALL`].
    tracks: Vec<TrackedValue>,
    /// True if there is fluid, and if there are turbines.
    has: [bool; 2],
    /// Length of the beam [m] and Young's modulus [Pa]: reference sizes of negligible motion.
    sizes: [f64; 2],
}

impl FigureAccumulator {
    /// Creates the figures of a case and its system.
    pub fn new(case: &Case, system: &System) -> Self {
        let turbines = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
        let has = [system.fluid.is_some(), turbines];
        Self {
            window_start: case.time.end_s - case.time.window() * (1.0 + SAME),
            window_time: 0.0,
            tracks: Interest::recorded(has).map(|_| TrackedValue::default()).collect(),
            has,
            sizes: [case.beam.length_m, spans::softest_modulus(case)],
        }
    }

    fn each(&mut self) -> impl Iterator<Item = (Interest, &mut TrackedValue)> {
        Interest::recorded(self.has).zip(&mut self.tracks)
    }

    /// Adds one row of the history and the glance at the same state.
    pub fn take(&mut self, row: &ObservableRow, glance: &MonitoredValues) {
        let in_window = row.t() >= self.window_start;
        for (one, track) in self.each() {
            match one.source() {
                InterestSource::Motion(watched @ [_]) => track.take(value(glance, watched), in_window),
                InterestSource::Motion(watched) => track.take(value(glance, watched).abs(), in_window),
                InterestSource::Energy(group) => track.take(row.sum(group), in_window),
                InterestSource::Efficiency => {}
            }
        }
    }

    /// Adds a state at any time.
    pub fn see(&mut self, glance: &MonitoredValues) {
        let in_window = glance.t >= self.window_start;
        for (one, track) in self.each() {
            if let InterestSource::Motion(watched) = one.source() {
                track.see(value(glance, watched), glance.t, in_window);
            }
        }
    }

    /// Integrates squares over the part of a step that lies in the window.
    pub fn span(&mut self, before: &MonitoredValues, now: &MonitoredValues) {
        let h = now.t - before.t;
        if now.t <= self.window_start || h <= 0.0 {
            return;
        }
        let from = ((self.window_start - before.t) / h).max(0.0);
        self.window_time += h * (1.0 - from);
        let between = |which: &MonitoredQuantity| Cubic::new(sized(before, *which), sized(now, *which), h);
        for (one, track) in self.each() {
            let squares = match one.source() {
                InterestSource::Motion([which]) => {
                    let cubic = between(which);
                    cubic::integral(from, |x| cubic.at(x).powi(2))
                }
                InterestSource::Motion(watched) => {
                    let cubics: Vec<Cubic> = watched.iter().map(between).collect();
                    let largest = |x| cubics.iter().fold(0.0, |most: f64, cubic| most.max(cubic.at(x).abs()));
                    cubic::integral(from, |x| largest(x).powi(2))
                }
                InterestSource::Energy(_) | InterestSource::Efficiency => continue,
            };
            track.square(h * squares);
        }
    }

    /// Adds an extremum of the cubic between two steps, so that largest values vary continuously with the motion. Returns true
    /// if the state itself must be evaluated: the extremum is much larger than previous values and above round-off.
    pub fn turn(&mut self, which: MonitoredQuantity, value: f64, t: f64) -> bool {
        let size = value.abs();
        let in_window = t >= self.window_start;
        let [length, modulus] = self.sizes;
        let follows =
            |one: Interest| matches!(one.source(), InterestSource::Motion(watched) if watched.contains(&which));
        let Some((one, track)) = self.each().find(|(one, _)| follows(*one)) else {
            return false;
        };
        let floor = match one.unit() {
            "m" => FLOOR * length,
            "Pa" => FLOOR * modulus,
            _ => FLOOR,
        };
        if size <= floor {
            return false;
        }
        let worth = track.worth(size, in_window);
        if !worth {
            track.see(value, t, in_window);
        }
        worth
    }

    /// Times after `after` [s] at which largest values were reached.
    pub fn reached(&self, after: f64) -> impl Iterator<Item = f64> {
        self.tracks.iter().flat_map(move |track| track.reached(after))
    }

    fn track(&self, of: Interest) -> Option<&TrackedValue> {
        let place = Interest::recorded(self.has).position(|one| one == of)?;
        self.tracks.get(place)
    }

    /// The quantities by name.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let [input, harvested] = [Interest::InputEnergy, Interest::HarvestedEnergy].map(|of| self.track(of));
        // the window has no figures before the motion reaches it
        let reached = self.window_time > 0.0 || input.is_some_and(TrackedValue::in_window);
        let ratio = |of: fn(&TrackedValue) -> f64| {
            let ratio = of(harvested?) / of(input?);
            ratio.is_finite().then_some(ratio)
        };
        let quantity = |one: Interest, t: &TrackedValue| match one.source() {
            InterestSource::Motion(watched) => {
                let swing = t.swing(reached, self.window_time);
                let of_sign = |extreme: Option<f64>| extreme.filter(|_| has_sign(watched));
                Quantity {
                    extreme: of_sign(swing.extreme),
                    window_extreme: of_sign(swing.window_extreme),
                    ..swing
                }
            }
            InterestSource::Energy(_) => Quantity {
                last: Some(t.last()),
                window: reached.then(|| t.increment()),
                window_power_w: (self.window_time > 0.0).then(|| t.increment() / self.window_time),
                ..Quantity::default()
            },
            InterestSource::Efficiency => Quantity {
                last: ratio(TrackedValue::last),
                window: ratio(TrackedValue::increment).filter(|_| reached),
                ..Quantity::default()
            },
        };
        let all = Interest::recorded(self.has).zip(&self.tracks);
        all.map(|(one, track)| (one.name().into(), quantity(one, track)))
            .collect()
    }
}

/// True if the quantity has a sign. A largest value over the beam is a magnitude.
fn has_sign(watched: &[MonitoredQuantity]) -> bool {
    let sizes = [MonitoredQuantity::Largest1, MonitoredQuantity::Largest3];
    watched.iter().all(|which| !sizes.contains(which))
}

/// Value of a quantity: of several watched values the one of largest magnitude.
fn value(glance: &MonitoredValues, watched: &[MonitoredQuantity]) -> f64 {
    match watched {
        [which] => sized(glance, *which)[0],
        _ => {
            let all = watched.iter().map(|which| glance.value_and_rate(*which)[0]);
            all.fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most })
        }
    }
}

/// Value and its rate; the magnitude if the value is the largest one over the beam.
pub fn sized(glance: &MonitoredValues, which: MonitoredQuantity) -> [f64; 2] {
    let [value, rate] = glance.value_and_rate(which);
    match which {
        MonitoredQuantity::Largest1 | MonitoredQuantity::Largest3 if value < 0.0 => [-value, -rate],
        _ => [value, rate],
    }
}
