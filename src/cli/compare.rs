//! `slcbeam compare`: two results side by side, or a run over measured data.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::Value;

use super::arguments::CompareArguments;
use crate::case;
use crate::error::{Error, Result};
use crate::output::columns::aligned;
use crate::output::folder::{CASE, replace_alike};
use crate::output::numbers::{percent, quantity, significant};
use crate::output::{comparison, fit, reading};
use crate::results;
use crate::study::compare::changes::Change;
use crate::study::compare::difference::Difference;
use crate::study::compare::{Comparison, compare as differences};
use crate::study::data::{Match, Table};
use crate::study::fit::beside;

/// Changes shown of each kind; the rest is counted.
const CHANGES: usize = 8;

/// Reads both folders, compares, draws when asked, prints.
pub fn compare(asked: &CompareArguments) -> Result<ExitCode> {
    if !asked.matches.is_empty() {
        return with_data(asked);
    }
    if asked.b.is_file() {
        return Err(Error::Usage(format!(
            "{} is a file; data are compared with --match COLUMN=QUANTITY[@PLACE], such as angle_deg=tip_angle",
            asked.b.display()
        )));
    }
    let a = reading::read(&asked.a)?.without_gaps();
    let b = reading::read(&asked.b)?.without_gaps();
    let found = differences(&a, &b);
    if let Some(path) = &asked.out {
        let text = comparison::picture(&a, &b, &found)
            .ok_or_else(|| Error::Usage("nothing to draw: the two have no quantity in common".into()))?;
        replace_alike(path, &text, &["<svg", "<?xml"])?;
    }
    if asked.json {
        super::print(&results::text(&found))?;
    } else {
        super::print(&table(&found))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A run over measured data.
fn with_data(asked: &CompareArguments) -> Result<ExitCode> {
    let matches = asked
        .matches
        .iter()
        .map(|text| Match::parse(text))
        .collect::<Result<Vec<_>>>()?;
    let table = Table::read(&asked.b)?;
    let run = reading::read(&asked.a)?.without_gaps();
    let case = case::load(&asked.a.join(CASE), &[]).ok();
    let name = asked.b.display().to_string();
    let found = beside::compare(&run, case.as_ref(), &table, &name, &matches, asked.time.as_deref())?;
    if let Some(path) = &asked.out {
        let curve = |name: &str| {
            let column = run.column(name).into_iter();
            column
                .flat_map(|c| run.times.iter().copied().zip(c.values.iter().copied()))
                .collect()
        };
        let text = fit::picture(&found, curve).ok_or_else(|| Error::Usage("nothing to draw".into()))?;
        replace_alike(path, &text, &["<svg", "<?xml"])?;
    }
    super::print(&match asked.json {
        true => results::text(&found),
        false => fit::comparison(&found),
    })?;
    Ok(ExitCode::SUCCESS)
}

fn table(found: &Comparison) -> String {
    let mut text = format!("A  {}\nB  {}\n", found.folders[0], found.folders[1]);
    let _ = writeln!(
        text,
        "both cover {} to {}\n",
        quantity(found.from_s, "s", 4),
        quantity(found.to_s, "s", 4)
    );
    if !found.physics.is_empty() {
        text += "the two are not the same problem; their difference is no error of either\n";
        changes(&mut text, &found.physics);
    }
    if !found.numerics.is_empty() {
        text += "computed differently\n";
        changes(&mut text, &found.numerics);
    }
    let histories = found.histories.iter().chain(&found.fields).map(line);
    let headings = [
        ["", "relative to", "the larger", "largest at", "", "interpolation"],
        ["quantity", "L2", "max", "time [s]", "place", "adds at most"],
    ];
    let headings = headings.map(|line| line.map(String::from)).into_iter();
    text += &aligned(&headings.chain(histories).collect::<Vec<_>>(), &[0]);
    let figures = found.figures.iter().map(|f| {
        let change = f.change.map_or_else(|| "-".into(), signed_percent);
        let of_largest = format!("{:.1e}", f.relative);
        [significant(f.a, 6), significant(f.b, 6), change, of_largest]
    });
    let names = found.figures.iter().map(|f| &f.name);
    let headings = ["figure", "A", "B", "(B − A)/|A|", "|B − A| over the quantity's largest"];
    text += &beside(headings, names, figures);
    let costs = found.costs.iter().map(|c| {
        let ratio = if c.a > 0.0 {
            significant(c.b / c.a, 3)
        } else {
            "-".into()
        };
        [number(c.a), number(c.b), ratio]
    });
    text += &beside(["cost", "A", "B", "B / A"], found.costs.iter().map(|c| &c.name), costs);
    if !found.left_out.is_empty() {
        let _ = writeln!(text, "\nnot compared\n  {}", found.left_out.join("\n  "));
    }
    text
}

fn number(x: f64) -> String {
    if x.fract() == 0.0 {
        format!("{x:.0}")
    } else {
        significant(x, 4)
    }
}

/// A change as percent, with its sign.
fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// Numbers of both, a name a line.
fn beside<'a, const N: usize, const M: usize>(
    headings: [&str; N],
    names: impl Iterator<Item = &'a String>,
    numbers: impl Iterator<Item = [String; M]>,
) -> String {
    let line = |(name, numbers): (&String, [String; M])| [name.clone()].into_iter().chain(numbers).collect();
    let mut lines: Vec<Vec<String>> = vec![headings.iter().map(ToString::to_string).collect()];
    lines.extend(names.zip(numbers).map(line));
    format!("\n{}", aligned(&lines, &[0]))
}

fn line(d: &Difference) -> [String; 6] {
    [
        d.name.clone(),
        format!("{:.1e}", d.relative.l2),
        format!("{:.1e}", d.relative.max),
        significant(d.at_s, 6),
        d.place.map_or_else(|| "-".into(), |x| format!("{x:.3}")),
        if d.interpolation > 0.0 {
            format!("{:.1e}", d.interpolation)
        } else {
            "nothing".into()
        },
    ]
}

fn changes(text: &mut String, changes: &[Change]) {
    let short = |v: &Value| match v {
        Value::Null => "absent".to_string(),
        Value::Object(_) | Value::Array(_) => "...".to_string(),
        other => other.to_string(),
    };
    let line = |c: &Change| {
        [
            String::new(),
            c.pointer.clone(),
            format!("{} | {}", short(&c.a), short(&c.b)),
        ]
    };
    let lines: Vec<_> = changes.iter().take(CHANGES).map(line).collect();
    *text += &aligned(&lines, &[1, 2]);
    if changes.len() > CHANGES {
        let _ = writeln!(text, "  and {} more", changes.len() - CHANGES);
    }
    text.push('\n');
}
