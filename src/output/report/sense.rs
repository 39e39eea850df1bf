//! The page of `sense`: loads from pressures.

use serde_json::json;

use super::{Found, Kind, Page, Place};
use crate::error::Result;
use crate::output::numbers::{counted, significant};
use crate::output::sense as files;
use crate::results::sense::Sensed;

/// Everything the page shows.
pub fn data(place: &Place) -> Result<Page> {
    let Found { result: found, head } = place.result::<Sensed>(files::JSON)?;
    let mut page = place.page(Kind::Sense, &found.case, Some(&head));
    page.put("label", "Loads from pressures");
    page.put("answer", files::answer(&found));
    page.warnings.clone_from(&found.warnings);
    let mut facts = vec![counted(found.bladders.len() as u64, "bladder")];
    if !found.rows.is_empty() {
        facts.push(counted(found.rows.len() as u64, "row") + " of measurements");
    }
    if let Some(sd) = found.noise.as_ref().and_then(|noise| noise.sd_pa) {
        facts.push(format!("noise {} Pa", significant(sd, 3)));
    }
    page.put("facts", facts);
    let sight = files::about_sight(&found).replace("\n  ", "; ").trim_end().to_owned();
    let noise = files::about_noise(&found).replace('\n', "; ");
    page.put(
        "figures",
        json!([{
            "title": "Loads and pressures",
            "picture": place.picture(files::PICTURE),
            "about": format!("{sight}. {noise}"),
        }]),
    );
    let (headings, rows) = files::table(&found);
    if !found.rows.is_empty() {
        page.put(
            "table",
            json!({
                "title": "Loads", "about": format!("Each load with half of its band; {}.", files::about_band(&found).trim_end_matches('.')),
                "headings": headings, "rows": rows, "file": files::CSV,
            }),
        );
    } else {
        let errors = found.amplitudes.iter().map(|a| format!("{} [{}]", a.name, a.unit));
        let headings: Vec<String> = ["sensors".into(), "bladders".into()]
            .into_iter()
            .chain(errors)
            .collect();
        let rows = found.choice.iter().map(|one| {
            let mut row = vec![json!(one.bladders.len()), json!(files::list(&one.bladders))];
            row.extend(one.errors.iter().map(|error| json!(error)));
            row
        });
        page.put(
            "table",
            json!({
                "title": "Which bladders to measure",
                "about": format!("The best sets of every size, and the standard errors of the loads for a noise of {} Pa.",
                          significant(found.choice_noise_pa, 3)),
                "headings": headings, "rows": rows.collect::<Vec<_>>(), "file": files::SENSORS,
            }),
        );
    }
    page.put("command", &*found.command);
    Ok(page)
}
