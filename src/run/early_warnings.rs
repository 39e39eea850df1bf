//! Warnings that are known before a computation, with the same text for every command.

use std::collections::BTreeMap;

use crate::case::rarely_intended;
use crate::case::schema::Case;
use crate::discrete::{System, resolution};
use crate::error::Code;
use crate::model::{audit, characteristic};
use crate::run::control_loop;

/// Characteristic numbers by name.
type Numbers = BTreeMap<String, f64>;

/// Warnings that no result of a run changes: those of the case, of its characteristic numbers and of its mesh.
pub fn lasting(case: &Case, system: &System, numbers: &Numbers) -> Vec<String> {
    with_the_mesh(
        audit::lasting(case, &system.model, numbers),
        case,
        system,
        numbers,
        false,
    )
}

/// Lasting warnings before a run, without water hammer: the run observes the flows that its valves stop.
pub fn before_a_run(case: &Case, system: &System, numbers: &Numbers) -> Vec<String> {
    let mut all = lasting(case, system, numbers);
    all.retain(|warning| !warning.starts_with(Code::WaterHammer.id()));
    all
}

/// Lasting warnings that do not depend on the mesh.
pub fn on_any_mesh(case: &Case, system: &System) -> Vec<String> {
    let numbers = characteristic::numbers(case, &system.model);
    audit::lasting(case, &system.model, &numbers)
}

/// Lasting warnings and those of the expected behavior, for commands that do not simulate the case.
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

/// Warnings for results without output times: a cycle, multipliers.
pub fn without_outputs(case: &Case, system: &System) -> Vec<String> {
    let mut all = warnings(case, system);
    all.retain(|warning| !warning.starts_with(Code::FewOutputs.id()));
    all
}

/// Warnings for an equilibrium and small oscillations about it. Excludes estimates of the expected motion, since the
/// equilibrium has its own flows and strains.
pub fn at_rest(case: &Case, system: &System) -> Vec<String> {
    let numbers = characteristic::numbers(case, &system.model);
    let mut of_case = audit::lasting(case, &system.model, &numbers);
    let of_motion = [Code::FewOutputs, Code::FastFlow, Code::Strain].map(Code::id);
    of_case.retain(|warning| !of_motion.iter().any(|id| warning.starts_with(id)));
    of_case.extend(control_loop::held(system));
    with_the_mesh(of_case, case, system, &numbers, true)
}

/// Warning about the time [s] at which a command evaluates the case, if it is unusual.
pub fn instant(case: &Case, at: Option<f64>) -> Option<String> {
    Some(Code::Seldom.warning(rarely_intended::instant(case, at?)?))
}

fn unusual(seldom: Vec<(String, String)>) -> Vec<String> {
    let warning = |(at, what)| Code::Seldom.warning(format!("{at}: {what}"));
    seldom.into_iter().map(warning).collect()
}

/// Adds warnings from the sizes of the case and its mesh. With `at_rest`, excludes warnings about changes in time.
fn with_the_mesh(mut all: Vec<String>, case: &Case, system: &System, numbers: &Numbers, at_rest: bool) -> Vec<String> {
    all.extend(unusual(rarely_intended::sizes(case)));
    if !at_rest {
        all.extend(unusual(rarely_intended::late(case)));
    }
    let first = numbers.get("first_bending_frequency_hz").copied();
    all.extend(unusual(rarely_intended::damping(case, first)));
    all.extend(unusual(
        rarely_intended::unheld(case, &system.model.unheld())
            .into_iter()
            .collect(),
    ));
    all.extend(match at_rest {
        true => resolution::warnings_at_rest(case, system),
        false => resolution::warnings(case, system),
    });
    all
}
