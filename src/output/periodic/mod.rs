//! What cycles leave behind besides a result folder: `cycle.json`; `sweep.csv`, `sweep.json`, `sweep.svg`; and their words.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::accuracy::with_warnings;
use super::folder::ResultFolder;
use super::numbers::{count, percent, quantity, shortest, significant};
use super::plot::cycles::{self, Cycles, Quantity};
use crate::error::Result;
use crate::run::floquet::Stability;
use crate::run::periodic::Search;
use crate::run::summary::Summary;
use crate::study::stability::{Along, Member};

/// Stability and search of a cycle, in its result folder.
pub const CYCLE: &str = "cycle.json";

/// Figures over the period that table and picture show: name, unit.
const SHOWN: [(&str, &str); 3] = [("tip_u1_m", "m"), ("tip_u3_m", "m"), ("max_pressure_pa", "Pa")];

fn largest(member: &Member, name: &str) -> Option<f64> {
    member.quantities.get(name).and_then(|q| q.window_max_abs)
}

/// The text of `sweep.json`, with what to know of the first case.
pub fn json(found: &Along, warnings: &[String]) -> String {
    let value = with_warnings(serde_json::to_value(found).unwrap_or_default(), warnings);
    format!("{value:#}\n")
}

/// The text of `sweep.csv`: one row a cycle.
pub fn csv(found: &Along) -> String {
    let mut text = format!(
        "{} [as in the case],largest |tip_u1| [m],largest |tip_u3| [m],largest pressure [Pa],growth rate [1/s],multiplier real part \
         [1],multiplier imaginary part [1],steps [1],unknowns [1],wall time [s],verdict\n",
        found.pointer
    );
    for m in &found.members {
        let first = m.floquet.multipliers.first();
        let number = |x: Option<f64>| x.map_or(String::new(), shortest);
        let mut row = vec![shortest(m.value)];
        row.extend(SHOWN.map(|(name, _)| number(largest(m, name))));
        row.extend([number(first.map(|f| f.growth_per_s)), number(first.map(|f| f.re))]);
        row.extend([number(first.map(|f| f.im)), m.search.work.steps.to_string()]);
        row.extend([m.unknowns.to_string(), shortest(m.wall_s)]);
        let _ = writeln!(text, "{},\"{}\"", row.join(","), m.floquet.verdict.words);
    }
    text
}

/// The table, and what it took.
pub fn words(found: &Along) -> String {
    let mut text = format!(
        "  {:<12} largest |u1| [m]   largest pressure [Pa]   verdict\n",
        found.pointer
    );
    for m in &found.members {
        let number = |name| largest(m, name).map_or("–".into(), |x| significant(x, 4));
        let _ = writeln!(
            text,
            "  {:<12} {:>16} {:>23}   {}",
            significant(m.value, 4),
            number("tip_u1_m"),
            number("max_pressure_pa"),
            m.floquet.verdict.words
        );
    }
    for (value, why) in &found.missing {
        let _ = writeln!(text, "  {:<12} {why}", significant(*value, 4));
    }
    let steps: u64 = found.members.iter().map(|m| m.search.work.steps).sum();
    let solves: u64 = found.members.iter().map(|m| m.search.work.linear_solves).sum();
    let wall: f64 = found.members.iter().map(|m| m.wall_s).sum();
    let _ = writeln!(
        text,
        "\n{} cycles in {} steps and {} linear solves, {} s",
        found.members.len(),
        count(steps),
        count(solves),
        significant(wall, 3)
    );
    text
}

/// Writes the files of a sweep into a folder, which is made.
pub fn write(folder: &mut ResultFolder, found: &Along, warnings: &[String]) -> Result<Vec<PathBuf>> {
    let quantities = SHOWN.iter().filter_map(|(name, unit)| {
        let values: Option<Vec<f64>> = found.members.iter().map(|m| largest(m, name)).collect();
        let short = name.trim_end_matches(&format!("_{}", unit.to_lowercase())).to_string();
        Some(Quantity {
            name: format!("largest {short}"),
            unit: (*unit).into(),
            values: values?,
        })
    });
    let growth = found.members.iter().map(|m| m.floquet.verdict.growth_per_s);
    let picture = cycles::draw(&Cycles {
        case: found.case.clone(),
        pointer: found.pointer.clone(),
        logarithmic: found.logarithmic,
        parameter: found.members.iter().map(|m| m.value).collect(),
        stable: found
            .members
            .iter()
            .map(|m| m.floquet.verdict.stability != Stability::Unstable)
            .collect(),
        quantities: quantities
            .chain([Quantity {
                name: "growth".into(),
                unit: "1/s".into(),
                values: growth.collect(),
            }])
            .collect(),
    });
    let mut files = vec![("sweep.csv", csv(found)), ("sweep.json", json(found, warnings))];
    files.extend(picture.map(|text| ("sweep.svg", text)));
    folder.fill(files)
}

/// Largest values and energies over the period, in words; energies with how far their balance is open beside them.
pub fn figures(summary: &Summary) -> String {
    let quantities = &summary.quantities;
    let mut text = String::new();
    for (name, unit) in SHOWN {
        if let Some(value) = quantities.get(name).and_then(|q| q.window_max_abs) {
            let short = name.trim_end_matches(&format!("_{}", unit.to_lowercase()));
            let _ = writeln!(text, "largest {short:<14} {}", quantity(value, unit, 4));
        }
    }
    for (name, words) in [
        ("input_energy_j", "put in over the cycle"),
        ("harvested_energy_j", "harvested"),
        ("efficiency", "efficiency"),
    ] {
        let Some((value, q)) = quantities.get(name).and_then(|q| Some((q.window?, q))) else {
            continue;
        };
        let shown = if name == "efficiency" {
            percent(value)
        } else {
            quantity(value, "J", 4)
        };
        let open = q
            .window_error
            .map_or(String::new(), |e| format!(" (balance open by {} of it)", percent(e)));
        let _ = writeln!(text, "{words:<22} {shown}{open}");
    }
    text
}

/// What the search took, in words.
pub fn search(search: &Search) -> String {
    format!(
        "found in {} Newton steps over {} periods: {} steps, {} residuals, {} linear solves; it returns to {:.1e} of the tolerance\n",
        search.newton_steps,
        search.periods,
        count(search.work.steps),
        count(search.work.residual_evaluations),
        count(search.work.linear_solves),
        search.residual
    )
}
