//! Where the wall time of a simulator goes.

use std::time::Instant;

/// Wall time that a simulator has spent [s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent {
    /// Steps of the integrator: equations, their derivatives, linear systems.
    pub integration: f64,
    /// What a jump of inputs asks for: consistent values behind it, what it does in no time.
    pub jumps: f64,
    /// Looking at what was reached: limits of the model, largest values, balances, the row.
    pub watching: f64,
}

impl Spent {
    /// Adds the time since an instant to one of the parts, and begins the next.
    pub(super) fn add(part: &mut f64, since: &mut Instant) {
        let now = Instant::now();
        *part += (now - *since).as_secs_f64();
        *since = now;
    }
}
