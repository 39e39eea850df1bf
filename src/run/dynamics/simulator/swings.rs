//! How inputs have gone to and fro, by which the mesh behind them is judged.

use serde::{Deserialize, Serialize};

use crate::functions::signals::{Signal, Sine};

/// Part of the largest value by which an input that turns has gone to and fro.
const SWING: f64 = 0.5;

/// What an input has been through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Swings {
    /// Its largest value, by size.
    largest: f64,
    /// When it began to go up, or down [s], from which value, and whether it goes up.
    turned: Option<(f64, f64, bool)>,
    /// Shortest time in which it went one way and turned [s].
    shortest: Option<f64>,
}

impl Swings {
    /// Of an input that begins with a value.
    pub fn of(value: f64) -> Self {
        Self {
            largest: value,
            ..Self::default()
        }
    }

    /// Takes a jump at a time [s] between two values.
    pub fn jump(&mut self, t: f64, [from, to]: [f64; 2]) {
        let up = to > from;
        if from == to || self.turned.is_some_and(|(.., went_up)| went_up == up) {
            self.see(to);
            return;
        }
        if let Some((at, value, _)) = self.turned
            && (from - value).abs() > SWING * self.largest.abs()
        {
            self.shortest = Some(self.shortest.map_or(t - at, |shortest| shortest.min(t - at)));
        }
        self.turned = Some((t, from, up));
        self.see(to);
    }

    fn see(&mut self, value: f64) {
        if value.abs() > self.largest.abs() {
            self.largest = value;
        }
    }

    /// A signal that is as large, and as fast where it went to and fro.
    pub fn like(&self) -> Signal {
        match self.shortest {
            None => Signal::Constant(self.largest),
            Some(half) => Signal::Sine(Sine {
                amplitude: self.largest,
                frequency_hz: 0.5 / half,
                phase_rad: 0.0,
                ramp_cycles: 0.0,
            }),
        }
    }
}
