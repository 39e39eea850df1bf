//! `slcbeam verify`: comparison of computed with exact results.

use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use serde_json::Value;

use super::arguments::VerifyArguments;
use super::{interrupt, progress_line, terminal};
use crate::error::Result;
use crate::numerics::threads;
use crate::output::columns;
use crate::output::numbers::significant;
use crate::results;
use crate::results::verify::{VerifiedFigure, VerifiedRow};
use crate::study::verify::{self, ErrorMeasure};

/// Computes all rows, or those whose name contains the requested one, and prints them as a table.
pub fn verify(asked: &VerifyArguments) -> Result<ExitCode> {
    let flag = asked.wall.flag();
    if asked.paper {
        return super::paper::paper(asked.json);
    }
    let rows = match &asked.name {
        Some(name) => verify::choose(verify::rows(), name)?,
        None => verify::rows(),
    };
    let bar = progress_line::styled("{pos}/{len} {wide_bar} {msg}");
    bar.set_length(rows.len() as u64);
    if threads::granted() {
        bar.enable_steady_tick(Duration::from_millis(200));
    }
    let count = rows.len();
    let rows: Vec<VerifiedRow> = rows
        .iter()
        .map_while(|row| {
            bar.set_message(row.name.clone());
            let found = VerifiedRow::new(row, &row.figures());
            bar.inc(1);
            // an interrupted row has no answer
            (!interrupt::raised(&flag)).then_some(found)
        })
        .collect();
    bar.finish_and_clear();
    if rows.len() < count {
        terminal::print_line(&format!("slcbeam: interrupted after {} of {count} results", rows.len()));
    }
    super::print(&if asked.json {
        format!("{:#}\n", rows.iter().map(results::value).collect::<Value>())
    } else {
        table(&rows)
    })?;
    Ok(ExitCode::from(exit_code(&rows)))
}

fn exit_code(rows: &[VerifiedRow]) -> u8 {
    if !rows.is_empty() && rows.iter().all(|row| row.passed) {
        0
    } else {
        4
    }
}

const HEADINGS: &str =
    "<name | <quantity | <computed | <exact | <error | <tolerance | <order | <limit | <estimate | <verdict";

fn table(rows: &[VerifiedRow]) -> String {
    let mut lines = vec![];
    for row in rows {
        lines.extend(row.figures.iter().flatten().map(|figure| line(row, figure)));
        if let Some(failure) = &row.failure {
            let mut failed = [const { String::new() }; 10];
            failed[0].clone_from(&row.name);
            failed[1].clone_from(failure);
            failed[9] = "FAIL".into();
            lines.push(failed);
        }
    }
    let mut text = columns::table(HEADINGS, lines);
    text += "\nerror: r relative, a absolute; order: observed in the mesh size between the two finest of three \
             meshes;\nlimit: error of the Richardson extrapolation; estimate: error estimated from the meshes \
             alone\n\nsources\n";
    for row in rows {
        let _ = writeln!(
            text,
            "  {}: {}\n    tolerance: {}",
            row.name, row.source, row.tolerance_reason
        );
    }
    let passed = rows.iter().filter(|row| row.passed).count();
    let _ = writeln!(text, "\n{passed} of {} exact results reproduced", rows.len());
    text
}

fn line(row: &VerifiedRow, figure: &VerifiedFigure) -> [String; 10] {
    let sign = match figure.error_is {
        ErrorMeasure::Relative => 'r',
        ErrorMeasure::Absolute => 'a',
    };
    let or_nothing = |x: Option<f64>, shown: fn(f64) -> String| x.map_or_else(String::new, shown);
    [
        row.name.clone(),
        figure.quantity.clone(),
        significant(figure.computed, 9),
        significant(figure.exact, 9),
        format!("{:.1e} {sign}", figure.error),
        format!("{:.1e}", figure.tolerance),
        or_nothing(figure.order, |order| format!("{order:.2}")),
        or_nothing(figure.limit_error, |error| format!("{error:.1e}")),
        or_nothing(figure.estimate, |error| format!("{error:.1e}")),
        if figure.passed { "pass" } else { "FAIL" }.into(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::usage;
    use crate::study::verify::ExactFigure;

    fn row(figures: Result<Vec<ExactFigure>>) -> VerifiedRow {
        let row = verify::SolvedProblem::new("row", ["source", "goal", "reason"], || Ok(vec![]));
        VerifiedRow::new(&row, &figures)
    }

    /// Goal: rows that miss their tolerance, fail to run or compute nothing end the command with 4, and the table names them.
    #[test]
    fn failures_are_reported() {
        let good = || row(Ok(vec![ExactFigure::relative("x", 1.0, 1.0, 1e-9)]));
        assert_eq!(exit_code(&[good()]), 0);
        let missed = row(Ok(vec![ExactFigure::relative("x", 1.1, 1.0, 1e-9)]));
        let failed = row(usage("it broke"));
        for bad in [missed, failed, row(Ok(vec![]))] {
            assert_eq!(exit_code(&[good(), bad]), 4);
        }
        let text = table(&[good(), row(usage("it broke"))]);
        assert!(
            text.contains("it broke") && text.contains("FAIL") && text.contains("1 of 2 exact"),
            "{text}"
        );
    }
}
