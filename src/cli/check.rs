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
use crate::output::machine;
use crate::output::numbers::{duration, significant};
use crate::run::needs::Needs;
use crate::run::{known, method};

/// Prints characteristic numbers, coupling audit, chosen effects and warnings.
pub fn check(asked: &CheckArguments) -> Result<ExitCode> {
    let loaded = size::load(&asked.case)?;
    let case = &loaded.case;
    let system = System::new(case);
    super::refuse(&loaded, &system)?;
    let numbers = characteristic::numbers(case, &system.model);
    let findings = audit::coupling(case, &system.model);
    let warnings = known::warnings(case, &system);
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
    for (name, value) in &numbers {
        let _ = writeln!(text, "  {name:<38} {}", significant(*value, 6));
    }
    if !findings.is_empty() {
        text += "\ncoupling\n";
        for f in &findings {
            let verdict = if f.good { "good" } else { "BAD" };
            let _ = writeln!(
                text,
                "  {:<38} {:<12} wanted {}: {verdict}",
                f.name,
                significant(f.value, 5),
                f.wanted
            );
        }
    }
    text += "\ncoefficients\n";
    for (pointer, origin) in case.origins.words() {
        let _ = writeln!(text, "  {pointer:<52} {origin}");
    }
    text += "\neffects\n";
    for d in &system.model.effects.decisions {
        let _ = writeln!(
            text,
            "  {:<30} {:<4} {}",
            d.effect.name(),
            if d.on { "on" } else { "off" },
            d.cause
        );
    }
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
