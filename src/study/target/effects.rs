//! Effects that a run leaves out and that its companion shows to matter.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::schema::{Choice, Effect, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::run::dynamics::Outcome;
use crate::run::floors::Floors;
use crate::run::record::Recorder;
use crate::run::summary::{EarlierRun, Status, Summary};
use crate::study::companion;
use crate::study::companion::error::{figures, relative};
use crate::study::companion::variant::Cause;
use crate::study::effects::choices::with;
use crate::study::effects::full::full;

/// Most repeated runs.
const REPEATS: usize = 2;

/// A case with more effects.
pub struct Needed {
    /// The case.
    pub case: Case,
    /// Effects that it has more, each with the quantity that it changes most, and by how much.
    pub added: BTreeMap<Effect, (String, f64)>,
}

/// Runs a case with its companion, and again with effects that matter; the recorder sees one run after the other.
///
/// # Errors
/// As [`companion::run`].
pub fn run(case: &Case, recorder: &mut dyn Recorder) -> Result<Outcome> {
    let mut run = |case: &Case, tell: Tell| {
        let mut outcome = companion::run(case, System::new(case)?, &[], recorder)?;
        tell(&mut outcome.summary);
        Ok(outcome)
    };
    let first = run(case, &|_| ())?;
    settle(case, first, &mut run)
}

/// Writes into the summary of a repeated run what is known of the runs before.
pub type Tell<'a> = &'a dyn Fn(&mut Summary);

/// Repeats a run that had a companion with the effects whose errors exceed `effects_tolerance`, at most twice. `record` runs a case into a
/// result, over an earlier one only when it finishes, and lets its summary be told before that is written.
///
/// # Errors
/// Those of `record`.
pub fn settle(case: &Case, run: Outcome, record: &mut dyn FnMut(&Case, Tell) -> Result<Outcome>) -> Result<Outcome> {
    let (mut case, mut outcome) = (case.clone(), run);
    for _ in 0..REPEATS {
        let floors = Floors::of(&case)?;
        let Some(needed) = needed(&case, &outcome.summary, &floors, case.effects_tolerance())? else {
            break;
        };
        let again = record(&needed.case, &|summary| tell(summary, &needed, &outcome.summary))?;
        if again.summary.status != Status::Finished {
            break;
        }
        (case, outcome) = (needed.case, again);
    }
    Ok(outcome)
}

/// The case with the effects whose errors are above a limit, as far as they are measured.
///
/// # Errors
/// As [`System::new`].
pub fn needed(case: &Case, summary: &Summary, floors: &Floors, limit: f64) -> Result<Option<Needed>> {
    let causes = summary.companion.iter().flat_map(|companion| &companion.causes);
    let by_effects = causes.filter(|(pointer, _)| pointer.starts_with(&Cause::Effects.pointer()));
    let errors: BTreeMap<&String, BTreeMap<String, f64>> = by_effects
        .map(|(pointer, errors)| (pointer, relative(summary, errors, floors)))
        .collect();
    let Some(full) = full(case)?.filter(|_| !errors.is_empty()) else {
        return Ok(None);
    };
    let most = |cause: Cause| {
        let errors = errors.get(&cause.pointer())?.iter();
        let worst = errors
            .max_by(|a, b| a.1.total_cmp(b.1))
            .filter(|(_, error)| **error > limit)?;
        Some((worst.0.clone(), *worst.1))
    };
    let all = |worst: &(String, f64)| full.left_out.iter().map(|effect| (*effect, worst.clone())).collect();
    if let Some(worst) = most(Cause::Effects) {
        let added = all(&worst);
        return Ok(Some(Needed { case: full.case, added }));
    }
    let each = full
        .left_out
        .iter()
        .filter_map(|effect| Some((*effect, most(Cause::Effect(*effect))?)));
    let added: BTreeMap<Effect, (String, f64)> = each.collect();
    let Some(worst) = added.values().max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(None);
    };
    let mut choices = case.effects.choices();
    added.keys().for_each(|effect| choices.set(*effect, Choice::On));
    let some = with(case, Effects::Chosen(choices));
    // one may have no meaning without another
    let has_all = |system: System| added.keys().all(|effect| system.model.effects.has(*effect));
    Ok(Some(match System::new(&some).is_ok_and(has_all) {
        true => Needed { case: some, added },
        false => {
            let added = all(worst);
            Needed { case: full.case, added }
        }
    }))
}

/// Tells in the summary of a repeated run of the run before, and why effects were added.
fn tell(summary: &mut Summary, needed: &Needed, before: &Summary) {
    for (effect, (quantity, error)) in &needed.added {
        if let Some(chosen) = summary.effects.get_mut(&effect.to_string()) {
            chosen.reason = format!("measured: without it {quantity} changes by {}", error_percent(*error));
        }
    }
    let mut earlier = before
        .companion
        .as_ref()
        .map_or(vec![], |companion| companion.earlier_runs.clone());
    earlier.push(EarlierRun {
        added_effects: needed.added.keys().map(Effect::to_string).collect(),
        unknowns: before.unknowns,
        steps: before.solver.steps,
        wall_s: before.wall_s.total,
        figures: figures(before),
    });
    for run in &earlier {
        let again = run
            .added_effects
            .iter()
            .filter_map(|name| Some((name, before.effects.get(name)?)));
        for (name, chosen) in again.filter(|(_, chosen)| chosen.reason.starts_with("measured")) {
            summary.effects.insert(name.clone(), chosen.clone());
        }
    }
    summary.wall_s.pilots += before.wall_s.total;
    if let Some(companion) = &mut summary.companion {
        companion.earlier_runs = earlier;
    }
}
