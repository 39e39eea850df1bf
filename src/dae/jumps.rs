//! Switches: replaced signals, the state after a switch, and the work done in zero time.

use super::BeamDae;
use crate::discrete::{ledger, residual, start, velocity_jump};
use crate::functions::control::ControlState;
use crate::functions::signals::{Signal, SmoothTime};

impl BeamDae {
    /// Replaces the signal at the places of [`System::places_of`].
    pub fn put_signal(&mut self, places: &[usize], given: &Signal) {
        self.system.put_signal(places, given);
        self.forget_signals();
    }

    /// Sets the output of the controller at an index among those of the model.
    pub fn hold_output(&mut self, controller: usize, state: &ControlState) {
        self.system.hold_output(controller, state);
        self.forget_signals();
    }

    fn forget_signals(&mut self) {
        self.now.forget();
        self.before.forget();
        self.held = None;
    }

    /// Switches at time `t` [s] to signals in the smooth interval around `within`, and converts the scaled unknowns: position and
    /// velocity of the beam remain unchanged. The exception is the velocity jump of a driven end, which is transmitted to sections that
    /// rotate, [`kick`].
    pub fn switch(&mut self, t: f64, within: f64, y: &mut [f64]) {
        self.look_back(t, self.within);
        self.enter_smooth_interval(within);
        self.instant(t);
        let (system, b) = (&self.system, &mut self.plain);
        let (before, after) = (&self.before, &self.now);
        if before.moves_like(after) {
            return;
        }
        start::change_frame(system, before, after, y);
        b.take_up(system, after, y);
        if let Some(jumps) = velocity_jump::spread(system, [before, after], &b.workspace) {
            start::speed_up(system, &jumps, y);
        }
    }

    /// Stores the time data at an instant, as given by the smooth interval around another instant [s].
    fn look_back(&mut self, t: f64, within: f64) {
        self.held = None;
        self.before.update(&self.system, SmoothTime { t, within });
        self.before.cj = self.now.cj;
    }

    /// Adds to integrals the work done in zero time at `t` [s], between two scaled states. The signals of the first state belong to the
    /// smooth interval around another instant [s], those of the second to the present one. See [`ledger::side`] and [`ledger::strokes`].
    pub fn jump(&mut self, t: f64, (before, within): (&[f64], f64), after: &[f64], integrals: &mut [f64]) {
        self.look_back(t, within);
        self.instant(t);
        let (system, b) = (&self.system, &mut self.plain);
        let (from, to) = (&self.before, &self.now);
        let l = &system.layout;
        let unmoved = l.unmoved(before, after);
        if unmoved && l.unfilled(before, after) && from.works_like(to) {
            return;
        }
        let mut part = vec![0.0; integrals.len()];
        for (state, side) in [(before, from), (after, to)] {
            let mut now = side.clone();
            ledger::travel(&mut now, [from, to]);
            for (k, scale) in l.scales.iter().enumerate() {
                b.y[k] = state[k] * scale;
                b.yp[k] = (after[k] - before[k]) * scale;
            }
            // Velocities become the jumps of displacements; accelerations are zero.
            for (u, v) in l.moved() {
                if let Some(v) = v {
                    b.y[v] = b.yp[u];
                    b.yp[v] = 0.0;
                }
            }
            residual::evaluate(system, &now, &b.y, &b.yp, &mut b.workspace);
            ledger::side(system, &now, &b.yp, &mut b.workspace, &mut part);
            for (total, part) in integrals.iter_mut().zip(&part) {
                *total += 0.5 * part;
            }
        }
        if unmoved && from.moves_like(to) {
            return;
        }
        let velocities = [(before, from), (after, to)].map(|(state, side)| {
            b.take_up(system, side, state);
            velocity_jump::velocities(&b.workspace)
        });
        ledger::strokes(system, [from, to], &velocities, &b.workspace, integrals);
    }
}
