//! Which effects are simulated, chosen once, each with what decided.
//!
//! ```text
//! table       what each effect needs, and whether a case gives it
//! choose      one decision after the other: what an effect needs, what stands against leaving it out, what the program chooses
//! scene       the numbers by which the program chooses
//! obstacles   what has a meaning only with an effect
//! cause       why it was decided so
//! ```
//!
//! A new effect needs: its physics in a module of its own, a line of the list in [`crate::case::schema`], and its place in
//! [`crate::discrete::residual::evaluate`]; the compiler then names the rest: what it needs in `table`, and what decides in `choose`; `docs/effects.md` has a row for each.

mod cause;
mod choose;
mod obstacles;
pub mod scene;
mod table;

use super::Network;
use crate::case::schema::{Case, Effect};
use crate::error::Violation;

pub use cause::{Cause, Keeps, Number, Weighed};
use choose::Chooser;
pub use obstacles::Obstacle;
pub use scene::Scene;
pub use table::needs;

/// A decision with what decided.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The effect.
    pub effect: Effect,
    /// Whether it is simulated.
    pub on: bool,
    /// Why.
    pub cause: Cause,
}

/// The effects that a model contains.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EffectSet {
    /// A bit for each, in the order of [`Effect::ALL`].
    on: u64,
    /// Every decision, in the order of [`Effect::ALL`].
    pub decisions: Vec<Decision>,
    /// Why a case is refused: effects that were to be left out and cannot be.
    pub refusals: Vec<Violation>,
}

impl EffectSet {
    /// Everything that a case describes; `network` is that of its bladders.
    pub fn whole(case: &Case, network: Option<&Network>) -> Self {
        Chooser::new(case, network, None).all()
    }

    /// Chooses the effects of a case for the scene it describes: what it names as it says, the rest so that what is left out
    /// changes results by less than `effects_tolerance`.
    pub fn choose(case: &Case, network: Option<&Network>, scene: &Scene) -> Self {
        Chooser::new(case, network, Some(scene)).all()
    }

    /// Whether the model contains an effect.
    #[inline]
    pub const fn has(&self, effect: Effect) -> bool {
        self.on & bit(effect) != 0
    }

    /// What was decided on an effect, which an equilibrium may leave out beyond that.
    pub fn decision(&self, effect: Effect) -> &Decision {
        &self.decisions[effect as usize]
    }

    /// The same without inertia of the solid.
    pub fn at_rest(mut self) -> Self {
        for inertia in [Effect::SolidInertia, Effect::AxialInertia, Effect::RotaryInertia] {
            self.on &= !bit(inertia);
        }
        self
    }

    /// The same without unsteady friction, unless that is asked for by name.
    pub fn forgetting(mut self) -> Self {
        let memory = Effect::UnsteadyFriction;
        if self.decision(memory).cause != Cause::Asked {
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
