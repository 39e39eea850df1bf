//! How strains follow from displacements.

use super::EffectSet;
use crate::case::schema::Effect;

/// The kinematics of a model, from that of a bar to that of finite rotations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// A bar, which can only stretch.
    Bar,
    /// Small rotations, and no normal force on bending: the linear beam.
    Linear,
    /// Small rotations (von Karman).
    SmallRotation,
    /// Rotations of any size.
    FiniteRotation,
}

impl Kinematics {
    /// The least that holds the effects.
    pub fn of(effects: &EffectSet) -> Self {
        match effects {
            e if !e.has(Effect::TransverseMotion) => Self::Bar,
            e if e.has(Effect::FiniteRotation) => Self::FiniteRotation,
            e if e.has(Effect::AxialForceOnBending) => Self::SmallRotation,
            _ => Self::Linear,
        }
    }
}
