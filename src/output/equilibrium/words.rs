//! A load path in words.

use super::Found;
use crate::output::numbers::{count, quantity, significant};
use crate::study::refine::meshes::Meshes;

/// Rows of the table at most.
const ROWS: usize = 12;

/// A table of the path, what happened on it, the last state, derivatives.
pub fn words(found: &Found) -> String {
    let path = found.path;
    let mut text = table(found);
    for event in &path.events {
        text.push_str(&format!(
            "at {} of the loads: {}\n",
            significant(event.share, 6),
            event.words()
        ));
    }
    if let Some(words) = found.meshes.and_then(Meshes::words) {
        text.push_str(&format!("\n{words}\n"));
    }
    for warning in found.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    if let Some(last) = path.states.last() {
        let stability = match &last.stability {
            None => "stability unknown".into(),
            Some(s) if s.unstable == 0 => "stable".into(),
            Some(s) => format!(
                "unstable in {} way{}",
                s.unstable,
                if s.unstable == 1 { "" } else { "s" }
            ),
        };
        text.push_str(&format!(
            "\n{} of the loads at t = {} s, {stability}: {} states, {} Newton steps, {} in all\n",
            significant(last.share, 6),
            significant(found.options.at_s, 6),
            count(path.states.len() as u64),
            count(path.work.iterations),
            quantity(found.wall_s, "s", 3),
        ));
    }
    for s in found.sensitivities {
        text.push_str(&format!(
            "\nderivatives by {} = {}\n",
            s.parameter.pointer,
            significant(s.parameter.value, 6)
        ));
        for (column, derivative) in found.columns.iter().zip(&s.row).skip(1) {
            let relative = s.parameter.value * derivative;
            text.push_str(&format!(
                "  {:<16} {:>14} {} per unit, {} {} per 1 %\n",
                column.name,
                significant(*derivative, 6),
                column.unit,
                significant(0.01 * relative, 4),
                column.unit,
            ));
        }
    }
    if let Some(accuracy) = found.accuracy {
        text.push('\n');
        text.push_str(&crate::output::accuracy::words(accuracy));
    }
    text
}

/// Some of the states, first and last among them.
fn table(found: &Found) -> String {
    let columns: Vec<(usize, String)> = found
        .columns
        .iter()
        .enumerate()
        .filter(|(_, c)| {
            [
                "load_factor",
                "tip_u1",
                "tip_u3",
                "tip_angle",
                "max_pressure",
                "min_pressure",
            ]
            .contains(&c.name.as_str())
        })
        .map(|(k, c)| (k, format!("{} [{}]", c.name, c.unit)))
        .collect();
    let states = &found.path.states;
    let mut text = String::new();
    for (_, name) in &columns {
        text.push_str(&format!("{name:>18}"));
    }
    text.push_str(&format!("{:>10}\n", "unstable"));
    let every = states.len().div_ceil(ROWS).max(1);
    let mut shown: Vec<usize> = (0..states.len()).rev().step_by(every).collect();
    shown.reverse();
    for k in shown {
        for (column, _) in &columns {
            text.push_str(&format!("{:>18}", significant(states[k].row[*column], 6)));
        }
        let unstable = states[k]
            .stability
            .as_ref()
            .map_or("–".into(), |s| s.unstable.to_string());
        text.push_str(&format!("{unstable:>10}\n"));
    }
    text
}
