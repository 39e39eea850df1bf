//! Page of an optimum.

use serde_json::{Value, json};

use super::{FolderKind, Page, Place, cells};
use crate::error::Result;
use crate::output::numbers::{duration, percent, quantity, significant};
use crate::output::optimum::{BEST, CSV, PICTURE, place as position, ranked};
use crate::output::sweep::text::several;
use crate::output::sweep::unit;
use crate::results::optimum::{DerivativeSource, Optimum, Variable};
use crate::study::sweep::plan::quoted;

/// Page of `optimize`.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Optimum>(FolderKind::Optimum, |found| (&found.case, &found.warnings))?;
    let goal = &found.goal;
    // a figure with its unit
    let figure = |value: f64| quantity(value, unit(&goal.figure), 5);
    let begin = found
        .begin
        .map_or(String::new(), |begin| format!(", {} at first", figure(begin)));
    let mut facts = vec![
        several(found.evaluations),
        match found.derivatives {
            DerivativeSource::Exact => "exact derivatives".into(),
            DerivativeSource::Differences => "derivatives by differences".into(),
        },
        match found.starts.len() {
            1 => "one search".into(),
            n => format!("{n} searches"),
        },
        format!("found in {}", duration(found.wall_s)),
    ];
    if let Some(error) = found.error.filter(|_| found.value != 0.0) {
        let words = percent(error / found.value.abs());
        facts.insert(0, format!("estimated error of the simulation {words}"));
    }
    let tile = |one: &Variable| {
        let note = match one.within_1_percent {
            Some(_) => format!("1 % worse at {}", position(one)),
            None => position(one),
        };
        json!({"label": one.pointer, "value": significant(one.value, 5), "note": note})
    };
    let alternatives = ranked(&found);
    let alternatives = alternatives.iter();
    let alternatives = alternatives.map(|one| json!([one.name, one.value, null, null, null, null, null, null]));
    let numbers = found.variables.iter().map(|one| {
        let [below, above] = [0, 1].map(|k| one.within_1_percent.map(|w| w[k]));
        let numbers = [one.value, one.start, one.low, one.high].map(Value::from);
        let others = [below, above, one.gain].map(|x| json!(x));
        cells([json!(one.pointer)], numbers.into_iter().chain(others))
    });
    let limits = found.limits.iter().map(|one| {
        let bound = quantity(one.limit.bound, unit(&one.limit.figure), 6);
        let words = format!("{} {} {bound}", one.limit.figure, one.limit.sign());
        let gain = one.gain.filter(|_| one.reached);
        json!([words, one.value, null, null, null, null, null, gain])
    });
    let sought = if goal.largest { "largest" } else { "least" };
    let command = found.command.word();
    page.fill(json!({
        "label": "The best between bounds",
        "answer": format!("The {sought} {} of `slcbeam {command}` is {}{begin}; the case with the best numbers is {BEST}.",
                   goal.figure, figure(found.value)),
        "facts": facts, "tiles": found.variables.iter().map(tile).collect::<Vec<_>>(),
        "figures": [{
            "title": "The way to the best", "picture": place.picture(PICTURE),
            "about": "Rings are designs that were computed, in their order and over each number; faint ones are beyond a limit. The large ring \
                      is the best.",
        }],
        "table": {
            "title": "Numbers, limits and alternatives",
            "about": format!("In the unit that each key names; alternatives by {}{}. The last column is the gain of the figure if the bound or limit is relaxed by one unit.", goal.figure, bracketed(&goal.figure)),
            "headings": ["number, limit or alternative", "at the best", "at first", "from", "to", "1 % worse below", "1 % worse above", "gain per unit"],
            "rows": numbers.chain(limits).chain(alternatives).collect::<Vec<_>>(), "file": CSV,
        },
        "command": format!("slcbeam {command} {BEST}{}", options(&found)),
    }));
    Ok(page)
}

/// Options of the command, each after a blank.
fn options(found: &Optimum) -> String {
    let options = found.command.options();
    options.iter().map(|word| format!(" {}", quoted(word))).collect()
}

/// Unit of a figure in brackets; empty if dimensionless.
fn bracketed(figure: &str) -> String {
    match unit(figure) {
        "1" => String::new(),
        unit => format!(" [{unit}]"),
    }
}
