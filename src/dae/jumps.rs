//! Over a switch: the state on its other side, and what is done in no time.

use super::BeamDae;
use crate::discrete::{kick, ledger, residual, start};
use crate::functions::signals::Clock;

impl BeamDae {
    /// At a switching time `t` [s]: looks at signals in the smooth interval around `within` from now on, and restates the
    /// scaled unknowns so that the beam stays where it is and as fast as it is, but for what a driven end whose velocity jumps hands on
    /// to sections that turn, [`kick`].
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
        if let Some(jumps) = kick::spread(system, [before, after], &b.workspace) {
            start::speed_up(system, &jumps, y);
        }
    }

    /// Keeps the values of time at an instant, as the smooth interval around another has them [s].
    fn look_back(&mut self, t: f64, within: f64) {
        self.held = None;
        self.before.update(&self.system, Clock { t, within });
        self.before.cj = self.now.cj;
    }

    /// Adds to integrals what is done in no time at `t` [s]: from a scaled state of which signals were looked at around another
    /// instant [s], to one in the present smooth interval. See [`ledger::side`] and [`ledger::strokes`].
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
            // Velocities become what displacements jump by, and nothing is accelerated.
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
            kick::velocities(&b.workspace)
        });
        ledger::strokes(system, [from, to], &velocities, &b.workspace, integrals);
    }
}
