//! Warnings of designs, counted.

use std::collections::BTreeMap;

use super::JournalSummary;
use crate::error::{Code, Result};

/// For each warning the number of designs that have it, and the first of them. The table lists all.
///
/// # Errors
/// The journal cannot be read.
pub fn count_warnings(survey: &JournalSummary) -> Result<Vec<String>> {
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
