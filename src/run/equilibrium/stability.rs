//! Stability of the states of a path.

use super::EquilibriumStability;
use super::path::PathFollower;
use crate::integrate::halt;

impl PathFollower<'_> {
    /// Determines the stability of every state. Between events the determinant keeps its sign. If the first and the last state of such
    /// an interval have equally many unstable directions, so have those in between; else each is evaluated.
    pub(super) fn judge(&mut self) {
        self.bounds.push(self.path.states.len());
        for k in 1..self.bounds.len() {
            let (first, next) = (self.bounds[k - 1], self.bounds[k]);
            if first >= next {
                continue;
            }
            let last = next - 1;
            let ends = [first, last].map(|k| self.stability(k));
            let same = ends[0].map(|s| s.unstable) == ends[1].map(|s| s.unstable);
            for state in first + 1..last {
                let inherited = ends[0].map(|s| EquilibriumStability { softest: None, ..s });
                self.path.states[state].stability = match same {
                    true => inherited,
                    false if halt::asked() => None,
                    false => self.stability(state),
                };
            }
            (self.path.states[first].stability, self.path.states[last].stability) = (ends[0], ends[1]);
        }
    }

    fn stability(&mut self, k: usize) -> Option<EquilibriumStability> {
        let state = &self.path.states[k];
        EquilibriumStability::assess(self.solver.dae_mut().statics(), state.share, &state.y)
    }
}
