//! Which effects can be left out of a case, and which others that takes.

use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::error;
use crate::model::effects::{Cause, EffectSet, Scene, needs};
use crate::model::{Model, Network};

/// An effect, and what leaving it out takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The effect.
    pub effect: Effect,
    /// How it is left out, or why it is not.
    pub out: Result<Out, Kept>,
}

/// How an effect is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Out {
    /// Effects that must be left out first; what is compared is with and without it, both without these.
    pub without: Vec<Effect>,
    /// Effects that have no meaning without it.
    pub takes: Vec<Effect>,
}

/// Why an effect is not left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// Whether it is in the full model at all.
    pub there: bool,
    /// Why, one clause.
    pub why: String,
}

/// The case with other effects.
pub fn with(case: &Case, effects: Effects) -> Case {
    Case {
        effects,
        ..case.clone()
    }
}

/// The full model, with what the case names beyond that.
///
/// # Errors
/// Of [`Network::of`].
pub fn whole(case: &Case) -> error::Result<Case> {
    without(case, &[])
}

/// The same without some effects.
///
/// # Errors
/// Of [`Network::of`].
pub fn without(case: &Case, off: &[Effect]) -> error::Result<Case> {
    let named = case.effects.choices();
    let full = EffectSet::whole(&with(case, Effects::Full), Network::of(case)?.as_ref());
    let mut choices = EffectChoices::default();
    for &effect in Effect::CHOSEN {
        // what needs what is left out goes along, and is not asked for
        let along = needs(effect).iter().any(|needed| choices.of(*needed) == Choice::Off);
        let choice = match along || off.contains(&effect) {
            true => Choice::Off,
            false if full.has(effect) || named.of(effect) == Choice::On => Choice::On,
            false => Choice::Off,
        };
        choices.set(effect, choice);
    }
    Ok(with(case, Effects::Chosen(choices)))
}

/// The effects of a case's model, which may be refused.
pub fn effects(case: &Case) -> error::Result<EffectSet> {
    Ok(Model::new(case)?.effects)
}

/// Whether the program keeps an effect, whatever its number, since without it an instability might not show. A run need not
/// show it either: what is not disturbed stays straight.
pub fn guards(case: &Case, auto: &EffectSet) -> error::Result<Option<Guard>> {
    let full = whole(case)?;
    let model = Model::new(&full)?;
    let why = Scene::new(&full, &model.section, model.wet.as_ref()).unstable();
    let guarded = auto.decisions.iter().filter(|d| matches!(d.cause, Cause::Unstable(_)));
    Ok(why.map(|why| Guard {
        effects: guarded.map(|d| d.effect).collect(),
        why,
    }))
}

/// What must not be left out, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Guard {
    /// The effects.
    pub effects: Vec<Effect>,
    /// One clause.
    pub why: String,
}

/// Every effect.
pub fn candidates(case: &Case) -> error::Result<Vec<Candidate>> {
    let (full, plain) = (effects(&whole(case)?)?, effects(&with(case, Effects::Full))?);
    let candidate = |effect: Effect| -> error::Result<Candidate> {
        let there = full.has(effect);
        let kept = |why: String| Err(Kept { there, why });
        let out = if !there {
            kept(plain.decision(effect).cause.to_string())
        } else if !Effect::CHOSEN.contains(&effect) {
            kept("given by the case, and left out by not giving it".into())
        } else {
            leave_out(case, effect, &full)?.or_else(kept)
        };
        Ok(Candidate { effect, out })
    };
    Effect::ALL.iter().copied().map(candidate).collect()
}

/// Alone where that is possible, else together with one other without which it can be compared.
fn leave_out(case: &Case, effect: Effect, full: &EffectSet) -> error::Result<Result<Out, String>> {
    let alone = effects(&without(case, &[effect])?)?;
    if alone.refusals.is_empty() {
        return Ok(Ok(Out {
            without: vec![],
            takes: taken(full, &alone, effect),
        }));
    }
    for &other in Effect::CHOSEN
        .iter()
        .filter(|other| **other != effect && full.has(**other))
    {
        let base = effects(&without(case, &[other])?)?;
        let both = effects(&without(case, &[other, effect])?)?;
        if base.refusals.is_empty() && base.has(effect) && both.refusals.is_empty() && !both.has(effect) {
            return Ok(Ok(Out {
                without: vec![other],
                takes: taken(&base, &both, effect),
            }));
        }
    }
    let refused = alone.decisions.iter().filter_map(|d| match &d.cause {
        Cause::Refused(obstacle) => Some(obstacle.what.clone()),
        _ => None,
    });
    Ok(Err(refused.collect::<Vec<_>>().join("; ")))
}

/// What goes with an effect.
fn taken(with: &EffectSet, without: &EffectSet, effect: Effect) -> Vec<Effect> {
    let gone = |other: &Effect| *other != effect && with.has(*other) && !without.has(*other);
    Effect::CHOSEN.iter().copied().filter(gone).collect()
}
