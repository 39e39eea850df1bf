//! Numbers of bladders in messages.

use super::schema::Case;
use super::wiring::{BladderLabels, bladder_index};
use super::{spans, structure};

/// Cause and remedy of a bladder that a case with such a segment does not have; none if there is no such segment.
pub fn absence(case: &Case, number: i64) -> Option<(String, String)> {
    let per_row = case.segments();
    let index = bladder_index(number, per_row).filter(|index| !spans::has_bladder(case, *index))?;
    Some(match spans::rows(case)[index / per_row] {
        false => (
            "/bladders/lower is \"none\"".to_owned(),
            "name bladders of the upper row, or remove \"lower\"".to_owned(),
        ),
        true => {
            let span = spans::places(case).get(index % per_row).map_or(0, |place| place.0);
            let own = case.spans.get(span).and_then(|span| span.section.as_ref());
            let rows = own.map_or("rows", |_| "section/bladders");
            let at = structure::span_pointer(case, span);
            let hint = format!("change {at}/{rows}, or name other bladders; numbers count segments");
            (format!("{at} has none in this row"), hint)
        }
    })
}

/// The bladders of a case: `2 to 4 and 6 (upper row), -1 to -9 (lower row)`.
pub fn existing(case: &Case) -> String {
    let per_row = case.segments();
    let there = spans::bladders(case);
    let row = |row: usize| {
        let mut ranges: Vec<[usize; 2]> = vec![];
        for index in (row * per_row..(row + 1) * per_row).filter(|index| there(*index)) {
            match ranges.last_mut().filter(|range| range[1] + 1 == index) {
                Some(range) => range[1] = index,
                None => ranges.push([index, index]),
            }
        }
        let labels = BladderLabels::from_case(case);
        let label = |index| labels.label(index);
        let ranges = ranges.into_iter().map(|[first, last]| match first == last {
            true => label(first).to_string(),
            false => format!("{} to {}", label(first), label(last)),
        });
        ranges.collect::<Vec<_>>().join(" and ")
    };
    let rows = [(row(0), "upper"), (row(1), "lower")];
    let rows = rows.into_iter().filter(|(ranges, _)| !ranges.is_empty());
    let rows: Vec<String> = rows.map(|(ranges, name)| format!("{ranges} ({name} row)")).collect();
    rows.join(", ")
}

/// Sentences about a bladder that a case does not have.
pub fn missing(case: &Case, number: i64) -> String {
    let cause = absence(case, number).map_or(String::new(), |(cause, _)| format!(": {cause}"));
    let label = BladderLabels::from_case(case).of_number(number);
    format!(
        "there is no bladder {label}{cause}. The case has bladders {}",
        existing(case)
    )
}
