//! Page of `sense`: loads from pressures.

use serde_json::json;

use super::{FolderKind, Page, Place, cells};
use crate::error::Result;
use crate::output::numbers::{counted, significant};
use crate::output::sense as files;
use crate::results::sense::Sensed;

/// Data of the page.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Sensed>(FolderKind::Sense, |found| (&found.case, &found.warnings))?;
    let mut facts = vec![counted(found.bladders.len() as u64, "bladder")];
    if !found.rows.is_empty() {
        facts.push(counted(found.rows.len() as u64, "row") + " of measurements");
    }
    if let Some(sd) = found.noise.as_ref().and_then(|noise| noise.sd_pa) {
        facts.push(format!("noise {} Pa", significant(sd, 3)));
    }
    let sight = files::about_sight(&found).replace("\n  ", "; ").trim_end().to_owned();
    let noise = files::about_noise(&found).replace('\n', "; ");
    let errors = found.amplitudes.iter().map(|a| format!("{} [{}]", a.name, a.unit));
    let headings = ["sensors".into(), "bladders".into()].into_iter().chain(errors);
    let table = match found.rows.is_empty() {
        false => {
            let (headings, rows) = files::table(&found);
            json!({
                "title": "Loads", "about": format!("Each load with half of its band; {}.", files::about_band(&found).trim_end_matches('.')),
                "headings": headings, "rows": rows, "file": files::CSV,
            })
        }
        true => json!({
            "title": "Which bladders to measure",
            "about": format!("The best sets of every size, and the standard errors of the loads for a noise of {} Pa.",
                      significant(found.choice_noise_pa, 3)),
            "headings": headings.collect::<Vec<String>>(),
            "rows": found.choice.iter().map(|one| {
                let first = [json!(one.bladders.len()), json!(files::list(&one.bladders))];
                cells(first, one.errors.iter().map(|error| json!(error)))
            }).collect::<Vec<_>>(),
            "file": files::SENSORS,
        }),
    };
    page.fill(json!({
        "label": "Loads from pressures", "answer": files::answer(&found), "facts": facts,
        "figures": [{
            "title": "Loads and pressures", "picture": place.picture(files::PICTURE), "about": format!("{sight}. {noise}"),
        }],
        "table": table, "command": found.command,
    }));
    Ok(page)
}
