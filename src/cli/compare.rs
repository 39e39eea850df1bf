//! `slcbeam compare`: results side by side, or a run over measured data.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use serde_json::Value;

use super::arguments::{CompareArguments, parse_all};
use super::{compare_responses, terminal};
use crate::case;
use crate::error::{Error, Result, usage};
use crate::output::columns::{self, aligned};
use crate::output::folder::{CASE, replace_alike};
use crate::output::kind::FolderKind;
use crate::output::numbers::{percent, quantity, significant};
use crate::output::report::WrittenPage;
use crate::output::{comparison as recordings, fit, reading, report, response};
use crate::results;
use crate::study::compare::changes::Change;
use crate::study::compare::difference::Difference;
use crate::study::compare::{Comparison, ManyComparison, Recording};
use crate::study::data::{DataTable, Match};
use crate::study::fit::comparison;

/// Largest number of changes shown of each kind; the rest is counted.
const CHANGES: usize = 8;

/// Largest number of folders; more columns would be unreadable.
const MOST: usize = 40;

/// Reads and compares the folders, draws on request, prints.
pub fn compare(asked: &CompareArguments) -> Result<ExitCode> {
    if let Some(page) = asked.out.as_deref().filter(|path| ends(path, "html") && !path.is_dir()) {
        return usage(format!(
            "--out {}: a page is report.html in a folder of its own; name the folder, such as {}",
            page.display(),
            page.with_extension("").display()
        ));
    }
    if !asked.matches.is_empty() {
        return with_data(asked);
    }
    let other = |one: &&PathBuf| one.is_file() && one.extension().is_none_or(|x| x != "json");
    if let Some(file) = asked.results.iter().find(other) {
        return usage(format!(
            "{} is a file; data are compared with --match COLUMN=QUANTITY[@PLACE], such as angle_deg=tip_angle",
            file.display()
        ));
    }
    if asked.results.iter().all(|one| one.join(response::JSON).is_file()) {
        return compare_responses::compare(asked);
    }
    if let Some(what) = asked.results.iter().find_map(|one| FolderKind::no_run(one)) {
        return usage(what);
    }
    if asked.results.len() > MOST {
        return usage(format!("{} folders: at most {MOST} at once", asked.results.len()));
    }
    let reference = match &asked.with {
        None => 0,
        Some(one) => match asked.results.iter().position(|own| same(own, one)) {
            Some(place) => place,
            None => {
                return usage(format!(
                    "--with {}: it is not one of the compared folders",
                    one.display()
                ));
            }
        },
    };
    let all = asked
        .results
        .iter()
        .map(|dir| recording(dir))
        .collect::<Result<Vec<_>>>()?;
    let found = ManyComparison::new(&all, reference);
    let written = asked.out.as_ref().map_or(Ok(()), |path| {
        if picture(path) {
            let [one] = found.comparisons.as_slice() else {
                return usage(format!(
                    "--out {}: a picture shows two results only; name a folder for a page of all results",
                    path.display()
                ));
            };
            let other = usize::from(reference == 0);
            let text = recordings::picture(&all[reference], &all[other], one)
                .ok_or_else(|| Error::Usage("nothing to draw: the two have no quantity in common".into()))?;
            replace_alike(path, &text, &["<svg", "<?xml"])
        } else {
            report::compared(path, &all, reference, &found).map(|page| announce(asked, &page))
        }
    });
    match found.comparisons.as_slice() {
        [one] => answer(asked, written, || results::value(one), || table(one)),
        _ => answer(asked, written, || results::value(&found), || several(&found)),
    }
}

/// Reads the result of a run, or of a cycle, which is a run over one period.
fn recording(dir: &Path) -> Result<Recording> {
    FolderKind::wanted("compare", dir, &[FolderKind::Run, FolderKind::Cycle])?;
    Ok(reading::read(dir)?.without_gaps())
}

/// True if two paths name one folder.
pub(super) fn same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| std::fs::canonicalize(path).ok();
    a == b || whole(a).is_some_and(|a| whole(b) == Some(a))
}

/// True if a path is that of a picture.
pub(super) fn picture(path: &Path) -> bool {
    ends(path, "svg")
}

fn ends(path: &Path, with: &str) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(with))
}

/// Table with a column per result.
fn several(found: &ManyComparison) -> String {
    let letter = |k: usize| match u8::try_from(k) {
        Ok(k) if k < 26 => char::from(b'A' + k).to_string(),
        _ => format!("R{}", k + 1),
    };
    let mut text = String::new();
    for (k, folder) in found.folders().into_iter().enumerate() {
        let _ = writeln!(text, "{}  {folder}", letter(k));
    }
    for (k, one) in found.comparisons.iter().enumerate() {
        let _ = writeln!(
            text,
            "\n{} beside A: both cover {} to {}",
            letter(k + 1),
            quantity(one.from_s, "s", 4),
            quantity(one.to_s, "s", 4)
        );
        for (words, list) in [
            ("another problem", &one.physics),
            ("computed differently", &one.numerics),
        ] {
            if !list.is_empty() {
                text += &format!("{words}\n");
                changes(&mut text, list);
            }
        }
    }
    for remark in found.remarks() {
        let _ = writeln!(text, "\n{remark}");
    }
    let letters: Vec<String> = (1..=found.comparisons.len()).map(letter).collect();
    let letters = letters.join(" | ");
    let mut lines: Vec<Vec<String>> = vec![];
    for (name, norms) in found.norms() {
        let cells = norms
            .iter()
            .map(|x| x.map_or_else(|| "-".into(), |x| format!("{x:.1e}")));
        lines.push([name].into_iter().chain(cells).collect());
    }
    let headings = format!("<root mean square of the difference from A, over that of the larger | {letters}");
    text += &format!("\n{}", columns::table(&headings, lines));
    let mut lines: Vec<Vec<String>> = vec![];
    for figure in found.figures() {
        let cells = figure.others.iter().map(|one| match one {
            Some((value, Some(change))) => format!("{} ({})", significant(*value, 5), signed_percent(*change)),
            Some((value, None)) => significant(*value, 5),
            None => "-".into(),
        });
        let first = [figure.name.clone(), significant(figure.reference, 5)];
        lines.push(first.into_iter().chain(cells).collect());
    }
    text += &format!(
        "\n{}in brackets: the difference from A over the size of A's figure\n",
        columns::table(&format!("<figure | A | {letters}"), lines)
    );
    text
}

/// Compares a run with measured data.
fn with_data(asked: &CompareArguments) -> Result<ExitCode> {
    let matches = parse_all(&asked.matches, Match::parse)?;
    let [folder, data] = asked.results.as_slice() else {
        return usage(format!(
            "--match: one result folder and one file of data, not {} of them",
            asked.results.len()
        ));
    };
    let table = DataTable::read(data)?;
    let run = recording(folder)?;
    let case = case::load(&folder.join(CASE), &[]).ok();
    let name = data.display().to_string();
    let found = comparison::compare(&run, case.as_ref(), &table, &name, &matches, asked.time.as_deref())?;
    let written = asked.out.as_ref().map_or(Ok(()), |path| {
        let curve = |name: &str| {
            let column = run.column(name).into_iter();
            column
                .flat_map(|c| run.times.iter().copied().zip(c.values.iter().copied()))
                .collect()
        };
        let text = fit::picture(&found, curve).ok_or_else(|| Error::Usage("nothing to draw".into()))?;
        if picture(path) {
            replace_alike(path, &text, &["<svg", "<?xml"])
        } else {
            report::over_data(path, &text, &found).map(|page| announce(asked, &page))
        }
    });
    answer(asked, written, || results::value(&found), || fit::comparison(&found))
}

/// Names the page of a comparison.
fn announce(asked: &CompareArguments, page: &WrittenPage) {
    if !asked.json {
        terminal::print_line(&format!("page: {}", page.path.display()));
    }
}

/// Prints a comparison, also after an error of writing.
pub(super) fn answer(
    asked: &CompareArguments,
    written: Result<()>,
    value: impl FnOnce() -> Value,
    text: impl FnOnce() -> String,
) -> Result<ExitCode> {
    match written {
        Err(error) if !matches!(error, Error::Output { .. }) => Err(error),
        written => super::answer(asked.json, value, text).and_then(|code| written.map(|()| code)),
    }
}

fn table(found: &Comparison) -> String {
    let mut text = format!("A  {}\nB  {}\n", found.folders[0], found.folders[1]);
    let _ = writeln!(
        text,
        "both cover {} to {}\n",
        quantity(found.from_s, "s", 4),
        quantity(found.to_s, "s", 4)
    );
    for remark in &found.remarks {
        let _ = writeln!(text, "{remark}\n");
    }
    if !found.physics.is_empty() {
        text += "the two cases differ in physics; their difference is not an error of either\n";
        changes(&mut text, &found.physics);
    }
    if !found.numerics.is_empty() {
        text += "computed differently\n";
        changes(&mut text, &found.numerics);
    }
    let histories = found.histories.iter().chain(&found.fields).map(line);
    let second = ["quantity", "L2", "max", "time [s]", "place", "adds at most"].map(String::from);
    let headings = "< | relative to | the larger | largest at |  | interpolation";
    text += &columns::table(headings, [second].into_iter().chain(histories));
    let figures = found.figures.iter().map(|f| {
        let change = f.change.map_or_else(|| "-".into(), signed_percent);
        let of_largest = format!("{:.1e}", f.relative);
        let within = match f.is_within_errors() {
            Some(true) => "yes",
            Some(false) => "no",
            None => "-",
        };
        [
            significant(f.a, 6),
            significant(f.b, 6),
            change,
            of_largest,
            within.into(),
        ]
    });
    let names = found.figures.iter().map(|f| &f.name);
    let headings = "<figure | A | B | (B − A)/|A| | |B − A| over the quantity's largest | within error bars";
    text += &beside(headings, names, figures);
    let costs = found.costs.iter().map(|c| {
        let ratio = if c.a > 0.0 {
            significant(c.b / c.a, 3)
        } else {
            "-".into()
        };
        [number(c.a), number(c.b), ratio]
    });
    text += &beside("<cost | A | B | B / A", found.costs.iter().map(|c| &c.name), costs);
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

/// Formats a change in percent, with its sign.
fn signed_percent(share: f64) -> String {
    let sign = if share > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(share))
}

/// Table of the numbers of both results, with a name per line.
fn beside<'a, const M: usize>(
    headings: &str,
    names: impl Iterator<Item = &'a String>,
    numbers: impl Iterator<Item = [String; M]>,
) -> String {
    let line = |(name, numbers): (&String, [String; M])| [std::slice::from_ref(name), &numbers[..]].concat();
    format!("\n{}", columns::table(headings, names.zip(numbers).map(line)))
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
