//! Which effects a case leaves out by itself, and the cases that have more of them.

use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::model::effects::EffectSet;
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

/// The case with everything that it leaves to the program. What it names off stays off; motion across stays out where nothing
/// makes the beam leave its line, which is exact. `None` where nothing is then left out.
pub fn full(case: &Case) -> Result<Option<Full>> {
    let auto = effects(case)?;
    let mut choices = named(case, &auto);
    let open: Vec<Effect> = Effect::CHOSEN
        .iter()
        .copied()
        .filter(|effect| choices.of(*effect) == Choice::Auto && !straight(&auto, *effect))
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
        let there = case.effects == Effects::Full || auto.has(effect);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn case(more: &str) -> Case {
        let text = format!(
            r#"{{"name": "x", "beam": {{"length_m": 1, "height_m": 0.01, "width_m": 0.01, "young_modulus_pa": 1e8,
            "density_kg_m3": 1000}}, "ends": {{"root": "clamped", "tip": {{"free": {{"force_x_n":
            {{"ramp": {{"to": 1e-4, "duration_s": 100}}}}}}}}}}, "time": {{"end_s": 100}}{more}}}"#
        );
        let path = std::path::Path::new("x.json");
        match crate::case::parse(&text, path, path, &[]) {
            Ok(case) => case,
            Err(error) => panic!("{error}"),
        }
    }

    /// Goal: a slow, small motion leaves out inertia and finite rotations, and the full case has both; what the case names off
    /// stays off; of a full case nothing is left out.
    #[test]
    fn the_full_case_has_what_was_left_to_the_program() {
        let full = |case: &Case| full(case).expect("effects");
        let found = full(&case("")).expect("something left out");
        assert!(found.left_out.contains(&Effect::SolidInertia), "{:?}", found.left_out);
        assert!(found.left_out.contains(&Effect::FiniteRotation), "{:?}", found.left_out);
        assert!(System::new(&found.case).is_ok());
        assert!(full(&found.case).is_none());
        let off = full(&case(r#", "effects": {"solid_inertia": "off"}"#)).expect("something left out");
        assert!(!off.left_out.contains(&Effect::SolidInertia), "{:?}", off.left_out);
        assert!(full(&case(r#", "effects": "full""#)).is_none());
        for tighter in tighter(&case(""), &found).expect("effects") {
            let effects = |case: &Case| effects(case).expect("effects");
            assert!(!more(&effects(&case("")), &effects(&tighter)).is_empty());
        }
    }
}
