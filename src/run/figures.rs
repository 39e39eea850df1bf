//! The quantities of interest of a run: last value, largest value, and what happened in the window at its end.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::summary::Quantity;
use crate::case::schema::Case;

/// Largest and last value of one number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Track {
    last: f64,
    max_abs: f64,
    window_max_abs: f64,
    window_start: Option<f64>,
    #[serde(default)]
    window_squares: f64,
    #[serde(default)]
    window_samples: u32,
}

impl Track {
    fn take(&mut self, value: f64, in_window: bool) {
        self.last = value;
        self.max_abs = self.max_abs.max(value.abs());
        if in_window {
            self.window_start.get_or_insert(value);
            self.window_max_abs = self.window_max_abs.max(value.abs());
            self.window_squares += value * value;
            self.window_samples += 1;
        }
    }

    fn increment(&self) -> f64 {
        self.last - self.window_start.unwrap_or(self.last)
    }
}

/// Follows the history as it is written.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    window_start: f64,
    columns: BTreeMap<String, usize>,
    values: [(String, Track); 3],
    pressure: Option<Track>,
    input: Track,
    harvested: Option<Track>,
}

impl Figures {
    /// For a case whose history has the given columns.
    pub fn new(case: &Case, columns: &[&'static str]) -> Self {
        let window = case.time.window();
        let wet = columns.contains(&"max_pressure");
        let turbines = case.network.as_ref().is_some_and(|n| !n.turbines.is_empty());
        Self {
            window_start: case.time.end_s - window * (1.0 + 1e-9),
            columns: columns.iter().enumerate().map(|(k, c)| (c.to_string(), k)).collect(),
            values: ["tip_u1", "tip_u3", "tip_angle"].map(|name| (name.to_string(), Track::default())),
            pressure: wet.then(Track::default),
            input: Track::default(),
            harvested: turbines.then(Track::default),
        }
    }

    /// Takes one row of the history.
    pub fn take(&mut self, row: &[f64]) {
        let at = |name: &str| row[self.columns[name]];
        let in_window = row[0] >= self.window_start;
        for (name, track) in &mut self.values {
            track.take(row[self.columns[name.as_str()]], in_window);
        }
        if let Some(track) = &mut self.pressure {
            track.take(at("max_pressure").abs().max(at("min_pressure").abs()), in_window);
        }
        self.input
            .take(at("work_loads") + at("work_ends") + at("work_ports"), in_window);
        if let Some(track) = &mut self.harvested {
            track.take(at("harvested"), in_window);
        }
    }

    /// The quantities by name.
    pub fn quantities(&self) -> BTreeMap<String, Quantity> {
        let mut all = BTreeMap::new();
        let size = |t: &Track| Quantity {
            last: Some(t.last),
            max_abs: Some(t.max_abs),
            window_max_abs: Some(t.window_max_abs),
            window_rms: (t.window_samples > 0).then(|| (t.window_squares / f64::from(t.window_samples)).sqrt()),
            ..Quantity::default()
        };
        let [u1, u3, angle] = &self.values;
        all.insert("tip_u1_m".into(), size(&u1.1));
        all.insert("tip_u3_m".into(), size(&u3.1));
        all.insert("tip_angle_rad".into(), size(&angle.1));
        if let Some(p) = &self.pressure {
            all.insert("max_pressure_pa".into(), size(p));
        }
        let energy = |t: &Track| Quantity {
            last: Some(t.last),
            window: Some(t.increment()),
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
                    window: ratio(h.increment(), self.input.increment()),
                    ..Quantity::default()
                },
            );
        }
        all
    }
}
