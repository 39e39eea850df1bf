//! `slcbeam check`: properties of a case, before anything is run.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use serde_json::{Map, json};
use textwrap::Options;

use super::arguments::CheckArguments;
use super::resources;
use crate::discrete::System;
use crate::error::Result;
use crate::model::effects::{Decision, DecisionCause};
use crate::model::{audit, characteristic};
use crate::output::columns::aligned;
use crate::output::machine;
use crate::output::numbers::{duration, pretty_unit, significant};
use crate::output::report::facts;
use crate::run::drive::comes_to_rest;
use crate::run::resource_estimate::ResourceEstimate;
use crate::run::{early_warnings, method, slow_fluid};

/// Characteristic numbers that only `--verbose` prints: scales from which others are formed.
const DETAILS: [&str; 21] = [
    "area_change_estimate",
    "base_acceleration_m_s2",
    "bladder_compliance_m3_pa",
    "bladder_fill",
    "bladder_resistance_pa_s_m3",
    "f_u",
    "force_scale_n",
    "forcing_frequency_hz",
    "gyration_radius_squared_m2",
    "inertial_compression_n_m",
    "mass_factor",
    "mass_per_length_kg_m",
    "mathieu_frequency_ratio",
    "mathieu_growth_bound_per_s",
    "mathieu_modulation",
    "self_weight_buckling_load_n_m",
    "slenderness",
    "t_f_s",
    "t_s_over_t_f",
    "t_s_s",
    "tube_resistance_pa_s_m3",
];

/// Largest number of lines about networks with different times, without `--verbose`.
const NETWORKS: usize = 3;

/// Prints characteristic numbers, coupling audit, chosen effects and warnings.
pub fn check(asked: &CheckArguments) -> Result<ExitCode> {
    let case = &resources::load(&asked.case)?;
    let system = System::new(case)?;
    let numbers = characteristic::numbers(case, &system.model);
    let findings = audit::coupling(case, &system.model);
    let mut warnings = early_warnings::warnings(case, &system);
    // a motion that never ends has no state of rest that the fluid could lag behind
    if comes_to_rest(&system.model) {
        warnings.extend(slow_fluid::warning(case, &system, case.time.end_s));
    }
    let chosen = method::choose(case, &system);
    let (order, why) = (chosen.order.order, &chosen.order.reason);
    let needs = ResourceEstimate::estimate(case, 0);
    let disk = resources::disk(case, &system, 0).all();
    let free = machine::free(Path::new("."));
    if asked.json {
        let audit = findings.iter().map(
            |f| json!({"name": f.name, "value": f.value, "wanted": f.wanted, "good": f.good, "consequence": f.consequence}),
        );
        let decision = |d: &Decision| {
            let value = if d.on { "on" } else { "off" };
            (
                d.effect.to_string(),
                json!({"value": value, "reason": d.cause.to_string()}),
            )
        };
        let effects: Map<_, _> = system.model.effects.decisions.iter().map(decision).collect();
        let all = json!({
            "case": case.name, "unknowns": system.layout.len, "characteristic": numbers, "audit": audit.collect::<Vec<_>>(),
            "effects": effects, "method": {"value": chosen.name(), "reason": chosen.reason},
            "needs": {
                "memory_bytes": needs.memory, "memory_available_bytes": machine::memory(),
                "disk_bytes": disk, "disk_free_bytes": free, "set_up_s": needs.set_up_s,
            },
            "max_order": {"value": order, "reason": why}, "origins": case.origins.describe(), "warnings": warnings,
        });
        super::print(&format!("{all:#}\n"))?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut text = format!("{}: valid", case.name);
    if !case.about.is_empty() {
        let _ = write!(text, "\n{}", case.about);
    }
    text += "\n\ncharacteristic numbers\n";
    let shown = |name: &str| asked.verbose || !DETAILS.contains(&name);
    let numbers: Vec<_> = numbers.iter().filter(|(name, _)| shown(name)).collect();
    text += &listed(
        grouped(&numbers, asked.verbose)
            .into_iter()
            .map(|(label, name, value)| {
                let [unit, about] = facts::meaning(name).unwrap_or(["1", ""]);
                [label, significant(value, 6), pretty_unit(unit), about.to_string()]
            }),
    );
    if !findings.is_empty() {
        text += "\ncoupling\n";
        let good = findings.iter().filter(|f| f.good).count();
        let shown = findings.iter().filter(|f| asked.verbose || !f.good);
        text += &listed(shown.map(|f| {
            let verdict = if f.good { "met" } else { "NOT MET" };
            let wanted = format!("required {}: {verdict}", f.wanted);
            [f.name.to_string(), significant(f.value, 5), wanted]
        }));
        if !asked.verbose {
            let _ = writeln!(
                text,
                "  {good} of {} conditions for an energy-conserving, passive coupling are met",
                findings.len()
            );
        }
    }
    text += "\ncoefficients\n";
    let mut origins: Vec<[String; 2]> = case.origins.describe().into_iter().map(<[String; 2]>::from).collect();
    if !asked.verbose {
        let mut by_origin: BTreeMap<String, usize> = BTreeMap::new();
        for [_, origin] in origins {
            *by_origin.entry(origin).or_default() += 1;
        }
        origins = by_origin
            .into_iter()
            .map(|(origin, count)| [count.to_string(), origin])
            .collect();
    }
    text += &listed(origins.into_iter());
    text += "\neffects\n";
    let by_case =
        |cause: &DecisionCause| matches!(cause, DecisionCause::Given(_) | DecisionCause::Filled(_)) && !asked.verbose;
    let (given, decided): (Vec<_>, Vec<_>) = system.model.effects.decisions.iter().partition(|d| by_case(&d.cause));
    text += &listed(decisions(&decided, asked.verbose).into_iter());
    for (on, what) in [(true, "  part of the case: "), (false, "  not part of the case: ")] {
        let names: Vec<_> = given
            .iter()
            .filter(|d| d.on == on)
            .map(|d| d.effect.to_string())
            .collect();
        if !names.is_empty() {
            let wrapped = Options::new(100).initial_indent(what).subsequent_indent("    ");
            text += &textwrap::fill(&names.join(", "), wrapped);
            text.push('\n');
        }
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
        resources::bytes(needs.memory),
        duration(needs.set_up_s),
        resources::bytes(disk),
        free.filter(|free| disk > *free)
            .map_or_else(String::new, |free| format!(
                ", more than the {} of free space here",
                resources::bytes(free)
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

/// Effects as name, state and cause. Neighbors with the same state and cause share a line, unless `all` is set.
fn decisions(decided: &[&Decision], all: bool) -> Vec<[String; 3]> {
    let mut lines: Vec<[String; 3]> = vec![];
    for one in decided {
        let on = if one.on { "on" } else { "off" };
        let (name, cause) = (one.effect.to_string(), one.cause.to_string());
        match lines
            .last_mut()
            .filter(|last| !all && last[1] == on && last[2] == cause)
        {
            Some(last) => last[0] = format!("{}, {name}", last[0]),
            None => lines.push([name, on.into(), cause]),
        }
    }
    lines
}

/// Indented lines under a heading.
fn listed<const N: usize>(lines: impl Iterator<Item = [String; N]>) -> String {
    let lines: Vec<_> = lines.map(|line| [&[String::new()], &line[..]].concat()).collect();
    aligned(&lines, &[1, 2, 3, 4])
}

/// Characteristic numbers as label, name and value. Unless `all` is set, networks with the same slowest time share a line, and only the
/// slowest are listed.
fn grouped<'n>(numbers: &[(&'n String, &f64)], all: bool) -> Vec<(String, &'n str, f64)> {
    const OF_NETWORK: &str = "slowest_time_of_network_";
    let number = |name: &str| name.strip_prefix(OF_NETWORK)?.strip_suffix("_s")?.parse::<usize>().ok();
    let mut lines: Vec<(String, &str, f64)> = vec![];
    let mut networks: Vec<(Vec<usize>, &str, f64)> = vec![];
    for (name, value) in numbers {
        let value = **value;
        let Some(k) = number(name).filter(|_| !all) else {
            lines.push((name.to_string(), name, value));
            continue;
        };
        match networks
            .iter_mut()
            .find(|own| (own.2 - value).abs() <= 1e-6 * value.abs())
        {
            Some(same) => same.0.push(k),
            None => networks.push((vec![k], name, value)),
        }
    }
    networks.sort_by(|a, b| b.2.total_cmp(&a.2));
    let hidden = networks.len().saturating_sub(NETWORKS);
    let listed = networks.into_iter().take(NETWORKS).enumerate();
    lines.extend(listed.map(|(at, (own, name, value))| {
        let more = match own.len() {
            1 => String::new(),
            n => format!(" and {} more of the same value", n - 1),
        };
        let faster = match hidden {
            n if n > 0 && at + 1 == NETWORKS => format!(", {n} faster ones not listed"),
            _ => String::new(),
        };
        (format!("{name}{more}{faster}"), name, value)
    }));
    lines
}
