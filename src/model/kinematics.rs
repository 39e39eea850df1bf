//! Strain-displacement relations.

use super::EffectSet;
use crate::case::schema::Effect;

/// Kinematics of a model, from a bar to finite rotations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kinematics {
    /// A bar, stretch only.
    Bar,
    /// Small rotations without normal force on bending: the linear beam.
    Linear,
    /// Small rotations (von Karman).
    SmallRotation,
    /// Rotations of any size.
    FiniteRotation,
}

impl Kinematics {
    /// The simplest kinematics that contain the effects.
    pub fn from_effects(effects: &EffectSet) -> Self {
        match effects {
            e if !e.has(Effect::TransverseMotion) => Self::Bar,
            e if e.has(Effect::FiniteRotation) => Self::FiniteRotation,
            e if e.has(Effect::AxialForceOnBending) => Self::SmallRotation,
            _ => Self::Linear,
        }
    }
}
