//! Page of many designs.

use serde_json::{Value, json};

use super::{FolderKind, MOST_ROWS, Page, Place, StoredResult, base64, capital};
use crate::error::Result;
use crate::output::columns::if_any;
use crate::output::folder::{CASE, REPORT};
use crate::output::sweep::text::{kinds, several};
use crate::output::sweep::{
    CASES, FOLDERS, JOURNAL, JournalSummary, TABLE, about, numbered, pictures, table, warnings,
};
use crate::results::sweep::{Sweep, SweepPlan};
use crate::study::sweep::plan::SweepAxis;

/// Largest number of columns of the page's table; the file contains the rest.
const MOST_COLUMNS: usize = 40;

/// Page of `sweep`.
pub fn data(place: &Place) -> Result<Page> {
    // a sweep that was killed has no table yet
    let StoredResult { result: mut plan, head } = place.result::<SweepPlan>(FolderKind::Designs.sign())?;
    // commands on the page refer to its own folder, which contains the case
    if let [case] = &mut plan.cases[..]
        && place.path(CASE).is_file()
    {
        case.file = CASE.into();
    }
    let survey = JournalSummary::read(&place.path(JOURNAL), &plan)?;
    let found = about(&plan, &survey);
    let mut page = place.page(FolderKind::Designs, &plan.title(), Some(&head));
    page.warnings = warnings(&plan, &survey)?;
    let kinds = kinds(found.statuses.iter().map(|(status, n)| (&**status, n)));
    let missing = match found.missing {
        0 => String::new(),
        1 => " 1 design is missing; the same command computes it.".into(),
        n => format!(" {} are missing; the same command computes them.", several(n)),
    };
    let spec = |axis: &SweepAxis| format!("{} = {}", axis.pointer, axis.spec.as_deref().unwrap_or("as listed"));
    let cases = plan.cases.iter().map(|case| format!("case {}", case.name));
    // a lean folder has no pictures
    let drawn = pictures::draw(&plan, &survey)?;
    let figure = |title: &str, file: &str, about: &str| {
        let own = || drawn.iter().find(|(name, _)| *name == file);
        let picture = place
            .picture(file)
            .or_else(|| Some(base64::svg(own()?.1.as_bytes()).into()))?;
        Some(json!({"title": title, "picture": picture, "about": about}))
    };
    let figures = [
        figure(
            "Along what is varied",
            "sweep.svg",
            "Designs that finished. Every ring is one of them; its number stands beside it where there is room, and in the table. Modes that change places are not joined.",
        ),
        figure("Over two numbers", "map.svg", "Each cell is a design that finished."),
    ];
    let facts = plan.axes.iter().map(spec).chain(cases).map(|text| capital(&text));
    page.fill(json!({
        "label": "Many designs",
        "answer": format!("{} went through {}: {kinds}.{missing}", several(found.rows), plan.command.word()),
        "facts": facts.collect::<Vec<_>>(), "figures": figures.into_iter().flatten().collect::<Vec<_>>(),
        "table": rows(place, &found, &survey)?, "command": plan.command_line(&[]),
    }));
    Ok(page)
}

/// Table of the designs. Each design links to its page or case, if kept, and has the command that repeats it.
fn rows(place: &Place, found: &Sweep, survey: &JournalSummary) -> Result<Value> {
    let plan = &found.plan;
    let columns = found.columns.len().min(MOST_COLUMNS);
    let mut rows: Vec<Vec<Value>> = vec![];
    let mut leads = serde_json::Map::new();
    survey.each(|row| {
        if rows.len() < MOST_ROWS {
            let cells = table::cells(plan, survey, &row)
                .into_iter()
                .zip(&found.columns)
                .take(columns);
            let value = |(text, column): (String, &crate::results::sweep::SweepColumn)| match column.array {
                Some(_) => text.parse::<f64>().map_or(Value::from(text), Value::from),
                None => Value::from(text),
            };
            rows.push(cells.map(value).collect());
            let name = numbered(plan, row.number);
            let kept = [format!("{FOLDERS}/{name}/{REPORT}"), format!("{CASES}/{name}.json")];
            let file = kept.into_iter().find(|file| place.path(file).is_file());
            let lead = json!({"file": file, "command": plan.design_line(&row)});
            leads.insert(row.number.to_string(), lead);
        }
        Ok(())
    })?;
    let narrow = if_any(found.columns.len() - columns, |n| {
        format!(" {n} more columns are in the file.")
    });
    Ok(json!({
        "title": "Every design",
        "about": format!(
            "Figures as in the result of one case; NAME.error is the estimated error of NAME, relative. The number of a design links to its \
             files; the button beside it copies the command that computes this design alone.{narrow}"
        ),
        "headings": found.columns.iter().take(columns).map(|column| &column.name).collect::<Vec<_>>(),
        "left_out": found.rows - rows.len(), "rows": rows, "file": TABLE, "leads": leads,
    }))
}
