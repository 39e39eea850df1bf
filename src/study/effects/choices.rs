//! Which effects can be left out of a case, and which others that takes.

use serde_json::{Map, Value};

use crate::case::Case;
use crate::case::schema::{Choice, EffectChoices, Effects};
use crate::error::Violation;
use crate::model::effects::{Decision, EffectSet, Scene, TABLE};
use crate::model::{Model, audit};

/// An effect of the table, and what leaving it out takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Its name.
    pub name: &'static str,
    /// How it is left out, or why it is not.
    pub out: Result<Out, Kept>,
}

/// How an effect is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Out {
    /// Effects that must be left out first; what is compared is with and without it, both without these.
    pub without: Vec<&'static str>,
    /// Effects that have no meaning without it.
    pub takes: Vec<&'static str>,
}

/// Why an effect is not left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// Whether it is in the full model at all.
    pub there: bool,
    /// Why, one clause.
    pub why: String,
}

/// Names that a case can choose by.
pub fn choosable() -> Vec<&'static str> {
    let fields = serde_json::to_value(EffectChoices::default()).unwrap_or_default();
    TABLE
        .iter()
        .map(|e| e.name)
        .filter(|name| fields.get(name).is_some())
        .collect()
}

/// The case with choices by name; others are automatic.
pub fn with_choices(case: &Case, choices: &[(&'static str, Choice)]) -> Case {
    let named = choices
        .iter()
        .filter_map(|(name, choice)| Some((name.to_string(), serde_json::to_value(choice).ok()?)));
    let named = Value::Object(named.collect::<Map<_, _>>());
    with(case, Effects::Chosen(serde_json::from_value(named).unwrap_or_default()))
}

/// The case with other effects.
pub fn with(case: &Case, effects: Effects) -> Case {
    Case {
        effects,
        ..case.clone()
    }
}

/// The full model without some effects.
pub fn without(case: &Case, off: &[&'static str]) -> Case {
    let choice = |name| if off.contains(&name) { Choice::Off } else { Choice::On };
    let named: Vec<_> = choosable().into_iter().map(|name| (name, choice(name))).collect();
    with_choices(case, &named)
}

/// The effects of a case's model.
pub fn effects(case: &Case) -> EffectSet {
    Model::new(case).effects
}

/// Why a case has no model, if it has none.
pub fn refusals(case: &Case) -> Vec<Violation> {
    let model = Model::new(case);
    let mut all = model.effects.refusals.clone();
    all.extend(audit::refusals(case, &model));
    all
}

/// Whether an effect is simulated.
pub fn on(effects: &EffectSet, name: &str) -> bool {
    effects.decisions.iter().any(|d| d.name == name && d.on)
}

/// Whether the program keeps an effect, whatever its number, since without it an instability might not show. A run need not
/// show it either: what is not disturbed stays straight.
pub fn guards(case: &Case, auto: &EffectSet) -> Option<Guard> {
    let full = with(case, Effects::Full);
    let model = Model::new(&full);
    let why = Scene::new(&full, &model.section, model.wet.as_ref()).unstable()?;
    let kept = |d: &&Decision| d.on && d.reason == format!("kept: {why}");
    let effects = auto.decisions.iter().filter(kept).map(|d| d.name).collect();
    Some(Guard { effects, why })
}

/// What must not be left out, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Guard {
    /// Names of effects.
    pub effects: Vec<&'static str>,
    /// One clause.
    pub why: String,
}

/// Why an effect is simulated or not.
pub fn reason(effects: &EffectSet, name: &str) -> String {
    let decision = effects.decisions.iter().find(|d| d.name == name);
    decision.map(|d| d.reason.clone()).unwrap_or_default()
}

/// Every effect of the table.
pub fn candidates(case: &Case) -> Vec<Candidate> {
    let full = effects(&with(case, Effects::Full));
    let choosable = choosable();
    let candidate = |name: &'static str| {
        let there = on(&full, name);
        let kept = |why: String| Err(Kept { there, why });
        let out = if !there {
            kept(reason(&full, name))
        } else if !choosable.contains(&name) {
            kept("given by the case, and left out by not giving it".into())
        } else {
            leave_out(case, name, &choosable, &full).map_err(|why| Kept { there, why })
        };
        Candidate { name, out }
    };
    TABLE.iter().map(|e| candidate(e.name)).collect()
}

/// Alone where that is possible, else together with one other without which it can be compared.
fn leave_out(case: &Case, name: &'static str, choosable: &[&'static str], full: &EffectSet) -> Result<Out, String> {
    let alone = effects(&without(case, &[name]));
    if alone.refusals.is_empty() {
        return Ok(Out {
            without: vec![],
            takes: taken(full, &alone, name, choosable),
        });
    }
    for &other in choosable.iter().filter(|other| **other != name && on(full, other)) {
        let base = effects(&without(case, &[other]));
        let both = effects(&without(case, &[other, name]));
        if base.refusals.is_empty() && on(&base, name) && both.refusals.is_empty() && !on(&both, name) {
            return Ok(Out {
                without: vec![other],
                takes: taken(&base, &both, name, choosable),
            });
        }
    }
    let prefix = format!("{name} cannot be left out: ");
    let why = |what: &str| what.strip_prefix(&prefix).unwrap_or(what).to_string();
    Err(alone
        .refusals
        .iter()
        .map(|r| why(&r.what))
        .collect::<Vec<_>>()
        .join("; "))
}

/// What goes with an effect.
fn taken(with: &EffectSet, without: &EffectSet, name: &str, choosable: &[&'static str]) -> Vec<&'static str> {
    let gone = |other: &&str| *other != name && on(with, other) && !on(without, other);
    choosable.iter().copied().filter(gone).collect()
}
