//! Which effects a case leaves out by itself, and the cases that have more of them.

use super::choices::{effects, with};
use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::model::effects::EffectSet;

/// A case with the effects that another leaves out.
#[derive(Clone, Debug)]
pub struct Full {
    /// The case.
    pub case: Case,
    /// What it has more.
    pub left_out: Vec<Effect>,
}

/// The case with everything that it leaves to the program. What it names off stays off, and so does what comes by name only; motion
/// across stays out where nothing makes the beam leave its line, which is exact. `None` where nothing is then left out.
pub fn full(case: &Case) -> Result<Option<Full>> {
    let auto = effects(case)?;
    let mut choices = named(case, &auto);
    let open: Vec<Effect> = Effect::CHOSEN
        .iter()
        .copied()
        .filter(|effect| {
            choices.of(*effect) == Choice::Auto && !effect.by_name(case.formulation) && !straight(&auto, *effect)
        })
        .collect();
    for effect in open {
        let mut more = choices.clone();
        more.set(effect, Choice::On);
        let case = with(case, Effects::Chosen(more.clone()));
        if System::new(&case).is_ok_and(|system| system.model.effects.has(effect)) {
            choices = more;
        }
    }
    let case = with(case, Effects::Chosen(choices));
    let left_out = more(&auto, &effects(&case)?);
    Ok((!left_out.is_empty()).then_some(Full { case, left_out }))
}

/// Effects of one set that another has not.
fn more(few: &EffectSet, many: &EffectSet) -> Vec<Effect> {
    let more = |effect: &Effect| many.has(*effect) && !few.has(*effect);
    Effect::ALL.iter().copied().filter(more).collect()
}

/// What the case names, and what is there anyway.
fn named(case: &Case, auto: &EffectSet) -> EffectChoices {
    let mut choices = case.effects.choices();
    for &effect in Effect::CHOSEN {
        let there = (case.effects == Effects::Full && !effect.by_name(case.formulation)) || auto.has(effect);
        if choices.of(effect) == Choice::Auto && there {
            choices.set(effect, Choice::On);
        }
    }
    choices
}

/// Whether an effect is motion across a beam that nothing makes leave its line, or follows from it.
fn straight(auto: &EffectSet, effect: Effect) -> bool {
    effect == Effect::TransverseMotion && !auto.has(effect)
}
