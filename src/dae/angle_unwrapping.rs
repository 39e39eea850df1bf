//! Unwrapping of angles from one state to the next.

use super::{BeamDae, PerturbedSystems};
use crate::discrete::angle_unwrapping::AngleUnwrapping;

impl BeamDae {
    /// Continues the unwrapping from the last evaluated state.
    pub fn keep_turns(&mut self) -> &AngleUnwrapping {
        self.hold_turns(&AngleUnwrapping::new(&self.system, &self.now, &self.plain.workspace));
        &self.now.turns
    }

    /// Continues the unwrapping from these angles.
    pub fn hold_turns(&mut self, turns: &AngleUnwrapping) {
        for beam in self.perturbed.iter_mut().flat_map(PerturbedSystems::beams_mut) {
            beam.hold_turns(turns);
        }
        self.before.turns.clone_from(turns);
        self.now.turns.clone_from(turns);
    }

    /// Unwraps angles along the beam at a scaled state; at its root the present number of turns is kept.
    pub fn find_turns(&mut self, t: f64, y: &[f64], yp: &[f64]) {
        self.visit(t, y, yp, |_, _, _, _| ());
        self.keep_turns();
    }
}
