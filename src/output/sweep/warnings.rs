//! Warnings about many designs: modes that change places between neighboring designs, and counted warnings of the designs.

use std::collections::BTreeMap;

use super::JournalSummary;
use crate::error::{Code, Result};
use crate::output::columns::if_any;
use crate::output::numbers::{significant, trimmed};
use crate::results::sweep::SweepPlan;
use crate::study::sweep::exchanged::{DesignModes, Exchange, MOST, exchanges};

/// Largest number of exchanges listed.
const LISTED: usize = 3;

/// Exchanges of modes between designs that finished, as far as designs are compared.
///
/// # Errors
/// The journal cannot be read.
pub fn find_exchanges(plan: &SweepPlan, survey: &JournalSummary) -> Result<Vec<Exchange>> {
    let mut designs = vec![];
    survey.each(|row| {
        if designs.len() < MOST {
            designs.extend(DesignModes::from_row(&row));
        }
        Ok(())
    })?;
    Ok(exchanges(plan, &designs))
}

/// Warnings about modes that change places between designs, and counted warnings of the designs.
///
/// # Errors
/// The journal cannot be read.
pub fn warnings(plan: &SweepPlan, survey: &JournalSummary) -> Result<Vec<String>> {
    let mut all = of_exchanges(&find_exchanges(plan, survey)?);
    all.extend(count_warnings(survey)?);
    Ok(all)
}

/// Warning about exchanges; empty if there are none.
fn of_exchanges(all: &[Exchange]) -> Vec<String> {
    let one = |found: &Exchange| {
        let ([a, b], [from, to], [k, j]) = (found.designs, found.values, found.modes);
        let number = |x: f64| trimmed(&significant(x, 3));
        format!(
            "mode_{k} of design {a} is mode_{j} of design {b} ({} from {} to {})",
            found.pointer,
            number(from),
            number(to)
        )
    };
    let listed: Vec<String> = all.iter().take(LISTED).map(one).collect();
    let more = if_any(all.len().saturating_sub(LISTED), |n| {
        format!("; and so between {n} more pairs of designs")
    });
    let warning = || {
        Code::ModesExchanged.warning(format!(
            "modes change places: {}{more}; read damping_ratio beside each frequency",
            listed.join("; ")
        ))
    };
    (!all.is_empty()).then(warning).into_iter().collect()
}

/// For each warning the number of designs that have it, and the first of them. The table lists all.
fn count_warnings(survey: &JournalSummary) -> Result<Vec<String>> {
    let (mut all, mut first) = (0, BTreeMap::<String, (usize, usize)>::new());
    survey.each(|row| {
        all += 1;
        for code in row.found.warnings {
            first.entry(code).or_insert((0, row.number)).0 += 1;
        }
        Ok(())
    })?;
    let words = |(id, (count, first)): (String, (usize, usize))| {
        let code = Code::find(&id)?;
        // exchanged modes have a more detailed warning
        let title = code.title().trim_end_matches('.');
        let designs = match (count, all) {
            (1, 1) => "the design".into(),
            (1, _) => format!("1 of {all} designs, design {first}"),
            _ => format!("{count} of {all} designs, the first of them design {first}"),
        };
        (code != Code::ModesExchanged).then(|| code.warning(format!("{title}: {designs}")))
    };
    Ok(first.into_iter().filter_map(words).collect())
}
