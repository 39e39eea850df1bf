//! Text of an optimum.

use std::collections::BTreeMap;

use crate::error::visible;
use crate::output::columns::{if_any, table, warnings};
use crate::output::numbers::{counted, duration, percent, significant};
use crate::output::sweep::text::several;
use crate::results::optimum::{Bound, ComparedAlternative, DerivativeSource, LimitAtOptimum, Optimum, Variable};

/// Largest number of alternatives listed.
const SHOWN: usize = 12;
/// Relative difference of figures below which two searches have the same result.
const SAME: f64 = 1e-3;

/// The optimum, its position, its active bounds and limits, and the search.
pub fn describe(found: &Optimum) -> String {
    let goal = &found.goal;
    let mut text = format!(
        "{}: {} of `slcbeam {}`, {}: {}{}\n",
        found.case,
        goal.figure,
        found.command.word(),
        if goal.largest { "largest" } else { "least" },
        significant(found.value, 6),
        found
            .begin
            .map_or(String::new(), |begin| format!(", {} at first", significant(begin, 6)))
    );
    if let Some(error) = found.error.filter(|_| found.value != 0.0) {
        text += &format!(
            "estimated error of mesh, steps and effects left out: {}\n",
            percent(error / found.value.abs())
        );
    }
    text += &alternatives(found);
    if !found.variables.is_empty() {
        let headings = "< | best | at first | <bounds | <1 % worse at";
        text += &format!("\n{}", table(headings, found.variables.iter().map(line)));
    }
    if !found.limits.is_empty() {
        let limits = found.limits.iter().map(limit);
        text += &format!("\n{}", table("< | at the best | limit | <", limits));
    }
    let failed: usize = found.failed.values().sum();
    text += &format!(
        "\n{}{}{}, {}\n",
        several(found.evaluations),
        if_any(failed, |n| format!(", {n} of which failed,")),
        how(found),
        duration(found.wall_s)
    );
    for (reason, n) in alike(&found.failed) {
        text += &format!("{n} of {failed} that failed: {reason}\n");
    }
    if found.starts.len() > 1 {
        text += &starts(found);
    }
    text + &warnings(&found.warnings)
}

/// Reasons of failures with their counts. Reasons that differ only in numbers are combined under the first.
fn alike(failed: &BTreeMap<String, usize>) -> Vec<(String, usize)> {
    let mut kinds = BTreeMap::<String, (&str, usize, bool)>::new();
    for (reason, n) in failed {
        let kind = reason
            .chars()
            .filter(|c| !c.is_ascii_digit() && !"+-−.".contains(*c))
            .collect();
        let kind = kinds.entry(kind).and_modify(|kind| kind.2 = true);
        kind.or_insert((reason, 0, false)).1 += n;
    }
    let reasons = kinds.into_values().map(|(reason, count, more)| {
        let like = if more { ", and others with other numbers" } else { "" };
        (format!("{reason}{like}"), count)
    });
    reasons.collect()
}

/// Kind of derivatives; empty if no numbers were varied.
fn how(found: &Optimum) -> &'static str {
    match found.derivatives {
        _ if found.variables.is_empty() => "",
        DerivativeSource::Differences => " with derivatives by differences",
        DerivativeSource::Exact => " with exact derivatives",
    }
}

/// Table of the alternatives, the best first.
fn alternatives(found: &Optimum) -> String {
    if found.alternatives.is_empty() {
        return String::new();
    }
    let line = |one: &ComparedAlternative| {
        let note = match (&one.reason, one.held) {
            (Some(reason), _) => visible(reason).into_owned(),
            (None, true) => String::new(),
            (None, false) => "beyond a limit".into(),
        };
        let value = one.value.map_or("-".into(), |value| significant(value, 6));
        [String::new(), one.name.clone(), value, note]
    };
    let ranked = ranked(found);
    let shown = ranked.iter().take(SHOWN).map(|one| line(one));
    let headings = format!(" | < | {} | <", found.goal.figure);
    let more = if_any(ranked.len().saturating_sub(SHOWN), |n| {
        format!("  and {n} more in optimum.json\n")
    });
    format!("\n{}{more}", table(&headings, shown))
}

/// Alternatives, the best first: those within the limits, then those beyond a limit, then those without a value.
pub fn ranked(found: &Optimum) -> Vec<&ComparedAlternative> {
    let sign = found.goal.sign();
    let key = |one: &ComparedAlternative| {
        (
            one.value.is_none(),
            !one.held,
            one.value.map_or(0.0, |value| sign * value),
        )
    };
    let mut all: Vec<&ComparedAlternative> = found.alternatives.iter().collect();
    all.sort_by(|a, b| {
        let (a, b) = (key(a), key(b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    all
}

/// Bound at which a number lies, or the range in which the figure is at most 1 % worse.
pub fn place(one: &Variable) -> String {
    match (one.at_bound, one.within_1_percent) {
        (Some(Bound::Low), _) => "- (best at its lower bound)".into(),
        (Some(Bound::High), _) => "- (best at its upper bound)".into(),
        (None, Some([low, high])) => format!("{} and {}", significant(low, 4), significant(high, 4)),
        (None, None) => "between its bounds".into(),
    }
}

fn line(one: &Variable) -> [String; 5] {
    [
        one.pointer.clone(),
        significant(one.value, 6),
        significant(one.start, 4),
        format!("{} to {}", significant(one.low, 3), significant(one.high, 3)),
        place(one),
    ]
}

fn limit(one: &LimitAtOptimum) -> [String; 4] {
    let sign = match one.limit.sign() {
        "<=" => "≤",
        _ => "≥",
    };
    let gain = match (one.reached, one.gain) {
        _ if one.beyond() => "violated".into(),
        (true, Some(gain)) => format!("reached; relaxing it by one unit gains {}", significant(gain, 3)),
        (true, None) => "reached".into(),
        (false, _) => "not reached".into(),
    };
    [
        one.limit.figure.clone(),
        significant(one.value, 6),
        format!("{sign} {}", significant(one.limit.bound, 6)),
        gain,
    ]
}

/// Number of searches with this result, and results of the others.
fn starts(found: &Optimum) -> String {
    let all = found.starts.iter();
    let near = |value: f64| (value - found.value).abs() <= SAME * found.value.abs();
    let same = all
        .clone()
        .filter(|one| one.held && one.value.is_some_and(near))
        .count();
    let nothing = all.clone().filter(|one| one.value.is_none()).count();
    let beyond = all.clone().filter(|one| one.value.is_some() && !one.held).count();
    let mut others: Vec<f64> = all
        .filter(|one| one.held)
        .filter_map(|one| one.value)
        .filter(|v| !near(*v))
        .collect();
    others.sort_by(f64::total_cmp);
    others.dedup_by(|a, b| (*a - *b).abs() <= SAME * a.abs());
    let others: Vec<String> = others.iter().map(|value| significant(*value, 5)).collect();
    let mut text = format!(
        "{same} of {} reached this optimum",
        counted(found.starts.len() as u64, "search")
    );
    text += &if_any(others.len(), |_| format!("; others ended at {}", others.join(", ")));
    text += &if_any(beyond, |n| format!("; {n} ended outside the limits"));
    text += &if_any(nothing, |n| format!("; {n} found no design that can be computed"));
    text + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Goal: designs that fail for one reason, each at its own instant, take one line.
    #[test]
    fn reasons_that_differ_in_numbers_are_one() {
        let all = [
            "outgrown at t = 0.25 s",
            "outgrown at t = 0.31 s",
            "it ran out of steps",
        ];
        let failed = all.map(|reason| (reason.to_owned(), 2)).into_iter().collect();
        let reasons = alike(&failed);
        assert_eq!(reasons.len(), 2, "{reasons:?}");
        assert!(
            reasons.contains(&("outgrown at t = 0.25 s, and others with other numbers".into(), 4)),
            "{reasons:?}"
        );
    }
}
