//! Pages of `study` and `effects`, each of many runs.

use serde_json::{Value, json};

use super::{FolderKind, Page, Place, capital};
use crate::error::Result;
use crate::output::effects::{self as effects_files, Bar, ShownQuantity};
use crate::output::folder::CASE;
use crate::output::numbers::{counted, duration, percent, significant};
use crate::output::study::{self as study_files, MeshLine, RunMarker, mesh_lines, spoken};
use crate::results::studies::{Ablation, Study};
use crate::study::accuracy::study::StudyPoint;
use crate::study::accuracy::{Budget, Scheme, StudyPlan};
use crate::study::effects::{AblationRow, EffectVerdict};

fn yes(it_is: bool) -> &'static str {
    if it_is { "yes" } else { "no" }
}

/// `ida, order 5`.
fn method(scheme: Scheme) -> String {
    let name = if scheme.is_ida() { "ida".into() } else { scheme.label() };
    format!("{name}, order {}", scheme.order)
}

/// Page of `study`: cost of accuracy.
pub fn study(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Study>(FolderKind::Study, |found| (&found.case, &found.notes))?;
    let measure = found.measure().map_or("", |measure| measure.name.as_str());
    let row = |(k, point): (usize, &StudyPoint)| {
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
    page.fill(json!({
        "label": "What accuracy costs", "answer": capital(&study_files::sentence(&found)),
        "facts": [
            counted(found.points.len() as u64, "setting"),
            format!("{} spent", duration(found.spent)),
            format!("judged by {measure}"),
        ],
        "charts": cost(&found).into_iter().collect::<Vec<_>>(),
        "table": {
            "title": "Every setting",
            "about": format!("The error is the largest difference of {measure} from the best reference, over its largest value. \
                      \"Judged\": that reference is exact enough to judge the setting."),
            "headings": ["cells a segment", "method", "tolerance", "unknowns", "steps", "least wall time [s]", "largest error",
                         "judged", "worth using"],
            "rows": ran.map(row).collect::<Vec<_>>(), "file": study_files::CSV,
        },
        "command": format!("slcbeam study {CASE}{}", options(&found.plan)),
    }));
    Ok(page)
}

/// Chart of error and time, one mark per run.
fn cost(found: &Study) -> Option<Value> {
    let (measure, all) = (found.measure()?, mesh_lines(found));
    let mut meshes: Vec<usize> = all.iter().map(|line| line.cells).collect();
    meshes.sort_unstable();
    meshes.dedup();
    let drawn = |marker: &&RunMarker| marker.error > 0.0 && marker.least_s > 0.0;
    let series = |line: &MeshLine| {
        let cells = counted(line.cells as u64, "cell");
        let name = format!("{cells}, {}", method(line.scheme));
        let point = |marker: &RunMarker| {
            let worth = if marker.front { "; worth using" } else { "" };
            let doubt = if marker.judged {
                ""
            } else {
                "; the reference is too coarse to judge it"
            };
            let words = format!(
                "{cells} a segment, {}, tolerance {:e}: error {:.1e}, {}{worth}{doubt}",
                method(line.scheme),
                marker.rtol,
                marker.error,
                duration(marker.least_s)
            );
            json!([marker.error, marker.least_s, words, marker.judged])
        };
        let points: Vec<Value> = line.markers.iter().filter(drawn).map(point).collect();
        (!points.is_empty()).then(|| {
            json!({
                "name": name, "points": points, "dash": if line.scheme.is_ida() { None } else { Some("7 3") },
                "colour": meshes.iter().position(|cells| *cells == line.cells),
            })
        })
    };
    let lines: Vec<Value> = all.iter().filter_map(series).collect();
    let markers = all.iter().flat_map(|line| &line.markers).filter(drawn);
    let mut front: Vec<[f64; 2]> = markers.filter(|m| m.front).map(|m| [m.error, m.least_s]).collect();
    front.sort_by(|a, b| b[0].total_cmp(&a[0]));
    (!lines.is_empty()).then(|| {
        json!({
            "kind": "marks", "title": "Error and time",
            "about": format!(
                "Each mark is one setting: a mesh, a method and a tolerance. The error is that of {}. Settings further left are more exact, \
                 those further down are faster. The settings worth using lie on the shaded line along the lower left edge. For hollow marks, and \
                 in the dark area at the left, the reference is too coarse to judge the error. Broken lines are one-step methods.",
                spoken(&measure.name)
            ),
            "x": {"name": "relative error", "unit": "1"}, "y": {"name": "least wall time", "unit": "s"},
            "series": lines, "front": front, "limit": {"at": 10.0 * measure.own().max},
        })
    })
}

/// Chart of the changes without each effect.
fn changes(found: &Ablation) -> Value {
    let shown = ShownQuantity::choose(found, None);
    let row = |bar: &Bar| {
        let verdict = bar.verdict.map(|verdict| json!(verdict));
        let verdict = verdict
            .as_ref()
            .and_then(Value::as_str)
            .unwrap_or("a choice as a whole");
        let largest = bar.largest.filter(|x| *x > 0.0);
        let most = largest.map_or(String::new(), |x| format!(", at most {} in any quantity", percent(x)));
        let work = if bar.work.is_finite() {
            format!(", {} of the work", percent(bar.work))
        } else {
            String::new()
        };
        let tone = match bar.verdict {
            Some(EffectVerdict::Needed | EffectVerdict::Failed) => "bad",
            Some(EffectVerdict::Saves) => "good",
            Some(EffectVerdict::Harmless) => "fair",
            _ => "",
        };
        json!({
            "name": bar.name.replace('_', " "), "value": bar.change, "ring": bar.largest, "tone": tone,
            "work": bar.work.is_finite().then_some(bar.work), "words": format!("{verdict}{most}{work}"),
        })
    };
    let own = shown.own(found).map_or(String::new(), |own| {
        format!(" Changes below {} are the integrator's own error.", percent(own))
    });
    json!({
        "kind": "bars", "title": "Changes and cost", "limit": {"at": found.tolerance},
        "about": format!(
            "For every effect, the full model is run once more without it. Bar: the change of {}; ring: that of the quantity that changes most. \
             Where the ring stays left of the broken line at {}, the effect may be left out.{own}",
            shown.describe(),
            percent(found.tolerance)
        ),
        "rows": effects_files::bars(found, &shown).iter().map(row).collect::<Vec<_>>(),
    })
}

/// Options of the command that produced a study.
fn options(plan: &StudyPlan) -> String {
    let list = |values: Vec<String>| values.join(",");
    let rtols = list(plan.rtols.iter().map(|t| json!(t).to_string()).collect());
    let cells = list(plan.cells.iter().map(ToString::to_string).collect());
    let budget = match plan.budget {
        Budget::Wall(seconds) => format!(" --budget {seconds}s"),
        Budget::Steps(_) => String::new(),
    };
    format!(" --rtol {rtols} --cells {cells}{budget}")
}

/// Page of `effects`: change of results without each effect.
pub fn effects(place: &Place) -> Result<Page> {
    let (found, mut page) = place.begun::<Ablation>(FolderKind::Effects, |found| (&found.case, &[]))?;
    let row = |r: &AblationRow| -> Value {
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
    let compared = found.rows.iter().filter(|r| r.left_out.is_some()).count();
    page.fill(json!({
        "label": "What each effect does", "answer": effects_files::sentence(&found),
        "facts": [format!("{compared} effects left out in turn"), format!("{} spent", duration(found.spent_s))],
        "charts": [changes(&found)],
        "table": {
            "title": "Every effect",
            "about": format!("\"Change\" is the largest relative change of any quantity when the effect is left out; work and time are \
                      those without it, over those of the full model (1 is the same). The integrator's own tolerance is {}.",
                      significant(found.rtol, 1)),
            "headings": ["effect", "verdict", "change", "of", "unknowns saved or added", "work", "time", "why"],
            "rows": found.rows.iter().map(row).collect::<Vec<_>>(), "file": effects_files::CSV,
        },
        "command": format!("slcbeam effects {CASE} --budget {}s", found.plan.budget_s),
    }));
    Ok(page)
}
