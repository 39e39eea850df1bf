//! The page of a fit.

use serde_json::{Value, json};

use super::{Found, Kind, Page, Place};
use crate::error::Result;
use crate::output::fit::{CSV, FITTED, JSON, PICTURE};
use crate::output::numbers::{counted, duration, significant};
use crate::results::fit::{Bound, Estimate, Fit};

/// `fit`.
pub fn data(place: &Place) -> Result<Page> {
    let Found { result: found, head } = place.result::<Fit>(JSON)?;
    let mut page = place.page(Kind::Fit, &found.case, Some(&head));
    page.put("label", "Fitted to data");
    page.warnings.clone_from(&found.warnings);
    page.put(
        "answer",
        format!(
            "{} fitted to {} of {}; the case with the estimates is {FITTED}.",
            match found.parameters.len() {
                1 => "One number of the case was".into(),
                n => format!("{n} numbers of the case were"),
            },
            counted(found.observations as u64, "value"),
            found.data
        ),
    );
    page.put(
        "facts",
        vec![
            format!(
                "chi-square {} over {}",
                significant(found.chi_square, 4),
                found.degrees_of_freedom
            ),
            counted(found.simulations as u64, "simulation"),
            format!("found in {}", duration(found.wall_s)),
        ],
    );
    let tile = |one: &Estimate| {
        let error = one
            .standard_error
            .map_or(String::new(), |error| format!(" ± {}", significant(error, 2)));
        let note = match (one.interval_95, one.at_bound) {
            (Some([low, high]), _) => format!("95 %: {} to {}", significant(low, 5), significant(high, 5)),
            (None, Some(Bound::Low)) => "at its lower bound".into(),
            (None, Some(Bound::High)) => "at its upper bound".into(),
            (None, None) => "not determined by the data".into(),
        };
        json!({"label": one.pointer, "value": format!("{}{error}", significant(one.value, 5)), "note": note})
    };
    page.put("tiles", found.parameters.iter().map(tile).collect::<Vec<_>>());
    let picture = place.picture(PICTURE);
    let figure = picture.map(|picture| {
        json!({
            "title": "Data and model", "picture": picture,
            "about": "Rings are measured, the model is that of the estimates. Below, model less data; broken lines are two standard \
                      deviations of the noise.",
        })
    });
    page.put("figures", figure.into_iter().collect::<Vec<_>>());
    let row = |(k, one): (usize, &Estimate)| {
        let mut cells = vec![
            json!(one.pointer),
            json!(one.value),
            json!(one.standard_error),
            json!(one.interval_95.map(|i| i[0])),
            json!(one.interval_95.map(|i| i[1])),
            json!(one.finer_change),
        ];
        cells.extend(found.correlation[k].iter().map(|r| json!(r)));
        Value::from(cells)
    };
    let mut headings: Vec<String> = [
        "number",
        "estimate",
        "standard error",
        "95 % from",
        "95 % to",
        "change on finer mesh",
    ]
    .map(String::from)
    .to_vec();
    headings.extend(
        found
            .parameters
            .iter()
            .map(|one| format!("correlation with {}", one.pointer)),
    );
    page.put(
        "table",
        json!({
            "title": "Estimates",
            "about": "In the unit that each key names. The last columns are the correlations of the estimates.",
            "headings": headings, "rows": found.parameters.iter().enumerate().map(row).collect::<Vec<_>>(), "file": CSV,
        }),
    );
    page.put("command", format!("slcbeam run {FITTED}"));
    Ok(page)
}
