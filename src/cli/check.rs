//! `slcbeam check`: what a case is, before anything is run.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use serde_json::json;

use super::arguments::CheckArguments;
use super::size;
use crate::discrete::System;
use crate::error::Result;
use crate::model::{audit, characteristic};
use crate::output::columns::aligned;
use crate::output::machine;
use crate::output::numbers::{duration, pretty_unit, significant};
use crate::output::report::facts;
use crate::run::drive::comes_to_rest;
use crate::run::needs::Needs;
use crate::run::{known, method, slow};

/// Prints characteristic numbers, coupling audit, chosen effects and warnings.
pub fn check(asked: &CheckArguments) -> Result<ExitCode> {
    let case = &size::load(&asked.case)?;
    let system = System::new(case)?;
    let numbers = characteristic::numbers(case, &system.model);
    let findings = audit::coupling(case, &system.model);
    let mut warnings = known::warnings(case, &system);
    // what goes on for ever has no state of rest that the fluid could be late for
    if comes_to_rest(&system.model) {
        warnings.extend(slow::warning(case, &system, case.time.end_s));
    }
    let chosen = method::choose(case, &system);
    let (order, why) = (chosen.order.order, &chosen.order.reason);
    let needs = Needs::of(case, 0);
    let disk = size::disk(case, &system, 0).all();
    let free = machine::free(Path::new("."));
    if asked.json {
        let audit: Vec<_> = findings
            .iter()
            .map(|f| json!({"name": f.name, "value": f.value, "wanted": f.wanted, "good": f.good, "consequence": f.consequence}))
            .collect();
        let effects: serde_json::Map<_, _> = system
            .model
            .effects
            .decisions
            .iter()
            .map(|d| {
                (
                    d.effect.to_string(),
                    json!({"value": if d.on { "on" } else { "off" }, "reason": d.cause.to_string()}),
                )
            })
            .collect();
        let all = json!({
            "case": case.name, "unknowns": system.layout.len, "characteristic": numbers, "audit": audit,
            "effects": effects, "method": {"value": chosen.name(), "reason": chosen.reason},
            "needs": {
                "memory_bytes": needs.memory, "memory_available_bytes": machine::memory(),
                "disk_bytes": disk, "disk_free_bytes": free, "set_up_s": needs.set_up_s,
            },
            "max_order": {"value": order, "reason": why}, "origins": case.origins.words(), "warnings": warnings,
        });
        super::print(&format!("{all:#}\n"))?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut text = format!("{}: valid", case.name);
    if !case.about.is_empty() {
        let _ = write!(text, "\n{}", case.about);
    }
    text += "\n\ncharacteristic numbers\n";
    text += &listed(numbers.iter().map(|(name, value)| {
        let [unit, about] = facts::meaning(name).unwrap_or(["1", ""]);
        [
            name.to_string(),
            significant(*value, 6),
            pretty_unit(unit),
            about.to_string(),
        ]
    }));
    if !findings.is_empty() {
        text += "\ncoupling\n";
        text += &listed(findings.iter().map(|f| {
            let verdict = if f.good { "good" } else { "BAD" };
            let wanted = format!("wanted {}: {verdict}", f.wanted);
            [f.name.to_string(), significant(f.value, 5), wanted]
        }));
    }
    text += "\ncoefficients\n";
    let origins = case.origins.words().into_iter();
    text += &listed(origins.map(|(pointer, origin)| [pointer.to_string(), origin.to_string()]));
    text += "\neffects\n";
    text += &listed(system.model.effects.decisions.iter().map(|d| {
        let on = if d.on { "on" } else { "off" };
        [d.effect.to_string(), on.into(), d.cause.to_string()]
    }));
    let _ = writeln!(
        text,
        "\nunknowns {}, method {} ({}), highest order {order} ({why})",
        system.layout.len,
        chosen.name(),
        chosen.reason
    );
    let _ = writeln!(
        text,
        "a run needs about {} of memory, {} to set up, {} of disk{}",
        size::bytes(needs.memory),
        duration(needs.set_up_s),
        size::bytes(disk),
        free.filter(|free| disk > *free)
            .map_or_else(String::new, |free| format!(
                ", more than the {} that are free here",
                size::bytes(free)
            ))
    );
    if !warnings.is_empty() {
        text += "\nwarnings\n";
        for w in &warnings {
            let _ = writeln!(text, "  - {w}");
        }
    }
    super::print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// Lines under a heading, indented.
fn listed<const N: usize>(lines: impl Iterator<Item = [String; N]>) -> String {
    let lines: Vec<_> = lines.map(|line| [&[String::new()], &line[..]].concat()).collect();
    aligned(&lines, &[1, 2, 3])
}
