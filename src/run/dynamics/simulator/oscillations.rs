//! Oscillations of inputs, by which the mesh is assessed.

use serde::{Deserialize, Serialize};

use crate::functions::signals::{Signal, Sine};

/// Least change between two reversals that counts as an oscillation, over the largest value.
const SWING: f64 = 0.5;

/// Record of the oscillations of an input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct InputOscillations {
    /// Value of largest magnitude.
    largest: f64,
    /// Start of the present rise or fall: time [s], value, and true for a rise.
    turned: Option<(f64, f64, bool)>,
    /// Shortest time between two reversals [s].
    shortest: Option<f64>,
}

impl InputOscillations {
    /// Record of an input that begins with a value.
    pub fn new(value: f64) -> Self {
        Self {
            largest: value,
            ..Self::default()
        }
    }

    /// Adds a jump at a time [s] between two values.
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

    /// A signal with the same largest value and, if the input oscillated, with its shortest period.
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
