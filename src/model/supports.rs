//! Supports of the beam against rigid-body translation, which a state at rest requires.

use super::{AttachedBody, Model};
use crate::case::schema::Effect;
use crate::case::{ResolvedEnd, Translation};

impl Model {
    /// Directions in which neither an end nor a spring supports the beam. Loads accelerate it there, or without loads
    /// its position is arbitrary. Walls count as supports. Rotation of a beam held at one place is not checked.
    pub fn unheld(&self) -> Vec<&'static str> {
        if !self.contacts.is_empty() {
            return vec![];
        }
        let driven = |of: &Translation| matches!(of, Translation::Displacement(_));
        if self.structure.is_some() {
            // the axes of beams differ: one support in both directions is enough
            let held = |end: &ResolvedEnd| driven(&end.transverse) && driven(&end.axial);
            let sprung = |one: &AttachedBody| one.stiffness.x > 0.0 && one.stiffness.z > 0.0;
            return match self.ends.iter().any(held) || self.attachments.iter().any(sprung) {
                true => vec![],
                false => vec!["along", "across"],
            };
        }
        let ends = &self.ends;
        let springs = &self.attachments;
        let [bed_across, bed_along] = [0, 1].map(|axis| self.foundation[axis].is_some());
        let along =
            ends.iter().any(|end| driven(&end.axial)) || springs.iter().any(|one| one.stiffness.z > 0.0) || bed_along;
        let across = ends.iter().any(|end| driven(&end.transverse))
            || springs.iter().any(|one| one.stiffness.x > 0.0)
            || bed_across;
        let moves_across = self.effects.has(Effect::TransverseMotion);
        let all = [("along", !along), ("across", !across && moves_across)];
        all.into_iter()
            .filter(|(_, free)| *free)
            .map(|(word, _)| word)
            .collect()
    }
}
