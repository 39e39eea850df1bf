//! What the case should leave out: everything that saves and changes nothing, checked by a run of all of it together.

use serde::Serialize;
use serde_json::{Map, Value};

use super::ablation::{Compared, Judge, Row, Verdict};
use super::choices::{Guard, choosable, effects, on, refusals, with_choices, without};
use super::trial::Runs;
use crate::case::Case;
use crate::case::schema::Choice;
use crate::model::effects::EffectSet;

/// What a case should say, and how that was checked.
#[derive(Clone, Debug, Serialize)]
pub struct Recommendation {
    /// The value of `effects`.
    pub effects: Value,
    /// What is left out, in the order of the table.
    pub off: Vec<&'static str>,
    /// What was not left out after all, and why.
    pub dropped: Vec<(&'static str, String)>,
    /// The model so chosen, beside the full one.
    pub run: Option<Compared>,
}

/// Never leaves out what the program keeps for the sake of stability. Else leaves out everything that saves, and what is harmless where the program leaves it out by itself, then takes back what changes most until the rest together changes nothing.
pub fn recommend(case: &Case, rows: &[Row], guard: Option<&Guard>, judge: &Judge, runs: &mut Runs) -> Recommendation {
    let row = |name: &str| rows.iter().find(|r| r.name == name);
    let guarded = |name: &str| guard.is_some_and(|g| g.effects.contains(&name));
    let small = |name: &&str| {
        !guarded(name) && row(name).is_some_and(|r| matches!(r.verdict, Verdict::Saves | Verdict::Harmless))
    };
    let mut off: Vec<&'static str> = vec![];
    for r in rows
        .iter()
        .filter(|r| r.verdict == Verdict::Saves && r.without.iter().all(small))
    {
        off.extend(r.without.iter().chain([&r.name]));
    }
    // What makes no difference is left to the program.
    off.extend(
        rows.iter()
            .filter(|r| r.verdict == Verdict::Harmless && !r.auto && r.without.is_empty())
            .map(|r| r.name),
    );
    let mut dropped = vec![];
    for name in off.iter().copied().filter(|name| guarded(name)) {
        let why = guard.map(|g| g.why.clone()).unwrap_or_default();
        dropped.push((name, format!("{why}, which a run without disturbance does not show")));
    }
    off.retain(|name| !guarded(name));
    loop {
        off = choosable().into_iter().filter(|name| off.contains(name)).collect();
        let wanted = without(case, &off);
        let refusals = refusals(&wanted);
        let (out, why) = if let Some(refusal) = refusals.first().filter(|_| !off.is_empty()) {
            let named = off
                .iter()
                .copied()
                .find(|name| refusal.pointer == format!("/effects/{name}"));
            (named.or(off.last().copied()), refusal.what.clone())
        } else {
            let effects = naming(case, &effects(&wanted));
            let number = runs.run("recommended", with_choices(case, &effects));
            runs.repeat();
            let run = judge.compare(runs, 0, number);
            let verdict = run.as_ref().map(|run| judge.verdict(run, 0.0));
            if off.is_empty() || matches!(verdict, Some(Verdict::Saves | Verdict::Harmless)) {
                return Recommendation {
                    effects: value(&effects),
                    off,
                    dropped,
                    run,
                };
            }
            let change = |name: &str| {
                row(name)
                    .and_then(|r| r.left_out.as_ref()?.largest.as_ref())
                    .map_or(0.0, |l| l.1)
            };
            let most = off.iter().copied().max_by(|a, b| change(a).total_cmp(&change(b)));
            let why = match run.and_then(|run| run.largest) {
                Some((quantity, change)) => format!("all together change {quantity} by {change:.1e}"),
                None => "the model without all of them does not run to the end".into(),
            };
            (most, why)
        };
        // What needs it out stays with it.
        let Some(out) = out else { continue };
        let bound = |name: &str| row(name).is_some_and(|r| r.without.contains(&out));
        off.retain(|name| *name != out && !bound(name));
        dropped.push((out, why));
    }
}

/// The fewest choices by name that make the program choose these effects.
fn naming(case: &Case, wanted: &EffectSet) -> Vec<(&'static str, Choice)> {
    let mut named: Vec<(&'static str, Choice)> = vec![];
    let choosable = choosable();
    loop {
        let chosen = effects(&with_choices(case, &named));
        let differs = |name: &&&str| on(&chosen, name) != on(wanted, name) && named.iter().all(|n| n.0 != **name);
        let Some(&name) = choosable.iter().find(differs) else {
            return named;
        };
        let choice = if on(wanted, name) { Choice::On } else { Choice::Off };
        named.push((name, choice));
    }
}

/// As a case says it.
fn value(choices: &[(&'static str, Choice)]) -> Value {
    if choices.is_empty() {
        return "auto".into();
    }
    let mut sorted = choices.to_vec();
    sorted.sort_by_key(|(name, _)| choosable().iter().position(|c| c == name));
    let named = sorted
        .iter()
        .map(|(name, choice)| (name.to_string(), serde_json::to_value(choice).unwrap_or_default()));
    Value::Object(named.collect::<Map<_, _>>())
}
