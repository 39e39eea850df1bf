//! Accuracy reached by a search.

use std::collections::BTreeMap;

use crate::case::Case;
use crate::case::schema::Effect;
use crate::error::Code;
use crate::run::rounding_scales::RoundingScales;
use crate::run::summary::{Accuracy, ErrorEstimate, PilotRun, Summary};
use crate::study::companion::error::{SMALL, relative, relative_by_cause};
use crate::study::companion::variant::ErrorCause;
use crate::study::effects::full_model::full;
use crate::study::refine;

/// Writes into the summary of the result what its errors are beside an accuracy.
pub fn conclude(
    case: &Case,
    asked: f64,
    floors: &RoundingScales,
    pilots: Vec<PilotRun>,
    added: &[Effect],
    cut_short: Option<String>,
    summary: &mut Summary,
) {
    let errors = relative(summary, &summary.errors, floors, SMALL);
    let known = !summary.errors.is_empty();
    let causes = relative_by_cause(summary, floors, SMALL);
    let part = |cause: ErrorCause, name: &str| causes.get(cause.pointer().as_str())?.get(name).copied();
    let estimate = |(name, total): (&String, &f64)| {
        let [beam, fluid, time] =
            [ErrorCause::BeamMesh, ErrorCause::FluidMesh, ErrorCause::TimeSteps].map(|cause| part(cause, name));
        let effects = causes.iter().filter(|(pointer, _)| ErrorCause::is_effect(pointer));
        let effects = effects
            .filter_map(|(_, errors)| errors.get(name))
            .copied()
            .reduce(|a, b| a + b);
        let estimate = ErrorEstimate {
            time,
            space: beam.zip(fluid).map(|(a, b)| a + b).or(beam),
            effects,
            total: Some(*total),
        };
        (name.clone(), estimate)
    };
    let quantities: BTreeMap<String, ErrorEstimate> = errors.iter().map(estimate).collect();
    let reached = known && errors.values().all(|error| *error <= asked);
    let accuracy = Accuracy {
        asked,
        reached,
        cells_per_segment: case.mesh.cells_per_segment,
        cells_per_bladder: case.mesh.cells_per_bladder,
        order: case.mesh.order(),
        rtol: case.solver.rtol,
        effects: effects_in_words(case, added),
        quantities,
        pilots,
    };
    if let Some(reason) = cut_short {
        let what = format!("accuracy: the search was cut short: {reason}");
        summary.warnings.push(Code::Accuracy.warning(what));
    }
    summary.warnings.extend(refine::warning(&accuracy));
    summary.accuracy = Some(accuracy);
}

/// Effects that were added, and those that are left out.
fn effects_in_words(case: &Case, added: &[Effect]) -> String {
    let left_out = full(case).ok().flatten().map_or(vec![], |full| full.left_out);
    let parts = [("added for what they change", added), ("left out", &left_out)];
    let parts = parts.into_iter().filter(|(_, effects)| !effects.is_empty());
    let parts: Vec<String> = parts
        .map(|(what, effects)| format!("{what}: {}", Effect::names(effects, ", ")))
        .collect();
    parts.join("; ")
}
