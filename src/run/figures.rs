//! The quantities of interest of a run: last value, largest value, and what happened in the window at its end.
//!
//! Largest values and root mean squares are those of the motion: of every step's end, of the turning points between, and of
//! the output times; last values and increments are those of the run's and the window's ends, where the state is taken whether
//! there is an output or not.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::cubic::{self, Cubic};
use super::schedule::SAME;
use super::summary::Quantity;
use crate::case::schema::Case;
use crate::discrete::glance::{Glance, Watched};

/// Excess over the largest value seen for which the state at a turning point between two steps is looked at; below it the cubic
/// through values and rates at the step's ends is as good.
const WORTH: f64 = 1e-3;
/// Share of the characteristic size below which nothing is a motion.
const FLOOR: f64 = 1e-9;

/// Quantities that swing: their names, and what they are.
const SWINGING: [(&str, Watched); 6] = [
    ("tip_u1_m", Watched::Tip1),
    ("tip_u3_m", Watched::Tip3),
    ("tip_angle_rad", Watched::Angle),
    ("midspan_u1_m", Watched::Middle1),
    ("largest_u1_m", Watched::Largest1),
    ("largest_u3_m", Watched::Largest3),
];

/// Largest and last value of one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Track {
    last: f64,
    max_abs: f64,
    window_max_abs: f64,
    window_start: Option<f64>,
    /// Integral of the square over the window, as far as it has been followed.
    window_squares: f64,
}

impl Track {
    /// Takes the value at an output time, or at an end of the window.
    fn take(&mut self, value: f64, in_window: bool) {
        self.last = value;
        if in_window {
            self.window_start.get_or_insert(value);
        }
    }

    /// Takes the size of a value at any time.
    fn see(&mut self, size: f64, in_window: bool) {
        self.max_abs = self.max_abs.max(size);
        if in_window {
            self.window_max_abs = self.window_max_abs.max(size);
        }
    }

    fn increment(&self) -> f64 {
        self.last - self.window_start.unwrap_or(self.last)
    }

    /// Whether a size between two steps is worth a look.
    fn worth(&self, size: f64, in_window: bool) -> bool {
        size > (1.0 + WORTH) * self.max_abs || in_window && size > (1.0 + WORTH) * self.window_max_abs
    }
}

/// Follows the motion and the history.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    window_start: f64,
    /// Time in the window over which squares have been integrated [s].
    window_time: f64,
    columns: BTreeMap<String, usize>,
    swinging: [Track; SWINGING.len()],
    pressure: Option<Track>,
    input: Track,
    harvested: Option<Track>,
    /// Length of the beam [m] and Young's modulus [Pa]: sizes against which motion is nothing.
    sizes: [f64; 2],
}

impl Figures {
    /// For a case whose history has the given columns.
    pub fn new(case: &Case, columns: &[&'static str]) -> Self {
        let window = case.time.window();
        let wet = columns.contains(&"max_pressure");
        let turbines = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
        Self {
            window_start: case.time.end_s - window * (1.0 + SAME),
            window_time: 0.0,
            columns: columns.iter().enumerate().map(|(k, c)| (c.to_string(), k)).collect(),
            swinging: [Track::default(); SWINGING.len()],
            pressure: wet.then(Track::default),
            input: Track::default(),
            harvested: turbines.then(Track::default),
            sizes: [case.beam.length_m, case.beam.young_modulus_pa],
        }
    }

    /// Takes one row, as of the history, with the look at the same state.
    pub fn take(&mut self, row: &[f64], glance: &Glance) {
        let at = |name: &str| row[self.columns[name]];
        let in_window = row[0] >= self.window_start;
        for (track, (_, which)) in self.swinging.iter_mut().zip(SWINGING) {
            track.take(value(glance, which), in_window);
        }
        if let Some(track) = &mut self.pressure {
            track.take(pressure(glance), in_window);
        }
        self.input
            .take(at("work_loads") + at("work_ends") + at("work_ports"), in_window);
        if let Some(track) = &mut self.harvested {
            track.take(at("harvested"), in_window);
        }
    }

    /// Takes a state at any time.
    pub fn see(&mut self, glance: &Glance) {
        let in_window = glance.t >= self.window_start;
        for (track, (_, which)) in self.swinging.iter_mut().zip(SWINGING) {
            track.see(value(glance, which).abs(), in_window);
        }
        if let Some(track) = &mut self.pressure {
            track.see(pressure(glance), in_window);
        }
    }

    /// Integrates squares over a step, as far as it lies in the window.
    pub fn span(&mut self, before: &Glance, now: &Glance) {
        let h = now.t - before.t;
        if now.t <= self.window_start || h <= 0.0 {
            return;
        }
        let from = ((self.window_start - before.t) / h).max(0.0);
        self.window_time += h * (1.0 - from);
        let between = |which| Cubic::new(sized(before, which), sized(now, which), h);
        for (track, (_, which)) in self.swinging.iter_mut().zip(SWINGING) {
            let cubic = between(which);
            track.window_squares += h * cubic::integral(from, |x| cubic.at(x).powi(2));
        }
        if let Some(track) = &mut self.pressure {
            let (high, low) = (between(Watched::High), between(Watched::Low));
            track.window_squares += h * cubic::integral(from, |x| high.at(x).abs().max(low.at(x).abs()).powi(2));
        }
    }

    /// Takes a turning point of the cubic between two steps, so that largest values change steadily with the motion. Returns whether
    /// it is worth a look at the state itself: much larger than what has been seen, and no mere round-off.
    pub fn turn(&mut self, which: Watched, size: f64, t: f64) -> bool {
        let in_window = t >= self.window_start;
        let [length, modulus] = self.sizes;
        let (track, floor) = match which {
            Watched::High | Watched::Low => (self.pressure.as_mut(), FLOOR * modulus),
            _ => {
                let place = SWINGING.iter().position(|(_, of)| *of == which);
                let floor = if which == Watched::Angle { FLOOR } else { FLOOR * length };
                (place.map(|k| &mut self.swinging[k]), floor)
            }
        };
        let Some(track) = track.filter(|_| size > floor) else {
            return false;
        };
        let worth = track.worth(size, in_window);
        if !worth {
            track.see(size, in_window);
        }
        worth
    }

    /// Whether the motion has come to the window: before, there is nothing to tell of it.
    fn in_window(&self) -> bool {
        self.window_time > 0.0 || self.input.window_start.is_some()
    }

    /// The quantities by name.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let mut all = BTreeMap::new();
        let reached = self.in_window();
        let size = |t: &Track| Quantity {
            last: Some(t.last),
            max_abs: Some(t.max_abs),
            window_max_abs: reached.then_some(t.window_max_abs),
            window_rms: (self.window_time > 0.0).then(|| (t.window_squares / self.window_time).sqrt()),
            ..Quantity::default()
        };
        for (track, (name, _)) in self.swinging.iter().zip(SWINGING) {
            all.insert(name.into(), size(track));
        }
        if let Some(p) = &self.pressure {
            all.insert("max_pressure_pa".into(), size(p));
        }
        let energy = |t: &Track| Quantity {
            last: Some(t.last),
            window: reached.then(|| t.increment()),
            ..Quantity::default()
        };
        all.insert("input_energy_j".into(), energy(&self.input));
        if let Some(h) = &self.harvested {
            all.insert("harvested_energy_j".into(), energy(h));
            let ratio = |a: f64, b: f64| (b != 0.0 && (a / b).is_finite()).then_some(a / b);
            all.insert(
                "efficiency".into(),
                Quantity {
                    last: ratio(h.last, self.input.last),
                    window: ratio(h.increment(), self.input.increment()).filter(|_| reached),
                    ..Quantity::default()
                },
            );
        }
        all
    }
}

/// A value as its quantity has it: sizes where the place may be any.
fn value(glance: &Glance, which: Watched) -> f64 {
    sized(glance, which)[0]
}

/// A value with its rate; of what is largest anywhere, the size.
pub fn sized(glance: &Glance, which: Watched) -> [f64; 2] {
    let [value, rate] = glance.of(which);
    match which {
        Watched::Largest1 | Watched::Largest3 if value < 0.0 => [-value, -rate],
        _ => [value, rate],
    }
}

fn pressure(glance: &Glance) -> f64 {
    glance.of(Watched::High)[0].abs().max(glance.of(Watched::Low)[0].abs())
}
