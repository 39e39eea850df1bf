//! How strains follow from displacements.

use super::EffectSet;

/// The kinematics of a model, from that of a bar to that of finite rotations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// A bar, which can only stretch.
    Bar,
    /// Rotations of any size.
    FiniteRotation,
}

impl Kinematics {
    /// The least that holds the effects.
    pub fn of(effects: &EffectSet) -> Self {
        if effects.transverse_motion {
            Self::FiniteRotation
        } else {
            Self::Bar
        }
    }
}
