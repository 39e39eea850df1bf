//! The pages of `study` and `effects`: many runs, one question.

use serde_json::{Map, Value, json};

use super::{Kind, Place, capital};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::numbers::{count, duration, percent, significant};
use crate::output::{effects as effects_files, study as study_files};

/// What accuracy costs.
pub fn study(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json(study_files::JSON)?;
    let text = |key: &str| found.get(key).and_then(Value::as_str).unwrap_or("").to_string();
    let mut all = place.head(Kind::Study, &text("case"));
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let headline = found.get("headline").and_then(Value::as_u64).unwrap_or(0) as usize;
    let measure = found
        .pointer(&format!("/measures/{headline}/name"))
        .and_then(Value::as_str)
        .unwrap_or("");
    let points = found
        .get("points")
        .and_then(Value::as_array)
        .cloned()
        .unwrap_or_default();
    put("label", "What accuracy costs".into());
    put("answer", capital(&text("sentence")).into());
    put("warnings", found.get("notes").cloned().unwrap_or_default());
    put(
        "facts",
        json!([
            format!("{} settings", count(points.len() as u64)),
            format!(
                "{} spent",
                duration(found.get("spent").and_then(Value::as_f64).unwrap_or(f64::NAN))
            ),
            format!("judged by {measure}"),
        ]),
    );
    put(
        "figures",
        json!([{
            "title": "Error and time",
            "picture": place.picture(study_files::PICTURE),
            "about": "Each mark is one setting: a mesh, a method and a tolerance. Further left is more exact, further down is \
                      faster; the settings worth using lie along the lower left edge.",
        }]),
    );
    let number = |v: &Value, pointer: &str| v.pointer(pointer).and_then(Value::as_f64);
    let row = |point: &Value| {
        let setting = |key: &str| {
            point
                .pointer(&format!("/trial/setting/{key}"))
                .cloned()
                .unwrap_or_default()
        };
        let error = point
            .get("errors")
            .and_then(|e| e.get(headline))
            .cloned()
            .unwrap_or_default();
        let scheme = setting("scheme");
        let method = match (
            scheme.get("method").and_then(Value::as_str),
            scheme.get("order").and_then(Value::as_u64),
        ) {
            (Some(method), Some(order)) => format!("{method}, order {order}"),
            (Some(method), None) => method.to_string(),
            _ => scheme.to_string(),
        };
        json!([
            setting("cells"),
            method,
            setting("rtol"),
            point.pointer("/trial/unknowns"),
            point.pointer("/trial/counters/steps"),
            number(point, "/trial/wall_min_s"),
            number(&error, "/total/max"),
            if error.get("judged").and_then(Value::as_bool) == Some(true) {
                "yes"
            } else {
                "no"
            },
            if point.get("on_front").and_then(Value::as_bool) == Some(true) {
                "yes"
            } else {
                "no"
            },
        ])
    };
    put(
        "table",
        json!({
            "title": "Every setting",
            "about": format!("The error is the largest difference of {measure} from the best reference, over its largest value. \
                      \"Judged\" says whether that reference is exact enough to tell."),
            "headings": ["cells a segment", "method", "tolerance", "unknowns", "steps", "least wall time [s]", "largest error",
                         "judged", "worth using"],
            "rows": points.iter().filter(|p| p.pointer("/trial/counters/steps").and_then(Value::as_u64) != Some(0)).map(row).collect::<Vec<_>>(), "file": study_files::CSV,
        }),
    );
    put("command", format!("slcbeam study {CASE}{}", plan(&found)).into());
    Ok(all)
}

/// Options of the command that made a study.
fn plan(found: &Value) -> String {
    let list = |pointer: &str| {
        let values = found.pointer(pointer).and_then(Value::as_array)?;
        Some(values.iter().map(ToString::to_string).collect::<Vec<_>>().join(","))
    };
    let mut text = String::new();
    for (option, pointer) in [("--rtol", "/plan/rtols"), ("--cells", "/plan/cells")] {
        if let Some(values) = list(pointer) {
            text.push_str(&format!(" {option} {values}"));
        }
    }
    if let Some(budget) = found.pointer("/plan/budget/wall").and_then(Value::as_f64) {
        text.push_str(&format!(" --budget {budget}s"));
    }
    text
}

/// What each effect does.
pub fn effects(place: &Place) -> Result<Map<String, Value>> {
    let found = place.json(effects_files::JSON)?;
    let text = |pointer: &str| found.pointer(pointer).and_then(Value::as_str).unwrap_or("").to_string();
    let mut all = place.head(Kind::Effects, &text("/case"));
    let mut put = |key: &str, value: Value| all.insert(key.into(), value);
    let rows = found.get("rows").and_then(Value::as_array).cloned().unwrap_or_default();
    let budget = found.pointer("/plan/budget_s").and_then(Value::as_f64);
    put("label", "What each effect does".into());
    put("answer", text("/sentence").into());
    put("warnings", json!([]));
    let compared = rows
        .iter()
        .filter(|r| r.get("left_out").is_some_and(Value::is_object))
        .count();
    put(
        "facts",
        json!([
            format!("{compared} effects left out in turn"),
            format!(
                "{} spent",
                duration(found.get("spent_s").and_then(Value::as_f64).unwrap_or(f64::NAN))
            ),
        ]),
    );
    let tolerance = found.get("tolerance").and_then(Value::as_f64).unwrap_or(f64::NAN);
    put(
        "figures",
        json!([{
            "title": "Changes and cost",
            "picture": place.picture(effects_files::PICTURE),
            "about": format!("For every effect, the full model is run once more without it. Bar: the quantity of the picture; \
                      ring: the one that changes most. Where the ring stays below {}, the effect may be left out.", percent(tolerance)),
        }]),
    );
    let row = |r: &Value| {
        let at = |pointer: &str| r.pointer(pointer).cloned().unwrap_or_default();
        json!([
            at("/name"),
            at("/verdict"),
            at("/left_out/largest/1"),
            at("/left_out/largest/0"),
            at("/left_out/unknowns"),
            at("/left_out/work"),
            at("/left_out/wall"),
            r.get("reason")
                .filter(|t| t.is_string())
                .or(r.get("number"))
                .cloned()
                .unwrap_or_default(),
        ])
    };
    put(
        "table",
        json!({
            "title": "Every effect",
            "about": format!("\"Change\" is the largest relative change of any quantity when the effect is left out; work and time are \
                      those without it, over those of the full model (1 is the same). The integrator's own tolerance is {}.",
                      significant(found.get("rtol").and_then(Value::as_f64).unwrap_or(f64::NAN), 1)),
            "headings": ["effect", "verdict", "change", "of", "unknowns saved or added", "work", "time", "why"],
            "rows": rows.iter().map(row).collect::<Vec<_>>(), "file": effects_files::CSV,
        }),
    );
    let budget = budget.map_or(String::new(), |b| format!(" --budget {b}s"));
    put("command", format!("slcbeam effects {CASE}{budget}").into());
    Ok(all)
}
