//! The pages of `study` and `effects`: many runs, one question.

use serde_json::{Value, json};

use super::{Found, Kind, Page, Place, capital};
use crate::error::Result;
use crate::output::folder::CASE;
use crate::output::numbers::{count, duration, percent, significant};
use crate::output::{effects as effects_files, study as study_files};
use crate::results::studies::{Ablation, Study};
use crate::study::accuracy::study::Point;
use crate::study::accuracy::{Budget, Plan, Scheme};
use crate::study::effects::Row;

fn yes(it_is: bool) -> &'static str {
    if it_is { "yes" } else { "no" }
}

/// `ida, order 5`.
fn method(scheme: Scheme) -> String {
    let name = if scheme.is_ida() { "ida".into() } else { scheme.label() };
    format!("{name}, order {}", scheme.order)
}

/// What accuracy costs.
pub fn study(place: &Place) -> Result<Page> {
    let Found { result: found, head } = place.result::<Study>(study_files::JSON)?;
    let mut page = place.page(Kind::Study, &found.case, Some(&head));
    let measure = found.measure().map_or("", |measure| measure.name.as_str());
    page.put("label", "What accuracy costs");
    page.put("answer", capital(&study_files::sentence(&found)));
    page.warnings.clone_from(&found.notes);
    page.put(
        "facts",
        vec![
            format!("{} settings", count(found.points.len() as u64)),
            format!("{} spent", duration(found.spent)),
            format!("judged by {measure}"),
        ],
    );
    page.put(
        "figures",
        json!([{
            "title": "Error and time",
            "picture": place.picture(study_files::PICTURE),
            "about": "Each mark is one setting: a mesh, a method and a tolerance. Further left is more exact, further down is \
                      faster; the settings worth using lie along the lower left edge.",
        }]),
    );
    let row = |(k, point): (usize, &Point)| {
        let (trial, error) = (&point.trial, found.error(k));
        let setting = trial.setting;
        json!([
            setting.cells,
            method(setting.scheme),
            setting.rtol,
            trial.unknowns,
            trial.counters.steps,
            trial.wall_min_s,
            error.map(|e| e.total.max),
            yes(error.is_some_and(|e| e.judged)),
            yes(point.on_front),
        ])
    };
    let ran = found
        .points
        .iter()
        .enumerate()
        .filter(|(_, p)| p.trial.counters.steps > 0);
    page.put(
        "table",
        json!({
            "title": "Every setting",
            "about": format!("The error is the largest difference of {measure} from the best reference, over its largest value. \
                      \"Judged\" says whether that reference is exact enough to tell."),
            "headings": ["cells a segment", "method", "tolerance", "unknowns", "steps", "least wall time [s]", "largest error",
                         "judged", "worth using"],
            "rows": ran.map(row).collect::<Vec<_>>(), "file": study_files::CSV,
        }),
    );
    page.put("command", format!("slcbeam study {CASE}{}", options(&found.plan)));
    Ok(page)
}

/// Options of the command that made a study.
fn options(plan: &Plan) -> String {
    let list = |values: Vec<String>| values.join(",");
    let rtols = list(plan.rtols.iter().map(|t| json!(t).to_string()).collect());
    let cells = list(plan.cells.iter().map(ToString::to_string).collect());
    let budget = match plan.budget {
        Budget::Wall(seconds) => format!(" --budget {seconds}s"),
        Budget::Steps(_) => String::new(),
    };
    format!(" --rtol {rtols} --cells {cells}{budget}")
}

/// What each effect does.
pub fn effects(place: &Place) -> Result<Page> {
    let Found { result: found, head } = place.result::<Ablation>(effects_files::JSON)?;
    let mut page = place.page(Kind::Effects, &found.case, Some(&head));
    page.put("label", "What each effect does");
    page.put("answer", effects_files::sentence(&found));
    let compared = found.rows.iter().filter(|r| r.left_out.is_some()).count();
    page.put(
        "facts",
        vec![
            format!("{compared} effects left out in turn"),
            format!("{} spent", duration(found.spent_s)),
        ],
    );
    page.put(
        "figures",
        json!([{
            "title": "Changes and cost",
            "picture": place.picture(effects_files::PICTURE),
            "about": format!("For every effect, the full model is run once more without it. Bar: the quantity of the picture; \
                      ring: the one that changes most. Where the ring stays below {}, the effect may be left out.",
                      percent(found.tolerance)),
        }]),
    );
    let row = |r: &Row| -> Value {
        let left_out = r.left_out.as_ref();
        let largest = left_out.and_then(|c| c.largest.as_ref());
        json!([
            r.name,
            r.verdict,
            largest.map(|l| l.1),
            largest.map(|l| &l.0),
            left_out.map(|c| c.unknowns),
            left_out.map(|c| c.work),
            left_out.map(|c| c.wall),
            r.reason.as_ref().unwrap_or(&r.number),
        ])
    };
    page.put(
        "table",
        json!({
            "title": "Every effect",
            "about": format!("\"Change\" is the largest relative change of any quantity when the effect is left out; work and time are \
                      those without it, over those of the full model (1 is the same). The integrator's own tolerance is {}.",
                      significant(found.rtol, 1)),
            "headings": ["effect", "verdict", "change", "of", "unknowns saved or added", "work", "time", "why"],
            "rows": found.rows.iter().map(row).collect::<Vec<_>>(), "file": effects_files::CSV,
        }),
    );
    page.put(
        "command",
        format!("slcbeam effects {CASE} --budget {}s", found.plan.budget_s),
    );
    Ok(page)
}
