//! `slcbeam verify`: exact results against computed ones.

use std::fmt::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};

use super::arguments::VerifyArguments;
use crate::error::Result;
use crate::output::numbers::significant;
use crate::study::verify::{self, Figure, Measure, Row};

/// A row with what came of it.
struct Verdict {
    row: Row,
    figures: Result<Vec<Figure>>,
}

impl Verdict {
    fn passed(&self) -> bool {
        self.figures
            .as_ref()
            .is_ok_and(|figures| !figures.is_empty() && figures.iter().all(Figure::passed))
    }
}

/// Computes all rows, or those whose name contains the name asked for, and prints them as a table.
pub fn verify(asked: &VerifyArguments) -> Result<ExitCode> {
    let rows = match &asked.name {
        Some(name) => verify::choose(verify::rows(), name)?,
        None => verify::rows(),
    };
    let bar = bar(rows.len());
    let verdicts: Vec<Verdict> = rows
        .into_iter()
        .map(|row| {
            bar.set_message(row.name.clone());
            let figures = row.figures();
            bar.inc(1);
            Verdict { row, figures }
        })
        .collect();
    bar.finish_and_clear();
    let text = if asked.json {
        json_text(&verdicts)
    } else {
        table(&verdicts)
    };
    super::print(&text)?;
    Ok(ExitCode::from(exit_code(&verdicts)))
}

fn exit_code(verdicts: &[Verdict]) -> u8 {
    if verdicts.iter().all(Verdict::passed) { 0 } else { 4 }
}

/// On a terminal alone.
fn bar(rows: usize) -> ProgressBar {
    use std::io::IsTerminal as _;
    let target = if std::io::stderr().is_terminal() {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(rows as u64), target);
    if let Ok(style) = ProgressStyle::with_template("{pos}/{len} {wide_bar} {msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn json_text(verdicts: &[Verdict]) -> String {
    let rows: Vec<Value> = verdicts
        .iter()
        .map(|verdict| {
            let Row {
                name,
                source,
                goal,
                reason,
                ..
            } = &verdict.row;
            let mut row = json!({
                "name": name, "source": source, "goal": goal, "tolerance_reason": reason, "passed": verdict.passed()
            });
            match &verdict.figures {
                Ok(figures) => row["figures"] = figures.iter().map(figure_json).collect(),
                Err(error) => row["failure"] = error.to_string().into(),
            }
            row
        })
        .collect();
    format!("{:#}\n", Value::from(rows))
}

fn figure_json(figure: &Figure) -> Value {
    json!({
        "quantity": figure.quantity, "computed": figure.computed, "exact": figure.exact,
        "error": figure.error(), "error_is": measure(figure), "tolerance": figure.tolerance, "order": figure.order,
        "limit_error": figure.limit.map(|l| l.0), "limit_tolerance": figure.limit.map(|l| l.1),
        "passed": figure.passed()
    })
}

fn measure(figure: &Figure) -> &'static str {
    match figure.measure {
        Measure::Relative => "relative",
        Measure::Absolute => "absolute",
    }
}

const HEADINGS: [&str; 9] = [
    "name",
    "quantity",
    "computed",
    "exact",
    "error",
    "tolerance",
    "order",
    "limit",
    "verdict",
];

fn table(verdicts: &[Verdict]) -> String {
    let mut lines = vec![HEADINGS.map(String::from)];
    for verdict in verdicts {
        match &verdict.figures {
            Ok(figures) => lines.extend(figures.iter().map(|figure| line(&verdict.row, figure))),
            Err(error) => {
                let mut failed = [const { String::new() }; 9];
                failed[0].clone_from(&verdict.row.name);
                failed[1] = error.to_string();
                failed[8] = "FAIL".into();
                lines.push(failed);
            }
        }
    }
    let widths: [usize; 9] =
        std::array::from_fn(|k| lines.iter().map(|line| line[k].chars().count()).max().unwrap_or(0));
    let mut text = String::new();
    for line in &lines {
        let cells: Vec<String> = line
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
    text += "\nerror: r relative, a absolute; order: observed in the mesh size between the two finest of three meshes;\n\
             limit: error of the limit to which they point (Richardson)\n\nsources\n";
    for verdict in verdicts {
        let _ = writeln!(
            text,
            "  {}: {}\n    tolerance: {}",
            verdict.row.name, verdict.row.source, verdict.row.reason
        );
    }
    let passed = verdicts.iter().filter(|verdict| verdict.passed()).count();
    let _ = writeln!(text, "\n{passed} of {} exact results reproduced", verdicts.len());
    text
}

fn line(row: &Row, figure: &Figure) -> [String; 9] {
    let sign = &measure(figure)[..1];
    [
        row.name.clone(),
        figure.quantity.clone(),
        significant(figure.computed, 9),
        significant(figure.exact, 9),
        format!("{:.1e} {sign}", figure.error()),
        format!("{:.1e}", figure.tolerance),
        figure.order.map_or_else(String::new, |order| format!("{order:.2}")),
        figure
            .limit
            .map_or_else(String::new, |(error, _)| format!("{error:.1e}")),
        if figure.passed() { "pass" } else { "FAIL" }.into(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    fn verdict(figures: Result<Vec<Figure>>) -> Verdict {
        Verdict {
            row: Row::new("row", ["source", "goal", "reason"], || Ok(vec![])),
            figures,
        }
    }

    /// Goal: rows that miss, fail to run or compute nothing end the command with 4, and the table says which.
    #[test]
    fn what_fails_is_told() {
        let good = || verdict(Ok(vec![Figure::relative("x", 1.0, 1.0, 1e-9)]));
        assert_eq!(exit_code(&[good()]), 0);
        let missed = verdict(Ok(vec![Figure::relative("x", 1.1, 1.0, 1e-9)]));
        let failed = verdict(Err(Error::Usage("it broke".into())));
        for bad in [missed, failed, verdict(Ok(vec![]))] {
            assert_eq!(exit_code(&[good(), bad]), 4);
        }
        let text = table(&[good(), verdict(Err(Error::Usage("it broke".into())))]);
        assert!(
            text.contains("it broke") && text.contains("FAIL") && text.contains("1 of 2 exact"),
            "{text}"
        );
    }
}
