//! Table of a study, for the terminal and as CSV.

use std::fmt::Write as _;

use super::text::spoken;
use crate::output::columns;
use crate::output::numbers::{counted, significant};
use crate::output::records::{self, number};
use crate::study::accuracy::Study;
use crate::study::accuracy::plan::fluid_cells;
use crate::study::accuracy::study::StudyPoint;
use crate::study::accuracy::trial::{RunPurpose, TrialOutcome};

const HEADINGS: &str =
    "cells | method | rtol | time | median | steps | residuals | factor. | failed | in time | in space | total | ";

/// Table of the points in the headline measure, then the references, then the limit of each measure.
pub fn table(study: &Study) -> String {
    let mut text = String::new();
    let Some(measure) = study.measure() else {
        for point in &study.points {
            let _ = writeln!(text, "{}", reasons(point));
        }
        return text;
    };
    let _ = writeln!(
        text,
        "{}: error of {}, largest over the run, relative to {} {}\n",
        study.case,
        spoken(&measure.name),
        significant(measure.size.max, 3),
        measure.unit
    );
    let mut lines = vec![];
    let mut unfinished = vec![];
    let points = study.points.iter().enumerate();
    for (k, point) in points.filter(|(_, p)| p.trial.role == RunPurpose::Point) {
        match study.error(k) {
            Some(_) => lines.push(row(study, k)),
            None => unfinished.push(reasons(point)),
        }
    }
    text += &columns::table(HEADINGS, lines);
    text += "\n* no other point is both cheaper and more accurate   ? the reference is not ten times better than this point\n\
             time: least of the timed runs; failed: rejected steps and Newton failures\n";
    if !unfinished.is_empty() {
        let _ = writeln!(text, "\nnot finished\n  {}", unfinished.join("\n  "));
    }
    text += &references(study);
    text += &limits(study);
    text
}

fn row(study: &Study, k: usize) -> [String; 13] {
    let point = &study.points[k];
    let (trial, s) = (&point.trial, point.trial.setting);
    let small = |x: Option<f64>| x.map_or_else(|| "-".into(), |x| format!("{x:.1e}"));
    let seconds = |x: f64| if x < 10.0 { format!("{x:.3}") } else { format!("{x:.1}") };
    let errors = study.error(k);
    let mark = match (point.on_front, errors.is_some_and(|e| e.judged)) {
        (true, true) => "*",
        (true, false) => "*?",
        (false, true) => "",
        (false, false) => "?",
    };
    let c = &trial.counters;
    [
        s.cells.to_string(),
        s.scheme.label(),
        format!("{:e}", s.rtol),
        seconds(trial.wall_min_s),
        seconds(trial.wall_median_s),
        c.steps.to_string(),
        c.residual_evaluations.to_string(),
        c.factorizations.to_string(),
        (c.error_test_failures + c.newton_failures).to_string(),
        small(errors.and_then(|e| e.temporal).map(|e| e.max)),
        small(errors.and_then(|e| e.spatial).map(|e| e.max)),
        small(errors.map(|e| e.total.max)),
        mark.into(),
    ]
}

fn reasons(point: &StudyPoint) -> String {
    let s = point.trial.setting;
    let how = ending(point.trial.ending);
    let why = point.trial.reason.as_deref().unwrap_or("no reason given");
    format!(
        "{}, {}, rtol {:e}: {how}: {why}",
        counted(s.cells as u64, "cell"),
        s.scheme,
        s.rtol
    )
}

fn ending(ending: TrialOutcome) -> &'static str {
    match ending {
        TrialOutcome::Finished => "finished",
        TrialOutcome::Stopped => "stopped",
        TrialOutcome::Failed => "failed",
        TrialOutcome::Skipped => "skipped",
    }
}

fn references(study: &Study) -> String {
    let mut text = String::from("\nreference of each mesh, and its own error by two routes\n");
    let k = study.headline;
    let small = |x: Option<f64>| x.map_or_else(|| "unknown".into(), |x| format!("{x:.1e}"));
    for r in &study.references {
        let _ = write!(
            text,
            "  {}: {}, rtol {:e}, {:.2} s: {} by its tolerances",
            counted(r.cells as u64, "cell"),
            r.scheme,
            r.rtol,
            r.wall_s,
            small(r.by_tolerance[k].map(|n| n.max))
        );
        if let Some((scheme, rtol)) = r.checked_by {
            let apart = small(r.by_order[k].map(|n| n.max));
            let _ = write!(text, ", {apart} from {scheme} at rtol {rtol:e}");
        }
        let _ = writeln!(text, "; believed {:.1e}", r.own[k].max);
    }
    text
}

/// Limit of each measure: order in space, and own error.
fn limits(study: &Study) -> String {
    let headings = "<limit of each measure | order | <limit by | own error | of it in space | <size";
    let rows = study.measures.iter().map(|m| {
        [
            m.name.clone(),
            m.order.map_or("-".into(), |o| {
                format!("{o:.2}{}", if m.order_is_clean { "" } else { "~" })
            }),
            match m.extrapolated_with {
                Some(q) => format!("Richardson h^{}", significant(q, 2)),
                None => "finest mesh".into(),
            },
            format!("{:.1e}", m.own().max),
            m.own_spatial
                .map_or_else(|| "unknown".into(), |n| format!("{:.1e}", n.max)),
            format!("{} {}", significant(m.size.max, 3), m.unit),
        ]
    });
    let mut text = format!("\n{}", columns::table(headings, rows));
    text += "~ errors in time are above a tenth of the differences between meshes\n";
    if !study.left_out.is_empty() {
        let _ = writeln!(
            text,
            "not compared (prescribed, or negligible beside others of the same unit): {}",
            study.left_out.join(", ")
        );
    }
    text
}

/// Text of `study.csv`: one row per setting and measure; a setting that did not finish has one row without errors.
pub fn csv(study: &Study) -> String {
    let headings = "cells_per_segment,cells_per_bladder,method,max_order,rtol,role,status,reason,unknowns,wall_min [s],wall_median [s],\
                    repeats,steps,residual_evaluations,jacobian_evaluations,factorizations,error_test_failures,newton_failures,\
                    measure,kind,temporal_l2,temporal_max,spatial_l2,spatial_max,total_l2,total_max,limit_own_error_l2,\
                    limit_own_error_max,judged,on_front";
    let mut rows = vec![];
    for point in &study.points {
        let (trial, s, c) = (&point.trial, point.trial.setting, &point.trial.counters);
        let mut setting = vec![
            s.cells.to_string(),
            fluid_cells(s.cells).to_string(),
            if s.scheme.is_ida() {
                "ida".into()
            } else {
                s.scheme.label()
            },
            s.scheme.order.to_string(),
            format!("{:e}", s.rtol),
            match trial.role {
                RunPurpose::Point => "point".into(),
                RunPurpose::Reference => "reference".into(),
            },
            ending(trial.ending).into(),
            trial.reason.clone().unwrap_or_default(),
            trial.unknowns.to_string(),
            number(Some(trial.wall_min_s)),
            number(Some(trial.wall_median_s)),
            trial.repeats.to_string(),
        ];
        let evaluations = [
            c.steps,
            c.residual_evaluations,
            c.jacobian_evaluations,
            c.factorizations,
        ];
        let failures = [c.error_test_failures, c.newton_failures];
        setting.extend(evaluations.iter().chain(&failures).map(u64::to_string));
        let Some(errors) = &point.errors else {
            rows.push([setting, vec![String::new(); 12]].concat());
            continue;
        };
        for (e, m) in errors.iter().zip(&study.measures) {
            let norms = [e.temporal, e.spatial, Some(e.total), Some(m.own())];
            let numbers = norms.into_iter().flat_map(|n| [n.map(|n| n.l2), n.map(|n| n.max)]);
            let mut row = setting.clone();
            row.extend([m.name.clone(), format!("{:?}", m.kind).to_lowercase()]);
            row.extend(numbers.map(number));
            row.extend([e.judged, point.on_front].map(|yes| yes.to_string()));
            rows.push(row);
        }
    }
    records::text(headings.split(','), rows)
}
