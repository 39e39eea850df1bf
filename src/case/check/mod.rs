//! Rules beyond the JSON schema; all faults are reported at once.

mod attachments;
mod bladders;
mod coefficients;
mod contacts;
pub mod controllers;
mod ends;
mod fluid;
pub mod functions;
mod junctions;
mod moment_curvature;
pub mod network;
mod plausible;
mod probes;
pub mod rarely_intended;
mod relaxation;
mod rotating_frame;
mod size;
mod span_sections;
mod spans;
mod start;
mod strength;
mod structures;
mod time;
mod tubes;
mod vessels;

use super::faults::Violations;
use super::schema::Case;
use super::structure;
use crate::error::{Code, Violation};

/// A group of rules.
type Rule = fn(&Case, &mut Violations);

/// All rules, each with the sections of the case that it compares.
const RULES: &[(Rule, &[&str])] = &[
    (name, &[]),
    (plausible::sizes, &[]),
    (plausible::proportions, &["beam", "tubes", "network"]),
    (
        bladders::check,
        &["beam", "fluid", "bladders", "tubes", "network", "start", "mesh"],
    ),
    (fluid::check, &["fluid", "network", "start", "time"]),
    (network::check, &["bladders", "tubes", "network", "time"]),
    (ends::check, &[]),
    (attachments::check, &[]),
    (contacts::check, &[]),
    (probes::check, &[]),
    (relaxation::check, &["beam"]),
    (moment_curvature::check, &["beam", "bladders", "spans"]),
    (rotating_frame::check, &["beam", "loads", "surroundings"]),
    (probes::step, &["step_response", "time"]),
    (functions::check, &["time"]),
    (controllers::check, &["time"]),
    (start::check, &["beam", "bladders", "ends", "start", "time"]),
    (time::check, &[]),
    (
        strength::check,
        &[
            "beam",
            "bladders",
            "network",
            "loads",
            "ends",
            "start",
            "time",
            "rotating_frame",
        ],
    ),
    (coefficients::check, &["beam", "bladders", "tubes"]),
    (spans::axes, &["beam", "bladders", "mesh", "spans"]),
    (
        spans::check,
        &["beam", "bladders", "fluid", "tubes", "mesh", "spans", "surroundings"],
    ),
    (
        structures::check,
        &["beam", "bladders", "mesh", "spans", "beams", "joints", "start", "ends"],
    ),
];

/// Applies all rules to a case, except those that compare a broken section with others.
pub fn check(case: &Case, broken: &[String], faults: &mut Violations) {
    if !case.plausibility.is_on() {
        faults.take_as_meant();
    }
    for (rule, _) in RULES
        .iter()
        .filter(|(_, reads)| !broken.iter().any(|section| reads.contains(&section.as_str())))
    {
        rule(case, faults);
    }
    if case.is_structure() {
        faults.rename(|pointer| structure::written_span(case, pointer));
    }
}

/// Checks that the name of the case is a valid name of a folder.
fn name(case: &Case, faults: &mut Violations) {
    let good = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if case.name.is_empty() || case.name.starts_with('.') || !case.name.chars().all(good) {
        let fault = Violation::new(Code::CaseName, "/name", "a name that a folder cannot have");
        faults.push(fault.allowed("letters, digits, `-`, `_` and `.`, not starting with `.`"));
    }
}
