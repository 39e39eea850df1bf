//! Recommended choices of a case: leave out every effect that saves work and changes nothing, checked by a run without
//! all of them.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::ablation::{AblationRow, ComparedRun, Criteria, EffectVerdict};
use super::choices::{RequiredEffects, effects, with, without};
use super::trial::Runs;
use crate::case::Case;
use crate::case::schema::{Choice, Effect, EffectChoices, Effects};
use crate::discrete::System;
use crate::error::{Error, Result};
use crate::model::effects::EffectSet;

/// Recommended choices, and their check.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Recommendation {
    /// The value of `effects`.
    pub effects: Value,
    /// Effects left out, in the order of the table.
    pub off: Vec<Effect>,
    /// Effects that are retained after all, with the reasons.
    pub dropped: Vec<(Effect, String)>,
    /// The recommended model compared with the full one.
    pub run: Option<ComparedRun>,
}

/// Never leaves out effects that the program keeps for stability. Otherwise leaves out every effect that saves work,
/// and harmless effects that the program leaves out by itself. Then restores the effect with the largest change until
/// the rest together changes nothing.
pub fn recommend(
    case: &Case,
    rows: &[AblationRow],
    guard: Option<&RequiredEffects>,
    judge: &Criteria,
    runs: &mut Runs,
) -> Result<Recommendation> {
    let row = |name: Effect| rows.iter().find(|r| r.name == name);
    let guarded = |name: Effect| guard.is_some_and(|g| g.effects.contains(&name));
    let small = |name: &Effect| {
        !guarded(*name)
            && row(*name).is_some_and(|r| matches!(r.verdict, EffectVerdict::Saves | EffectVerdict::Harmless))
    };
    let mut off: Vec<Effect> = vec![];
    for r in rows
        .iter()
        .filter(|r| r.verdict == EffectVerdict::Saves && r.without.iter().all(small))
    {
        off.extend(r.without.iter().chain([&r.name]));
    }
    // Harmless effects follow the choice of the program.
    off.extend(
        rows.iter()
            .filter(|r| r.verdict == EffectVerdict::Harmless && !r.auto && r.without.is_empty())
            .map(|r| r.name),
    );
    let mut dropped = vec![];
    for name in off.iter().copied().filter(|name| guarded(*name)) {
        let why = guard.map(|g| g.why.clone()).unwrap_or_default();
        dropped.push((name, format!("{why}. A run without disturbance does not show this")));
    }
    off.retain(|name| !guarded(*name));
    loop {
        off = Effect::CHOSEN
            .iter()
            .copied()
            .filter(|effect| off.contains(effect))
            .collect();
        let wanted = without(case, &off)?;
        let (out, why) = if let Err(Error::Case(fault)) = System::new(&wanted)
            && let Some(refusal) = fault.violations.into_iter().next().filter(|_| !off.is_empty())
        {
            let named = off
                .iter()
                .copied()
                .find(|name| refusal.pointer == format!("/effects/{name}"));
            (named.or(off.last().copied()), refusal.what)
        } else {
            let effects = naming(case, &effects(&wanted)?)?;
            let number = runs.run("recommended", with(case, Effects::Chosen(effects.clone())))?;
            runs.repeat();
            let run = judge.compare(runs, 0, number);
            let verdict = run.as_ref().map(|run| judge.verdict(run, 0.0));
            if off.is_empty() || matches!(verdict, Some(EffectVerdict::Saves | EffectVerdict::Harmless)) {
                return Ok(Recommendation {
                    effects: value(&effects),
                    off,
                    dropped,
                    run,
                });
            }
            let change = |name: Effect| {
                row(name)
                    .and_then(|r| r.left_out.as_ref()?.largest.as_ref())
                    .map_or(0.0, |l| l.1)
            };
            let most = off.iter().copied().max_by(|a, b| change(*a).total_cmp(&change(*b)));
            let why = match run.and_then(|run| run.largest) {
                Some((quantity, change)) => format!("together they change {quantity} by {change:.1e}"),
                None => "a run without all of them does not finish".into(),
            };
            (most, why)
        };
        // Effects that require the restored one to be left out are restored, too.
        let Some(out) = out else { continue };
        let bound = |name: Effect| row(name).is_some_and(|r| r.without.contains(&out));
        off.retain(|name| *name != out && !bound(*name));
        dropped.push((out, why));
    }
}

/// Returns the fewest choices by name with which the program selects these effects.
fn naming(case: &Case, wanted: &EffectSet) -> Result<EffectChoices> {
    let mut named = EffectChoices::default();
    loop {
        let chosen = effects(&with(case, Effects::Chosen(named.clone())))?;
        let differs = |e: &&Effect| chosen.has(**e) != wanted.has(**e) && named.choice(**e) == Choice::Auto;
        let Some(&effect) = Effect::CHOSEN.iter().find(differs) else {
            return Ok(named);
        };
        let choice = if wanted.has(effect) { Choice::On } else { Choice::Off };
        named.set(effect, choice);
    }
}

/// Value of `effects` in a case.
fn value(choices: &EffectChoices) -> Value {
    if *choices == EffectChoices::default() {
        return "auto".into();
    }
    let named = Effect::CHOSEN.iter().filter(|e| choices.choice(**e) != Choice::Auto);
    Value::Object(named.map(|e| (e.to_string(), json!(choices.choice(*e)))).collect())
}
