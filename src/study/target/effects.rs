//! Effects that a run leaves out and that its companion shows to matter.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::schema::{Choice, Effect, Effects};
use crate::discrete::System;
use crate::error::Result;
use crate::error::numbers::error_percent;
use crate::run::dynamics::Outcome;
use crate::run::record::Recorder;
use crate::run::rounding_scales::RoundingScales;
use crate::run::summary::{EarlierRun, Status, Summary};
use crate::study::companion;
use crate::study::companion::error::{figures, relative_by_cause};
use crate::study::companion::variant::ErrorCause;
use crate::study::effects::choices::with;
use crate::study::effects::full_model::full;

/// Most repeated runs.
const REPEATS: usize = 2;

/// A case with more effects.
pub struct CaseWithEffects {
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
    let mut run = |case: &Case, annotate: Annotate| {
        let mut outcome = companion::run(case, System::new(case)?, &[], recorder)?;
        annotate(&mut outcome.summary);
        Ok(outcome)
    };
    let first = run(case, &|_| ())?;
    settle(case, first, &mut run)
}

/// Adds to the summary of a repeated run what the runs before have shown.
pub type Annotate<'a> = &'a dyn Fn(&mut Summary);

/// Repeats a run that had a companion with the effects whose errors exceed `effects_tolerance`, at most twice. `record` runs a case into a
/// result, over an earlier one only when it finishes, and annotates its summary before it writes it.
///
/// # Errors
/// Those of `record`.
pub fn settle(
    case: &Case,
    run: Outcome,
    record: &mut dyn FnMut(&Case, Annotate) -> Result<Outcome>,
) -> Result<Outcome> {
    let (mut case, mut outcome) = (case.clone(), run);
    for _ in 0..REPEATS {
        let Some(needed) = needed(&case, &outcome.summary, [case.effects_tolerance(), 0.0])? else {
            break;
        };
        let again = record(&needed.case, &|summary| {
            add_earlier_runs(summary, &needed, &outcome.summary)
        })?;
        if again.summary.status != Status::Finished {
            break;
        }
        (case, outcome) = (needed.case, again);
    }
    Ok(outcome)
}

/// The case with the effects whose errors are above a limit, as far as they are measured; `small` is that of [`relative_by_cause`].
///
/// # Errors
/// As [`System::new`].
pub fn needed(case: &Case, summary: &Summary, [limit, small]: [f64; 2]) -> Result<Option<CaseWithEffects>> {
    let mut causes = summary.companion.iter().flat_map(|companion| companion.causes.keys());
    if !causes.any(|pointer| ErrorCause::is_effect(pointer)) {
        return Ok(None);
    }
    let errors = relative_by_cause(summary, &RoundingScales::from_case(case)?, small);
    let Some(full) = full(case)? else {
        return Ok(None);
    };
    let most = |cause: ErrorCause| {
        let errors = errors.get(cause.pointer().as_str())?.iter();
        let worst = errors
            .max_by(|a, b| a.1.total_cmp(b.1))
            .filter(|(_, error)| **error > limit)?;
        Some((worst.0.clone(), *worst.1))
    };
    let all = |worst: &(String, f64)| full.left_out.iter().map(|effect| (*effect, worst.clone())).collect();
    if let Some(worst) = most(ErrorCause::Effects) {
        let added = all(&worst);
        return Ok(Some(CaseWithEffects { case: full.case, added }));
    }
    let each = full
        .left_out
        .iter()
        .filter_map(|effect| Some((*effect, most(ErrorCause::Effect(*effect))?)));
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
        true => CaseWithEffects { case: some, added },
        false => {
            let added = all(worst);
            CaseWithEffects { case: full.case, added }
        }
    }))
}

/// Adds to the summary of a repeated run the runs before, and the reasons of effects that were turned on.
fn add_earlier_runs(summary: &mut Summary, needed: &CaseWithEffects, before: &Summary) {
    for (effect, (quantity, error)) in &needed.added {
        if let Some(chosen) = summary.effects.get_mut(&effect.to_string()) {
            chosen.reason = format!("measured: without it {quantity} changes by {}", error_percent(*error));
        }
    }
    let mut earlier = before
        .companion
        .as_ref()
        .map_or(vec![], |companion| companion.earlier_runs.clone());
    for name in earlier.iter().flat_map(|run| &run.added_effects) {
        if let Some(chosen) = before.effects.get(name) {
            summary.effects.insert(name.clone(), chosen.clone());
        }
    }
    earlier.push(EarlierRun {
        added_effects: needed.added.keys().map(Effect::to_string).collect(),
        unknowns: before.unknowns,
        steps: before.solver.steps,
        wall_s: before.wall_s.total,
        figures: figures(before),
    });
    summary.wall_s.pilots += before.wall_s.total;
    if let Some(companion) = &mut summary.companion {
        companion.earlier_runs = earlier;
    }
}
