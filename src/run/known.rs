//! What is known of a case before anything is computed, for every command in the same words.

use std::collections::BTreeMap;

use crate::case::schema::Case;
use crate::case::seldom;
use crate::discrete::{System, resolution};
use crate::error::Code;
use crate::model::{audit, characteristic};

/// Characteristic numbers by name.
type Numbers = BTreeMap<String, f64>;

/// What stays true whatever a run finds: of the case with its characteristic numbers, and of its mesh.
pub fn lasting(case: &Case, system: &System, numbers: &Numbers) -> Vec<String> {
    with_the_mesh(
        audit::lasting(case, &system.model, numbers),
        case,
        system,
        numbers,
        false,
    )
}

/// The same of a run, which observes the flows that its valves stop.
pub fn before_a_run(case: &Case, system: &System, numbers: &Numbers) -> Vec<String> {
    let mut all = lasting(case, system, numbers);
    all.retain(|warning| !warning.starts_with(Code::WaterHammer.id()));
    all
}

/// The part of that which no mesh changes.
pub fn on_any_mesh(case: &Case, system: &System) -> Vec<String> {
    let numbers = characteristic::numbers(case, &system.model);
    audit::lasting(case, &system.model, &numbers)
}

/// That, and what is expected of it: of what does not run and look for itself.
pub fn warnings(case: &Case, system: &System) -> Vec<String> {
    let numbers = characteristic::numbers(case, &system.model);
    with_the_mesh(
        audit::warnings(case, &system.model, &numbers),
        case,
        system,
        &numbers,
        false,
    )
}

/// The same of what has no output times: a cycle, multipliers.
pub fn without_outputs(case: &Case, system: &System) -> Vec<String> {
    let mut all = warnings(case, system);
    all.retain(|warning| !warning.starts_with(Code::FewOutputs.id()));
    all
}

/// The same of a state at rest, and of what swings about it by as little as one likes: numbers of motions that the case expects say
/// nothing of its flows and strains, which the state itself has.
pub fn at_rest(case: &Case, system: &System) -> Vec<String> {
    let numbers = characteristic::numbers(case, &system.model);
    let mut of_case = audit::lasting(case, &system.model, &numbers);
    let of_motion = [Code::FewOutputs, Code::FastFlow, Code::Strain].map(Code::id);
    of_case.retain(|warning| !of_motion.iter().any(|id| warning.starts_with(id)));
    with_the_mesh(of_case, case, system, &numbers, true)
}

/// What there is to say of an instant that a command is asked about [s].
pub fn instant(case: &Case, at: Option<f64>) -> Option<String> {
    Some(Code::Seldom.warning(seldom::instant(case, at?)?))
}

fn told(seldom: Vec<(String, String)>) -> Vec<String> {
    let told = |(at, what)| Code::Seldom.warning(format!("{at}: {what}"));
    seldom.into_iter().map(told).collect()
}

/// Adds what sizes of the case and its mesh give; of a state `at_rest` nothing that belongs to what changes in time.
fn with_the_mesh(mut all: Vec<String>, case: &Case, system: &System, numbers: &Numbers, at_rest: bool) -> Vec<String> {
    all.extend(told(seldom::sizes(case)));
    if !at_rest {
        all.extend(told(seldom::late(case)));
    }
    let first = numbers.get("first_bending_frequency_hz").copied();
    all.extend(told(seldom::damping(case, first)));
    all.extend(told(seldom::unheld(case, &system.model.unheld()).into_iter().collect()));
    all.extend(match at_rest {
        true => resolution::warnings_at_rest(case, system),
        false => resolution::warnings(case, system),
    });
    all
}
