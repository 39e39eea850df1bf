//! Page of a fit.

use serde_json::json;

use super::{FolderKind, Page, Place, cells};
use crate::error::Result;
use crate::output::fit::{CSV, FITTED, PICTURE, shown};
use crate::output::numbers::{counted, duration, significant};
use crate::results::fit::{Bound, Fit, FittedNumber};

/// Outputs of a response, as an option.
fn outputs(found: &Fit) -> String {
    let mut all: Vec<&str> = vec![];
    for column in &found.columns {
        let output = column.quantity.split('.').next().unwrap_or_default();
        if !all.contains(&output) {
            all.push(output);
        }
    }
    all.join(",")
}

/// Page of `fit`.
pub fn data(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Fit>(FolderKind::Fit, |found| (&found.case, &found.warnings))?;
    let tile = |one: &FittedNumber| {
        let note = match (one.interval_95, one.at_bound) {
            (Some([low, high]), _) => format!("95 %: {} to {}", significant(low, 5), significant(high, 5)),
            (None, Some(Bound::Low)) => "at its lower bound".into(),
            (None, Some(Bound::High)) => "at its upper bound".into(),
            (None, None) => "not determined by the data".into(),
        };
        json!({"label": one.pointer, "value": shown(one), "note": note})
    };
    let row = |(k, one): (usize, &FittedNumber)| {
        let [low, high] = [0, 1].map(|k| one.interval_95.map(|i| i[k]));
        let numbers = [Some(one.value), one.standard_error, low, high, one.finer_change];
        let numbers = numbers.iter().chain(&found.correlation[k]);
        cells([json!(one.pointer)], numbers.map(|x| json!(x)))
    };
    let first = "number,estimate,standard error,95 % from,95 % to,change on finer mesh".split(',');
    let correlated = found
        .parameters
        .iter()
        .map(|one| format!("correlation with {}", one.pointer));
    let headings: Vec<String> = first.map(String::from).chain(correlated).collect();
    let numbers = match found.parameters.len() {
        1 => "One number of the case was".into(),
        n => format!("{n} numbers of the case were"),
    };
    let values = counted(found.observations as u64, "value");
    page.fill(json!({
        "label": "Fitted to data",
        "answer": format!("{numbers} fitted to {values} of {}; the case with the estimates is {FITTED}.", found.data),
        "facts": [
            format!("chi-square {} over {}", significant(found.chi_square, 4), found.degrees_of_freedom),
            counted(found.simulations as u64, "simulation"),
            format!("found in {}", duration(found.wall_s)),
        ],
        "tiles": found.parameters.iter().map(tile).collect::<Vec<_>>(),
        "figures": [{
            "title": "Data and model", "picture": place.picture(PICTURE),
            "about": "Rings are measured, the model is that of the estimates. Below, model less data; broken lines are two standard \
                      deviations of the noise.",
        }],
        "table": {
            "title": "Estimates", "about": "In the unit that each key names. The last columns are the correlations of the estimates.",
            "headings": headings, "rows": found.parameters.iter().enumerate().map(row).collect::<Vec<_>>(), "file": CSV,
        },
        "command": match &found.input {
            Some(input) => format!("slcbeam response {FITTED} --input {input} --output {}", outputs(&found)),
            None => format!("slcbeam run {FITTED}"),
        },
    }));
    Ok(page)
}
