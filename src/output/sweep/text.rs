//! Text of many designs.

use std::fmt::Write as _;

use super::JournalSummary;
use crate::error::Result;
use crate::error::numbers::quantity;
use crate::output::columns::bracketed;
use crate::output::numbers::{count, counted};
use crate::results::sweep::Sweep;
use crate::run::summary::Status;
use crate::study::analysis::ACCURACY;
use crate::study::analysis::word;
use crate::study::sweep::designs::pairs;

/// Largest number of designs without a full result that are listed.
const LISTED: usize = 5;

/// Number of designs by status, what one costs, and the first that did not finish.
///
/// # Errors
/// The journal cannot be read.
pub fn describe(sweep: &Sweep, survey: &JournalSummary) -> Result<String> {
    let (plan, rows) = (&sweep.plan, sweep.rows);
    let kinds = kinds(survey.statuses.iter().map(|(status, n)| (word(*status), n)));
    let shard = plan
        .shard
        .map_or(String::new(), |shard| format!(", shard {}", shard.describe()));
    let pointers = plan.pointers();
    let (mut first, mut short, mut spent) = (vec![], 0, 0.0);
    survey.each(|row| {
        spent += row.wall_s;
        short += usize::from(row.found.figure(ACCURACY) == Some(0.0));
        if row.found.status != Status::Finished && first.len() < LISTED {
            let values = pairs(&pointers, &row.values);
            let place = bracketed((!values.is_empty()).then_some(values), "");
            let why = row.found.reason.unwrap_or_default();
            first.push(format!(
                "  design {}{place}: {}: {why}\n",
                row.number,
                word(row.found.status)
            ));
        }
        Ok(())
    })?;
    let each = match rows {
        0 => String::new(),
        rows => format!("; {} each", quantity(spent / rows as f64, "s", 2)),
    };
    let mut text = format!(
        "{} of {}{shard} by {}: {kinds}{each}\n",
        several(rows),
        plan.title(),
        plan.command.word()
    );
    text += &first.concat();
    if short > 0 {
        let verb = if short == 1 { "does" } else { "do" };
        let _ = writeln!(
            text,
            "  {} {verb} not reach the accuracy that was asked for: {ACCURACY} is 0 in sweep.csv",
            several(short)
        );
    }
    let others = rows - survey.statuses.get(&Status::Finished).unwrap_or(&0);
    if others > first.len() {
        let _ = writeln!(
            text,
            "  and {} more; sweep.csv has their reasons",
            count((others - first.len()) as u64)
        );
    }
    for warning in &sweep.warnings {
        let _ = writeln!(text, "  warning: {warning}");
    }
    Ok(text)
}

/// A number of designs.
pub fn several(count_of: usize) -> String {
    counted(count_of as u64, "design")
}

/// Number of designs by status.
pub fn kinds<'a>(statuses: impl Iterator<Item = (&'a str, &'a usize)>) -> String {
    let kinds = statuses.map(|(status, n)| format!("{} {}", count(*n as u64), status.replace('_', " ")));
    let kinds = kinds.collect::<Vec<_>>().join(", ");
    if kinds.is_empty() { "none".into() } else { kinds }
}
