//! Effects that can be left out of a case, and other effects that are left out with them.

use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::error;
use crate::model::effects::{DecisionCause, EffectScene, EffectSet, needs};
use crate::model::{Model, ResolvedNetwork};

/// Effect, and the way to leave it out.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectCandidate {
    /// The effect.
    pub effect: Effect,
    /// Way to leave it out, or the reason to keep it.
    pub out: Result<OmissionKind, KeepReason>,
}

/// Way to leave an effect out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OmissionKind {
    /// Effects that must be left out first; neither of the compared models has them.
    pub without: Vec<Effect>,
    /// Effects that have no meaning without it.
    pub takes: Vec<Effect>,
}

/// Reason to keep an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct KeepReason {
    /// True if it is in the full model.
    pub there: bool,
    /// Reason, one clause.
    pub why: String,
}

/// Returns the case with other effects.
pub fn with(case: &Case, effects: Effects) -> Case {
    Case {
        effects,
        ..case.clone()
    }
}

/// Returns the full model, with effects that the case names beyond it.
///
/// # Errors
/// Those of [`Network::of`].
pub fn whole(case: &Case) -> error::Result<Case> {
    without(case, &[])
}

/// Returns the full model without some effects.
///
/// # Errors
/// Those of [`Network::of`].
pub fn without(case: &Case, off: &[Effect]) -> error::Result<Case> {
    let named = case.effects.choices();
    let full = EffectSet::whole(&with(case, Effects::Full), ResolvedNetwork::from_case(case)?.as_ref());
    let mut choices = EffectChoices::default();
    for &effect in Effect::CHOSEN {
        // effects that need an omitted effect are omitted, too
        let along = needs(effect)
            .iter()
            .any(|needed| choices.choice(*needed) == Choice::Off);
        let choice = match along || off.contains(&effect) {
            true => Choice::Off,
            false if full.has(effect) || named.choice(effect) == Choice::On => Choice::On,
            false => Choice::Off,
        };
        choices.set(effect, choice);
    }
    Ok(with(case, Effects::Chosen(choices)))
}

/// Returns the effects of a case's model, with refusals if there are any.
pub fn effects(case: &Case) -> error::Result<EffectSet> {
    Ok(Model::new(case)?.effects)
}

/// Returns the effects that the program always keeps because an instability might not show without them. A run need not
/// show the instability either: an undisturbed beam stays straight.
pub fn guards(case: &Case, auto: &EffectSet) -> error::Result<Option<RequiredEffects>> {
    let full = whole(case)?;
    let model = Model::new(&full)?;
    let why = EffectScene::new(&full, &model.section, model.wet.as_ref()).unstable();
    let guarded = auto
        .decisions
        .iter()
        .filter(|d| matches!(d.cause, DecisionCause::Unstable(_)));
    Ok(why.map(|why| RequiredEffects {
        effects: guarded.map(|d| d.effect).collect(),
        why,
    }))
}

/// Effects that must not be left out, and the reason.
#[derive(Clone, Debug, PartialEq)]
pub struct RequiredEffects {
    /// The effects.
    pub effects: Vec<Effect>,
    /// Reason, one clause.
    pub why: String,
}

/// Returns all effects with the way to leave each out.
pub fn candidates(case: &Case) -> error::Result<Vec<EffectCandidate>> {
    let (full, plain) = (effects(&whole(case)?)?, effects(&with(case, Effects::Full))?);
    let candidate = |effect: Effect| -> error::Result<EffectCandidate> {
        let there = full.has(effect);
        let kept = |why: String| Err(KeepReason { there, why });
        let out = if !there {
            kept(plain.decision(effect).cause.to_string())
        } else if !Effect::CHOSEN.contains(&effect) {
            kept("set by the case. Remove it from the case to leave it out".into())
        } else {
            leave_out(case, effect, &full)?.or_else(kept)
        };
        Ok(EffectCandidate { effect, out })
    };
    Effect::ALL.iter().copied().map(candidate).collect()
}

/// Leaves an effect out alone if possible, otherwise together with one other effect that neither compared model has.
fn leave_out(case: &Case, effect: Effect, full: &EffectSet) -> error::Result<Result<OmissionKind, String>> {
    let alone = effects(&without(case, &[effect])?)?;
    if alone.refusals.is_empty() {
        return Ok(Ok(OmissionKind {
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
            return Ok(Ok(OmissionKind {
                without: vec![other],
                takes: taken(&base, &both, effect),
            }));
        }
    }
    let refused = alone.decisions.iter().filter_map(|d| match &d.cause {
        DecisionCause::Refused(obstacle) => Some(obstacle.what.clone()),
        _ => None,
    });
    Ok(Err(refused.collect::<Vec<_>>().join("; ")))
}

/// Effects that are left out together with an effect.
fn taken(with: &EffectSet, without: &EffectSet, effect: Effect) -> Vec<Effect> {
    let gone = |other: &Effect| *other != effect && with.has(*other) && !without.has(*other);
    Effect::CHOSEN.iter().copied().filter(gone).collect()
}
