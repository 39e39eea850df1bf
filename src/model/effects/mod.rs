//! Choice of the simulated effects, each with its reason.
//!
//! ```text
//! table      effects required by each effect, and data of a case for it
//! choose     decisions in order: requirements, obstacles, automatic choices
//! scene      numbers for automatic choices
//! obstacles  inputs of a case that require an effect
//! cause      reasons for decisions
//! ```
//!
//! A new effect needs a physics module, a line of the list in [`crate::case::schema`], and a place in
//! [`crate::discrete::residual::evaluate`]. The compiler then reports the missing entries in `table` (requirements) and
//! `choose` (decision). `docs/effects.md` has a row for each effect.

mod cause;
mod choose;
mod obstacles;
pub mod scene;
mod table;

use super::ResolvedNetwork;
use crate::case::schema::{Case, Effect};
use crate::error::Violation;

pub use cause::{DecisionCause, DecisiveNumber, Keeps, MeasuredAgainst};
use choose::Chooser;
pub use obstacles::Obstacle;
pub use scene::EffectScene;
pub use table::needs;

/// A decision with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The effect.
    pub effect: Effect,
    /// True if it is simulated.
    pub on: bool,
    /// Reason.
    pub cause: DecisionCause,
}

/// The effects that a model contains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectSet {
    /// A bit for each, in the order of [`Effect::ALL`].
    on: u64,
    /// Every decision, in the order of [`Effect::ALL`].
    pub decisions: Vec<Decision>,
    /// Errors of a case: effects switched off by name that cannot be omitted.
    pub refusals: Vec<Violation>,
}

impl EffectSet {
    /// All effects that a case describes; `network` is that of its bladders.
    pub fn whole(case: &Case, network: Option<&ResolvedNetwork>) -> Self {
        Chooser::new(case, network, None).all()
    }

    /// Chooses the effects of a case for its scene. Named choices apply as given. Of the others, those are omitted that
    /// change results by less than `effects_tolerance`.
    pub fn choose(case: &Case, network: Option<&ResolvedNetwork>, scene: &EffectScene) -> Self {
        Chooser::new(case, network, Some(scene)).all()
    }

    /// True if the model contains an effect.
    #[inline]
    pub const fn has(&self, effect: Effect) -> bool {
        self.on & bit(effect) != 0
    }

    /// Decision on an effect. An equilibrium may omit further effects.
    pub fn decision(&self, effect: Effect) -> &Decision {
        &self.decisions[effect as usize]
    }

    /// Removes inertia of the solid.
    pub fn at_rest(mut self) -> Self {
        for inertia in [Effect::SolidInertia, Effect::AxialInertia, Effect::RotaryInertia] {
            self.on &= !bit(inertia);
        }
        self
    }

    /// Removes unsteady friction, unless it is switched on by name.
    pub fn forgetting(mut self) -> Self {
        let memory = Effect::UnsteadyFriction;
        if self.decision(memory).cause != DecisionCause::Asked {
            self.on &= !bit(memory);
        }
        self
    }

    fn push(&mut self, decision: Decision) {
        if decision.on {
            self.on |= bit(decision.effect);
        }
        self.decisions.push(decision);
    }
}

const fn bit(effect: Effect) -> u64 {
    1 << effect as u32
}
