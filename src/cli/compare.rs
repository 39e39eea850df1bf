//! `slcbeam compare`: two results side by side.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde_json::Value;

use super::arguments::CompareArguments;
use crate::error::{Error, Result};
use crate::output::folder::replace_alike;
use crate::output::numbers::{quantity, significant};
use crate::output::{comparison, reading};
use crate::study::compare::changes::Change;
use crate::study::compare::difference::Difference;
use crate::study::compare::{Comparison, compare as differences};

/// Changes shown of each kind; the rest is counted.
const CHANGES: usize = 8;

/// Reads both folders, compares, draws when asked, prints.
pub fn compare(asked: &CompareArguments) -> Result<ExitCode> {
    let a = reading::read(&asked.a)?.without_gaps();
    let b = reading::read(&asked.b)?.without_gaps();
    let found = differences(&a, &b);
    if let Some(path) = &asked.out {
        let text = comparison::picture(&a, &b, &found)
            .ok_or_else(|| Error::Usage("nothing to draw: the two have no quantity in common".into()))?;
        replace_alike(path, &text, &["<svg", "<?xml"])?;
    }
    if asked.json {
        super::print(&format!("{:#}\n", serde_json::to_value(&found).unwrap_or_default()))?;
    } else {
        super::print(&table(&found))?;
    }
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
    text += "                       relative to the larger           largest at              interpolation\n\
             quantity                     L2       max           time [s]   place        adds at most\n";
    for d in found.histories.iter().chain(&found.fields) {
        line(&mut text, d);
    }
    text += "\nfigure                                        A             B       relative\n";
    for f in &found.figures {
        let _ = writeln!(
            text,
            "{:<36} {:>12}  {:>12}  {:>10.1e}",
            f.name,
            significant(f.a, 6),
            significant(f.b, 6),
            f.relative
        );
    }
    text += "\ncost                                          A             B          B / A\n";
    for c in &found.costs {
        let ratio = if c.a > 0.0 {
            significant(c.b / c.a, 3)
        } else {
            "-".into()
        };
        let _ = writeln!(
            text,
            "{:<36} {:>12}  {:>12}  {ratio:>10}",
            c.name,
            number(c.a),
            number(c.b)
        );
    }
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

fn line(text: &mut String, d: &Difference) {
    let place = d.place.map_or_else(|| "-".into(), |x| format!("{x:.3}"));
    let _ = writeln!(
        text,
        "{:<22} {:>9.1e} {:>9.1e}   {:>16}   {place:>5}  {:>18}",
        d.name,
        d.relative.l2,
        d.relative.max,
        significant(d.at_s, 6),
        if d.interpolation > 0.0 {
            format!("{:.1e}", d.interpolation)
        } else {
            "nothing".into()
        }
    );
}

fn changes(text: &mut String, changes: &[Change]) {
    let short = |v: &Value| match v {
        Value::Null => "absent".to_string(),
        Value::Object(_) | Value::Array(_) => "...".to_string(),
        other => other.to_string(),
    };
    for c in changes.iter().take(CHANGES) {
        let _ = writeln!(text, "  {:<34} {} | {}", c.pointer, short(&c.a), short(&c.b));
    }
    if changes.len() > CHANGES {
        let _ = writeln!(text, "  and {} more", changes.len() - CHANGES);
    }
    text.push('\n');
}
