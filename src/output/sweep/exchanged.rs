//! Text about modes that change places between neighboring designs.

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

/// Warning about exchanges; empty if there are none.
pub fn warnings(all: &[Exchange]) -> Vec<String> {
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
