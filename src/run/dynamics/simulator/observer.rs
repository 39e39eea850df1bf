//! Takes samples of controllers, observes accepted steps as in a run, and ends where a validity limit is exceeded.

use super::{Simulator, beyond, fault, narrow, solver};
use crate::error::Result;

impl Simulator {
    /// Takes the samples of controllers at a stop at time `t` [s], on its left side. Returns true if an output changes.
    pub(super) fn control_stop(&mut self, t: f64) -> Result<bool> {
        let before = [&self.state[..], &self.rates, &self.carried];
        self.control.sample(self.solver.dae_mut(), t, before).map_err(solver)
    }

    /// Observes the end of an accepted step from time `from` [s], and possible extrema inside. If a validity limit is exceeded, the
    /// simulation remains at that time.
    pub(super) fn watch(&mut self, from: f64, t: f64) -> Result<()> {
        self.read(t)?;
        let dae = self.solver.dae_mut();
        if let Some(what) = self.observer.arrive(dae, t, &self.state, &self.rates, &self.integrals) {
            return self.leave([from, t], what);
        }
        let mut within = from;
        for k in 0..self.observer.turning().len() {
            let t = self.observer.turning()[k];
            self.read(t)?;
            let dae = self.solver.dae_mut();
            if let Some(what) = self.observer.look(dae, t, &self.state, &self.rates, &self.integrals) {
                return self.leave([within, t], what);
            }
            within = t;
        }
        Ok(())
    }

    /// Ends at the time [s] at which a validity limit is exceeded, between a time within the limits and one beyond.
    fn leave(&mut self, between: [f64; 2], what: String) -> Result<()> {
        let (t, what) = narrow(between, what, |t| {
            self.read(t)?;
            let (state, rates) = (&self.state, &self.rates);
            Ok(self.observer.beyond(self.solver.dae_mut(), t, state, rates))
        })?;
        self.read(t)?;
        self.carried.copy_from_slice(&self.integrals);
        let restarted = self.solver.restart(t, &self.state, &self.rates);
        restarted.map_err(|failure| solver(fault(&failure)))?;
        Err(solver(beyond(t, what)))
    }
}
