//! Wall time of a simulator by part.

use std::time::Instant;

/// Wall time of a simulator [s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimulatorWallTimes {
    /// Steps of the integrator: equations, their derivatives, linear systems.
    pub integration: f64,
    /// Jumps of inputs: consistent values after them, and works of the jumps.
    pub jumps: f64,
    /// Observation of states: limits of the model, largest values, balances, the row.
    pub watching: f64,
}

impl SimulatorWallTimes {
    /// Adds the time since an instant to a part, and restarts the clock.
    pub(super) fn add(part: &mut f64, since: &mut Instant) {
        let now = Instant::now();
        *part += (now - *since).as_secs_f64();
        *since = now;
    }
}
