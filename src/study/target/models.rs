//! Which effects a case leaves out by itself, and the cases that have more of them.

use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::model::effects::EffectSet;
use crate::study::accuracy::plan;
use crate::study::effects::choices::{effects, with};

/// Decades by which the tolerance of effects is tightened, each a candidate.
const TIGHTER: i32 = 3;

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

/// The case on meshes of fourth order, where it can be computed so with everything that it leaves to the program.
pub fn of_best_order(case: Case) -> Result<Case> {
    let fourth = plan::of_best_order(&case);
    let left_out = |case: &Case| Ok(full(case)?.map(|full| full.left_out));
    Ok(if fourth == case || left_out(&fourth)? == left_out(&case)? {
        fourth
    } else {
        case
    })
}

/// The case with tighter tolerances of effects, as far as that makes a difference to it and to the full one.
pub fn tighter(case: &Case, full: &Full) -> Result<Vec<Case>> {
    let all = effects(&full.case)?;
    let mut before = effects(case)?;
    let tolerance = case.effects_tolerance();
    let mut found = vec![];
    for decades in 1..=TIGHTER {
        let mut candidate = case.clone();
        candidate.effects_tolerance = Some(tolerance * 10_f64.powi(-decades));
        let set = effects(&candidate)?;
        let new = !more(&before, &set).is_empty();
        if new && !more(&set, &all).is_empty() && System::new(&candidate).is_ok() {
            found.push(candidate);
            before = set;
        }
    }
    Ok(found)
}

/// Effects of one set that another has not.
pub fn more(few: &EffectSet, many: &EffectSet) -> Vec<Effect> {
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
