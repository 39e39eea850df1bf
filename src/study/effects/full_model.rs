//! Effects that a case leaves out by itself, and the case that includes them.

use super::choices::{effects, with};
use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::model::Model;
use crate::model::effects::EffectSet;

/// Case with the effects that another case leaves out.
#[derive(Clone, Debug)]
pub struct Full {
    /// The case.
    pub case: Case,
    /// Additional effects.
    pub left_out: Vec<Effect>,
}

/// Returns the case with all effects that it leaves to the program. Effects that the case switches off stay off, and so
/// do effects that are active by name only. Transverse motion stays off if nothing deflects the beam, which is exact.
/// `None` if the case leaves nothing out.
pub fn full(case: &Case) -> Result<Option<Full>> {
    full_of(case, &Model::new)
}

/// Returns the same for an analysis that builds the model of a case by `model`, which may leave out other effects than a run.
pub fn full_of(case: &Case, model: &dyn Fn(&Case) -> Result<Model>) -> Result<Option<Full>> {
    let (auto, own) = (effects(case)?, model(case)?.effects);
    let mut choices = named(case, &auto);
    let open = Effect::CHOSEN.iter().copied().filter(|effect| {
        choices.choice(*effect) == Choice::Auto && !effect.by_name(case.formulation) && !straight(&auto, *effect)
    });
    let open: Vec<Effect> = open.filter(|_| case.effects != Effects::Full).collect();
    let all = with_effects(&choices, &open);
    match has(case, &all, &open) {
        true => choices = all,
        false => {
            for effect in open {
                let more = with_effects(&choices, &[effect]);
                if has(case, &more, &[effect]) {
                    choices = more;
                }
            }
        }
    }
    let case = with(case, Effects::Chosen(choices));
    let left_out = more(&own, &model(&case)?.effects);
    Ok((!left_out.is_empty()).then_some(Full { case, left_out }))
}

fn with_effects(choices: &EffectChoices, effects: &[Effect]) -> EffectChoices {
    let mut choices = choices.clone();
    effects.iter().for_each(|effect| choices.set(*effect, Choice::On));
    choices
}

/// True if the case with these choices can be computed and has the effects.
fn has(case: &Case, choices: &EffectChoices, effects: &[Effect]) -> bool {
    let case = with(case, Effects::Chosen(choices.clone()));
    System::new(&case).is_ok_and(|system| effects.iter().all(|effect| system.model.effects.has(*effect)))
}

/// Effects of `many` that `few` lacks.
fn more(few: &EffectSet, many: &EffectSet) -> Vec<Effect> {
    let more = |effect: &Effect| many.has(*effect) && !few.has(*effect);
    Effect::ALL.iter().copied().filter(more).collect()
}

/// Choices of the case, with present effects switched on.
fn named(case: &Case, auto: &EffectSet) -> EffectChoices {
    let mut choices = case.effects.choices();
    for &effect in Effect::CHOSEN {
        if choices.choice(effect) == Choice::Auto && auto.has(effect) {
            choices.set(effect, Choice::On);
        }
    }
    choices
}

/// True if the effect is transverse motion and nothing deflects the beam.
fn straight(auto: &EffectSet, effect: Effect) -> bool {
    effect == Effect::TransverseMotion && !auto.has(effect)
}
