//! Pages that compare several results with one of them, or one result with measured data.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::{FolderKind, Page, WrittenPage, base64, cells, page, warnings};
use crate::discrete::quantities::{Observable, QuantityRole};
use crate::error::{Result, usage};
use crate::output::folder::{REPORT, fault, replace_alike};
use crate::output::numbers::{percent, quantity};
use crate::study::compare::difference::Difference;
use crate::study::compare::many::column_at;
use crate::study::compare::{ManyComparison, Recording};
use crate::study::fit::comparison::{ComparedColumn, DataComparison as Data};

/// Largest number of instants shown of a history.
const INSTANTS: usize = 1500;

/// Writes the page into a folder, which is created if necessary; `reference` is the index of a result.
///
/// # Errors
/// The folder contains a result, another file is in the page's place, or the page cannot be written.
pub fn compared(dir: &Path, all: &[Recording], reference: usize, found: &ManyComparison) -> Result<WrittenPage> {
    let names = names(found);
    let name = format!("{} and {}", names[0], others(names.len() - 1));
    let mut page = begun("Results side by side", name);
    let folders = found.folders();
    let facts = folders
        .iter()
        .zip(&names)
        .map(|(folder, name)| format!("{name}: {folder}"));
    let facts = facts.chain(found.remarks().into_iter().map(String::from));
    page.fill(json!({
        "answer": answer(found, &names), "warnings": warnings::groups(&[]), "facts": facts.collect::<Vec<_>>(),
        "tables": tables(found, &names),
    }));
    let order = || {
        std::iter::once(&all[reference]).chain(all.iter().enumerate().filter(|(k, _)| *k != reference).map(|(_, r)| r))
    };
    if let Some(overlay) = overlay(&order().collect::<Vec<_>>(), &names) {
        page.put("overlay", overlay);
    }
    put(&page, dir)
}

/// Writes the page of a run over measured data into a folder, which is created if necessary; `picture` is an SVG.
///
/// # Errors
/// The folder contains a result, another file is in the page's place, or the page cannot be written.
pub fn over_data(dir: &Path, picture: &str, found: &Data) -> Result<WrittenPage> {
    let name = format!("{} over {}", found.case, file_name(&found.data));
    let mut page = begun("A run over measured data", name);
    let row = |one: &ComparedColumn| {
        let (left, matched) = (&one.left, one.matched.describe());
        let (rms, largest) = (100.0 * left.rms_relative, 100.0 * left.max_relative);
        let first = [json!(matched), json!(one.quantity), json!(one.unit), json!(left.count)];
        let numbers = [
            left.rms,
            left.max,
            one.max_at_s,
            left.bias,
            rms,
            largest,
            left.r_squared,
        ];
        cells(first, numbers.map(Value::from))
    };
    page.fill(json!({
        "facts": [format!("Run: {}", found.run), format!("Data: {}", found.data)],
        "figures": [{
            "title": "Data and run", "picture": base64::svg(picture.as_bytes()),
            "about": "Rings are measured, the line is the run. Below, run less data.",
        }],
        "table": {
            "title": "Run less data", "about": "In the unit of the quantity; percent are of the largest value of the data.",
            "headings": ["match", "quantity", "unit", "values", "rms", "largest", "at [s]", "bias", "rms [%]", "largest [%]", "R²"],
            "rows": found.columns.iter().map(row).collect::<Vec<_>>(),
        },
    }));
    put(&page, dir)
}

/// A page with kind, label and name.
fn begun(label: &str, name: String) -> Page {
    let mut page = Page {
        name: name.clone(),
        ..Page::default()
    };
    page.fill(json!({"kind": "comparison", "version": env!("CARGO_PKG_VERSION"), "label": label, "name": name}));
    page
}

fn put(page: &Page, dir: &Path) -> Result<WrittenPage> {
    if FolderKind::find("report on", dir).is_ok() {
        return usage(format!(
            "--out {}: the folder contains a result whose page would be overwritten; name another folder",
            dir.display()
        ));
    }
    fs::create_dir_all(dir).map_err(|e| fault("make", dir, e))?;
    let path = dir.join(REPORT);
    let text = page::assemble(page);
    replace_alike(&path, &text, &["<!doctype html"])?;
    Ok(WrittenPage {
        path,
        bytes: text.len(),
    })
}

/// Last part of a path.
fn file_name(path: &str) -> String {
    let name = Path::new(path).file_name();
    name.map_or_else(|| path.to_string(), |name| name.to_string_lossy().into_owned())
}

fn others(count: usize) -> String {
    match count {
        1 => "one other".into(),
        n => format!("{n} others"),
    }
}

/// Names of the results: the last part of each folder, or the full path if two end alike.
fn names(found: &ManyComparison) -> Vec<String> {
    let folders = found.folders();
    let all: Vec<String> = folders.iter().map(|folder| file_name(folder)).collect();
    let twice = |name: &String| all.iter().filter(|own| *own == name).count() > 1;
    let either = all
        .iter()
        .zip(&folders)
        .map(|(name, folder)| if twice(name) { (*folder).into() } else { name.clone() });
    either.collect()
}

/// Sentences about the largest differences, first among the headline quantities.
fn answer(found: &ManyComparison, names: &[String]) -> String {
    let headline = |d: &&Difference| Observable::named(&d.name).is_some_and(|one| one.role() == QuantityRole::Headline);
    let largest = |of: &dyn Fn(&&Difference) -> bool| {
        let all = found.comparisons.iter().zip(&names[1..]).flat_map(|(one, name)| {
            let histories = one.histories.iter().chain(&one.fields).filter(|d| of(d));
            histories.map(move |d| (d, name))
        });
        all.max_by(|a, b| a.0.relative.l2.total_cmp(&b.0.relative.l2))
    };
    let mut text = match largest(&headline) {
        None => "The results have no headline history in common.".into(),
        Some((most, _)) if most.relative.l2 == 0.0 => {
            format!("No quantity of those that matter most differs from {}.", names[0])
        }
        Some((most, name)) => format!(
            "Of the quantities that matter most, {} differs most from {} (in {name}): {} of its size over all instants, at most {} at {}.",
            most.name,
            names[0],
            percent(most.relative.l2),
            percent(most.relative.max),
            quantity(most.at_s, "s", 4)
        ),
    };
    if let (Some((all, name)), shown) = (largest(&|_| true), largest(&headline))
        && all.relative.l2 > shown.map_or(0.0, |(most, _)| most.relative.l2)
    {
        text += &format!(
            " Of all quantities, {} differs most (in {name}): {}.",
            all.name,
            percent(all.relative.l2)
        );
    }
    text
}

/// Histories of all results at the output times of the first.
fn overlay(all: &[&Recording], names: &[String]) -> Option<Value> {
    let first = all.first()?;
    let every = first.times.len().div_ceil(INSTANTS).max(1);
    let times: Vec<f64> = first.times.iter().copied().step_by(every).collect();
    let quantities = first.columns.iter().filter_map(|column| {
        let values = all.iter().map(|one| column_at(one, &column.name, &times)).collect::<Vec<_>>();
        let there = values.iter().flatten().flatten().any(|x| x.is_finite() && *x != 0.0);
        let one = Observable::named(&column.name);
        there.then(|| {
            let none = vec![f64::NAN; times.len()];
            let packed = values.iter().map(|v| base64::numbers(v.as_ref().unwrap_or(&none).iter().copied()));
            json!({
                "name": column.name, "unit": column.unit, "label": one.map_or(column.name.as_str(), |one| one.label()),
                "about": one.map_or("", Observable::about), "usual": one.is_some_and(|one| one.role() == QuantityRole::Headline),
                "values": packed.collect::<Vec<_>>(),
            })
        })
    });
    let quantities: Vec<Value> = quantities.collect();
    let note = format!(
        "At the output times of {}{}; the others are interpolated by cubics, and drawn where they have been computed.",
        names[0],
        if every > 1 {
            format!(", one in {every}")
        } else {
            String::new()
        }
    );
    (times.len() > 1 && !quantities.is_empty()).then(|| {
        json!({"times": base64::numbers(times.iter().copied()), "runs": names, "quantities": quantities, "note": note})
    })
}

fn tables(found: &ManyComparison, names: &[String]) -> Vec<Value> {
    let columns = |first: &[&str], each: &dyn Fn(&String) -> Vec<String>| -> Vec<String> {
        let first = first.iter().map(ToString::to_string);
        first.chain(names[1..].iter().flat_map(each)).collect()
    };
    let figures = found.figures();
    let figures = figures.iter().map(|figure| {
        let cells = figure.others.iter().flat_map(|one| match one {
            Some((value, change)) => [json!(value), json!(change.map(|x| 100.0 * x))],
            None => [Value::Null, Value::Null],
        });
        self::cells([json!(figure.name), json!(figure.reference)], cells)
    });
    let figures = figures.collect::<Vec<_>>();
    let norms = found.norms().into_iter();
    let norms = norms.map(|(name, norms)| cells([json!(name)], norms.into_iter().map(|x| json!(x))));
    let norms = norms.collect::<Vec<_>>();
    let changes = found.comparisons.iter().zip(&names[1..]).flat_map(|(one, name)| {
        let both = [("physics", &one.physics), ("numerics", &one.numerics)];
        both.into_iter().flat_map(move |(kind, list)| {
            list.iter()
                .map(move |change| json!([name, kind, change.pointer, word(&change.a), word(&change.b)]))
        })
    });
    let changes = changes.collect::<Vec<_>>();
    let costs = found.comparisons.first().map_or(&[][..], |one| &one.costs);
    let costs = costs.iter().enumerate().map(|(k, cost)| {
        let others = found.comparisons.iter();
        let others = others.map(|one| json!(one.costs.get(k).map(|cost| cost.b)));
        cells([json!(cost.name), json!(cost.a)], others)
    });
    let costs = costs.collect::<Vec<_>>();
    let alone = |name: &String| vec![name.clone()];
    let all = [
        (
            "Figures",
            format!(
                "A figure of each result; beside it its difference from {} in percent of that.",
                names[0]
            ),
            columns(&["figure", &names[0]], &|name| {
                vec![name.clone(), format!("{name}: change [%]")]
            }),
            figures,
        ),
        (
            "Differences of histories and fields",
            format!(
                "Root mean square of the difference from {} over all instants and places that both have, \
          over that of the larger of the two.",
                names[0]
            ),
            columns(&["quantity"], &alone),
            norms,
        ),
        (
            "What differs in the cases",
            format!(
                "Where physics differs, differences are no errors. The last two columns are {} and the other.",
                names[0]
            ),
            ["result", "of", "key", "there", "here"].map(String::from).to_vec(),
            changes,
        ),
        ("Cost", String::new(), columns(&["cost", &names[0]], &alone), costs),
    ];
    let all = all.into_iter().filter(|(.., rows)| !rows.is_empty());
    all.map(
        |(title, about, headings, rows)| json!({"title": title, "about": about, "headings": headings, "rows": rows}),
    )
    .collect()
}

/// A value of a case in a cell.
fn word(value: &Value) -> Value {
    match value {
        Value::Null => json!("absent"),
        Value::Object(_) | Value::Array(_) => json!("..."),
        other => json!(other.to_string()),
    }
}
