//! Which setting makes an error that is large, and the warning.
//!
//! Each setting is changed by itself: twice the cells of the beam, the cells of a bladder in the companion, a tenth of the tolerance, each
//! effect that is left out. These runs are made only where an error is above the limit and the run is small. Changes may cancel in the
//! companion, and its looser tolerance may err more than the run: an error is at least the sum over all causes, and at most
//! [`TRUSTED`] times that. Two coarse meshes may agree by accident, so that the beam is refined here.

use std::collections::BTreeMap;

use super::changes::{ChangesStatus, changes};
use super::variant::{ErrorCause, has_few_cells};
use super::{Accurate, companion_steps, error, work};
use crate::case::Case;
use crate::error::numbers::error_percent as percent;
use crate::error::{Code, Result};
use crate::run::record::Recorder;
use crate::run::summary::{Figures, Status, Summary, has_unit_of_quantity, largest_error};
use crate::study::effects::full_model::full;
use crate::study::significant::RoundingScales;

/// Relative error that is large.
pub const LIMIT: f64 = 0.05;
/// Error bar from which on a quantity may have a large error: bars may be too small by half.
const NAMED_FROM: f64 = 0.5 * LIMIT;
/// Largest work (steps times unknowns) of a run whose errors are attributed.
const LARGEST_WORK: u64 = 5_000_000;
/// Largest error of a companion beside the sum over all causes.
const TRUSTED: f64 = 2.0;
/// Expected errors over an accuracy between which their causes are measured again.
const CLOSE: [f64; 2] = [0.3, 3.0];
/// Part of an accuracy below which a companion alone shows that it is reached.
const SURE: f64 = 0.5;
/// Most steps of a companion over those of the run where the tolerance decides on them.
const BINDING: f64 = 0.65;
/// Smallest share of an error at which a cause is named.
const NAMED: f64 = 0.1;
/// Largest refinement of a mesh and of the tolerance that is proposed at once, and the tightest tolerance.
const FINER: usize = 8;
const DECADES: f64 = 2.0;
const TIGHTEST: f64 = 1e-12;

/// Warning of figures without errors.
pub fn unknown(status: Status, reason: &str) -> Option<String> {
    (status == Status::Finished)
        .then(|| Code::ErrorEstimate.warning(format!("errors of figures are not known: {reason}. Use --accuracy.")))
}

/// Errors of all figures by their causes, as far as they are measured.
enum Causes {
    /// All that apply.
    Complete(BTreeMap<ErrorCause, Figures>),
    /// Some, since a run did not reach its end.
    Partial(BTreeMap<ErrorCause, Figures>),
    Interrupted,
    TooLarge,
}

impl Causes {
    fn known(&self) -> Option<&BTreeMap<ErrorCause, Figures>> {
        match self {
            Self::Complete(causes) | Self::Partial(causes) => Some(causes),
            Self::Interrupted | Self::TooLarge => None,
        }
    }
}

/// Adds to a summary the causes of errors that are larger than an accuracy; or, without one, of those above the limit, with a warning.
///
/// Errors of energies are at least the residual of a balance: that of the run where an accuracy is asked for, otherwise that of the
/// companion, whose looser tolerance may hide an error of the mesh.
pub(super) fn attribute(
    case: &Case,
    summary: &mut Summary,
    of: &Summary,
    accuracy: Option<&Accurate>,
    recorder: &mut dyn Recorder,
) -> Result<()> {
    let floors = &RoundingScales::from_case(case)?;
    let limit = [least(accuracy), small(accuracy)];
    let mut cells = summary.companion.as_ref().map_or([0; 2], |companion| {
        [companion.cells_per_segment, companion.cells_per_bladder]
    });
    if accuracy.is_none() {
        cells[0] = cells[0].max(2 * case.mesh.cells_per_segment);
    }
    let mut errors = std::mem::take(&mut summary.errors);
    error::raise_to_balance(if accuracy.is_some() { summary } else { of }, &mut errors, floors);
    summary.errors = errors;
    let mut found = accuracy.map_or_else(BTreeMap::new, |accuracy| believed(accuracy, summary, floors));
    if accuracy.is_some() && !tolerance_binds(summary) && !found.contains_key(&ErrorCause::TimeSteps) {
        changes(case, summary, cells, vec![ErrorCause::TimeSteps], &mut found, recorder)?;
        let of_companion = std::mem::take(&mut summary.errors);
        summary.errors = added(&of_companion, &found, f64::INFINITY);
    }
    let mut causes = None;
    if !large(summary, floors, limit).is_empty() {
        let measured = match accuracy.is_some() || work(summary) <= LARGEST_WORK {
            true => measure(case, summary, floors, cells, accuracy, found, recorder)?,
            false => Causes::TooLarge,
        };
        if let Some(known) = measured.known() {
            let most = if matches!(measured, Causes::Complete(_)) {
                TRUSTED
            } else {
                f64::INFINITY
            };
            let of_companion = std::mem::take(&mut summary.errors);
            summary.errors = added(&of_companion, known, most);
        }
        causes = Some(measured);
    }
    if let Some(accuracy) = accuracy
        && has_few_cells(case)
        && large(summary, floors, [accuracy.asked, error::SMALL]).is_empty()
    {
        let finer = [2 * case.mesh.cells_per_segment, cells[1]];
        let mut by_mesh = BTreeMap::new();
        changes(case, summary, finer, vec![ErrorCause::BeamMesh], &mut by_mesh, recorder)?;
        let of_companion = std::mem::take(&mut summary.errors);
        summary.errors = added(&of_companion, &by_mesh, f64::INFINITY);
        causes = match causes {
            Some(Causes::Complete(known)) => Some(Causes::Complete(known.into_iter().chain(by_mesh).collect())),
            None => Some(Causes::Partial(by_mesh)),
            other => other,
        };
    }
    let Some(causes) = causes else { return Ok(()) };
    let large = large(summary, floors, limit);
    if accuracy.is_none() && !large.is_empty() {
        let warning = describe(case, summary, &large, &causes, &shares(summary, causes.known()));
        summary.warnings.insert(0, warning);
    }
    if let (Some(companion), Some(known)) = (&mut summary.companion, causes.known()) {
        let by_pointer = known.iter().map(|(cause, errors)| (cause.pointer(), errors.clone()));
        companion.causes = by_pointer.collect();
    }
    Ok(())
}

/// Error from which on causes are measured.
fn least(accuracy: Option<&Accurate>) -> f64 {
    accuracy.map_or(NAMED_FROM, |accuracy| SURE * accuracy.asked)
}

/// Part of the largest figure with its unit that the size of a quantity is at least.
fn small(accuracy: Option<&Accurate>) -> f64 {
    accuracy.map_or(0.0, |_| error::SMALL)
}

/// Expected errors by cause that the companion does not contradict and that need not be known better.
fn believed(accuracy: &Accurate, summary: &Summary, floors: &RoundingScales) -> BTreeMap<ErrorCause, Figures> {
    let (asked, mut expected) = (accuracy.asked, accuracy.expected.clone());
    let with = |part: f64| {
        let mut errors = summary.errors.clone();
        let values = errors.values_mut().flat_map(BTreeMap::values_mut);
        values.for_each(|error| *error *= part);
        error::relative(
            summary,
            &added(&errors, &accuracy.expected, f64::INFINITY),
            floors,
            error::SMALL,
        )
    };
    let sums = with(0.0);
    let sum = |name: &String| sums.get(name).copied().unwrap_or(0.0);
    if with(1.0 / TRUSTED)
        .iter()
        .any(|(name, error)| *error > asked.max(sum(name)))
    {
        return BTreeMap::new();
    }
    // orders of refinements are expected to be low
    expected.retain(|_, errors| {
        let own = error::relative(summary, errors, floors, error::SMALL);
        let close = |name: &String| (CLOSE[0] * asked..=CLOSE[1] * asked).contains(&sum(name));
        own.iter().all(|(name, error)| *error <= NAMED * asked || !close(name))
    });
    expected
}

/// True if a looser tolerance makes the companion take larger steps, so that its figures show the effect of the steps of the run.
fn tolerance_binds(summary: &Summary) -> bool {
    companion_steps(summary) <= BINDING * summary.solver.steps as f64
}

/// Quantities whose error is above a limit, the largest first.
fn large(summary: &Summary, floors: &RoundingScales, [least, small]: [f64; 2]) -> Vec<(String, f64)> {
    let mut large: Vec<(String, f64)> = error::relative(summary, &summary.errors, floors, small)
        .into_iter()
        .collect();
    large.retain(|(_, error)| *error > least);
    large.sort_by(|a, b| b.1.total_cmp(&a.1));
    large
}

/// Errors of the companion, bounded by the sums over causes, and by so many times these.
fn added(of_companion: &Figures, causes: &BTreeMap<ErrorCause, Figures>, most: f64) -> Figures {
    let sum = |name: &String, figure: &String, error: f64| {
        let parts = causes.values().filter_map(|errors| errors.get(name)?.get(figure));
        let sum: f64 = parts.sum();
        sum.max(error.min(most * sum))
    };
    let of = |(name, errors): (&String, &BTreeMap<String, f64>)| {
        let all = errors.iter().map(|(figure, e)| (figure.clone(), sum(name, figure, *e)));
        (name.clone(), all.collect())
    };
    of_companion.iter().map(of).collect()
}

/// Errors of all figures by each cause that is not found already. All effects that are left out are one cause where they make no large
/// error together.
fn measure(
    case: &Case,
    summary: &Summary,
    floors: &RoundingScales,
    cells: [usize; 2],
    accuracy: Option<&Accurate>,
    mut found: BTreeMap<ErrorCause, Figures>,
    recorder: &mut dyn Recorder,
) -> Result<Causes> {
    let effects = full(case)?.map_or(vec![], |full| full.left_out);
    let mut first = vec![ErrorCause::BeamMesh, ErrorCause::FluidMesh, ErrorCause::TimeSteps];
    first.extend(match effects.as_slice() {
        [] => None,
        [one] => Some(ErrorCause::Effect(*one)),
        _ => Some(ErrorCause::Effects),
    });
    let by_effect = found.keys().any(|cause| matches!(cause, ErrorCause::Effect(_)));
    first.retain(|cause| !(found.contains_key(cause) || *cause == ErrorCause::Effects && by_effect));
    let mut causes = changes(case, summary, cells, first, &mut found, recorder)?;
    let together = found.get(&ErrorCause::Effects);
    let share = |errors: &Figures| {
        error::relative(summary, errors, floors, small(accuracy))
            .into_values()
            .fold(0.0, f64::max)
    };
    if effects.len() > 1
        && !by_effect
        && together.is_none_or(|errors| share(errors) > NAMED * least(accuracy))
        && causes != ChangesStatus::Interrupted
    {
        found.remove(&ErrorCause::Effects);
        let each = effects.into_iter().map(ErrorCause::Effect).collect();
        causes = causes.max(changes(case, summary, cells, each, &mut found, recorder)?);
    }
    if accuracy.is_some()
        && let Some(errors) = found.get_mut(&ErrorCause::TimeSteps)
    {
        error::raise_to_balance(summary, errors, floors);
    }
    Ok(match causes {
        ChangesStatus::All => Causes::Complete(found),
        ChangesStatus::Some => Causes::Partial(found),
        ChangesStatus::Interrupted => Causes::Interrupted,
    })
}

/// Shares of each cause in the largest error of each quantity.
fn shares(
    summary: &Summary,
    causes: Option<&BTreeMap<ErrorCause, Figures>>,
) -> BTreeMap<String, Vec<(ErrorCause, f64)>> {
    let of = |name: &String| {
        let size = |errors: &Figures| errors.get(name).and_then(largest_error).unwrap_or(0.0);
        let largest = largest_figure(summary, name);
        let each = causes.into_iter().flatten();
        let mut all: Vec<(ErrorCause, f64)> = each.map(|(c, errors)| (*c, size(errors) / largest)).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        (name.clone(), all)
    };
    summary.errors.keys().map(of).collect()
}

/// Largest figure of a quantity, probe or port.
fn largest_figure(summary: &Summary, name: &str) -> f64 {
    let all = [&summary.quantities, &summary.probes, &summary.ports];
    all.iter().find_map(|all| all.get(name)).map_or(0.0, |q| q.size())
}

/// True if only the value at the end has a large error.
fn only_at_the_end(summary: &Summary, name: &str) -> bool {
    let limit = NAMED_FROM * largest_figure(summary, name);
    let above = |(figure, error): (&String, &f64)| has_unit_of_quantity(figure) && *error > limit;
    let errors = summary.errors.get(name).into_iter().flatten();
    errors.filter(|one| above(*one)).all(|(figure, _)| figure == "final")
}

fn describe(
    case: &Case,
    summary: &Summary,
    large: &[(String, f64)],
    measured: &Causes,
    shares: &BTreeMap<String, Vec<(ErrorCause, f64)>>,
) -> String {
    let named = |(name, error): &(String, f64)| match only_at_the_end(summary, name) {
        true => format!("{name} (final) ± {}", percent(*error)),
        false => format!("{name} ± {}", percent(*error)),
    };
    let names: Vec<String> = large.iter().map(named).collect();
    let found = format!(
        "estimated errors above {} % of the largest value: {}.",
        100.0 * NAMED_FROM,
        names.join(", ")
    );
    let of = |name: &str| shares.get(name).map_or(&[][..], Vec::as_slice);
    let (worst, error) = (&large[0].0, large[0].1);
    let causes: Vec<String> = of(worst)
        .iter()
        .filter(|(_, share)| *share >= NAMED * error)
        .map(|(cause, share)| format!("{} {}", cause.name(), percent(*share)))
        .collect();
    // the largest cause of each quantity, and others that are above the limit by themselves
    let mut wanted: BTreeMap<ErrorCause, f64> = BTreeMap::new();
    for (name, error) in large {
        let sum: f64 = of(name).iter().map(|(_, share)| share).sum();
        let named = of(name).iter().filter(|(_, share)| *share >= NAMED * error);
        for (k, (cause, share)) in named.enumerate() {
            // the error bar is what has to become small
            let part = share.max(error * share / sum);
            if k == 0 || part > NAMED_FROM {
                let most = wanted.entry(*cause).or_insert(0.0);
                *most = most.max(part);
            }
        }
    }
    if causes.is_empty() {
        let what = match measured {
            Causes::Interrupted => "The measurement of their causes was interrupted",
            Causes::TooLarge => "The run is too large to measure their causes",
            Causes::Complete(_) | Causes::Partial(_) => "No setting by itself makes a tenth of them",
        };
        return Code::ErrorEstimate.warning(format!("{found} {what}. Use --accuracy {LIMIT}."));
    }
    let set: Vec<String> = wanted.iter().map(|(cause, error)| cause.remedy(case, *error)).collect();
    Code::ErrorEstimate.warning(format!(
        "{found} Causes for {worst}: {}. Use {} and repeat while errors are large, or use --accuracy {LIMIT}.",
        causes.join(", "),
        set.join(" ")
    ))
}

impl ErrorCause {
    fn name(self) -> String {
        match self {
            Self::BeamMesh => "beam mesh".into(),
            Self::FluidMesh => "fluid mesh".into(),
            Self::TimeSteps => "time steps".into(),
            Self::Effects => "effects left out".into(),
            Self::Effect(effect) => format!("{effect} left out"),
        }
    }

    /// The argument that reduces an error of this size below that from which a quantity is named.
    fn remedy(self, case: &Case, error: f64) -> String {
        let times = |order: f64| ((error / NAMED_FROM).log2() / order).ceil().max(1.0).exp2() as usize;
        match self {
            Self::BeamMesh => {
                let cells = case.mesh.cells_per_segment;
                let finer = cells * times(f64::from(case.mesh.order())).min(FINER);
                format!("--set {}={finer}", self.pointer())
            }
            Self::FluidMesh => {
                let cells = case.mesh.cells_per_bladder;
                let finer = cells * times(1.0).min(FINER);
                format!("--set {}={finer}", self.pointer())
            }
            Self::TimeSteps => {
                let decades = (error / NAMED_FROM).log10().ceil().clamp(1.0, DECADES);
                let tighter = (case.solver.rtol * 10_f64.powf(-decades)).max(TIGHTEST);
                format!("--set {}={tighter:.0e}", self.pointer())
            }
            Self::Effects => format!("--set '{}=\"full\"'", self.pointer()),
            Self::Effect(_) => format!("--set '{}=\"on\"'", self.pointer()),
        }
    }
}
