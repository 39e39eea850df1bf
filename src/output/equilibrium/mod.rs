//! What a load path leaves behind: `path.csv`, `shapes.csv`, `equilibrium.json`, `path.svg`, and its words.

mod words;

use std::path::PathBuf;

use serde_json::{Map, Value, json};

use super::accuracy::{with_accuracy, with_meshes};
use super::folder::{CASE, ResultFolder};
use super::numbers::shortest;
use super::plot::Curve;
use super::plot::loadpath::{self, LoadPath};
use crate::case::schema::Case;
use crate::error::Result;
use crate::run::equilibrium::{Kind, Options, Path, Sensitivity, State};
use crate::run::record::Column;
use crate::run::summary::Accuracy;
use crate::study::refine::meshes::Meshes;

pub use words::words;

/// One row a state.
pub const CSV: &str = "path.csv";
/// Positions of all nodes, two columns a state.
pub const SHAPES: &str = "shapes.csv";
/// Everything about the last state and the way to it.
pub const JSON: &str = "equilibrium.json";
/// Share of the loads over displacement, and shapes.
pub const PICTURE: &str = "path.svg";

/// Shapes in the picture.
const DRAWN: usize = 16;

/// A path with what it is of.
pub struct Found<'a> {
    /// The case.
    pub case: &'a Case,
    /// What was asked.
    pub options: &'a Options,
    /// The path.
    pub path: &'a Path,
    /// Columns of its states.
    pub columns: &'a [Column],
    /// Wall time [s].
    pub wall_s: f64,
    /// What to think of first.
    pub warnings: &'a [String],
    /// Derivatives of the last state's columns by parameters of the case.
    pub sensitivities: &'a [Sensitivity],
    /// Estimated errors, when an accuracy was asked for.
    pub accuracy: Option<&'a Accuracy>,
    /// What meshes do to the last state, where none was.
    pub meshes: Option<&'a Meshes>,
}

/// The text of `equilibrium.json`.
pub fn json(found: &Found) -> String {
    let Found { case, path, .. } = found;
    let finite = |x: f64| if x.is_finite() { json!(x) } else { Value::Null };
    let keyed = |values: &[f64]| -> Map<String, Value> {
        let pairs = found.columns.iter().zip(values).skip(1);
        pairs.map(|(column, value)| (key(column), finite(*value))).collect()
    };
    let last = path.states.last();
    let value = json!({
        "case": case.name,
        "status": if path.fault.is_none() { "finished" } else { "failed" },
        "reason": path.fault.as_ref().map(|f| f.what.clone()),
        "loads_at_s": found.options.at_s,
        "load_factor": last.map(|s| s.share),
        "states": path.states.len(),
        "quantities": last.map(|s| keyed(&s.row)),
        "stability": last.and_then(|s| s.stability.as_ref()).map(|s| json!({
            "stable": s.unstable == 0, "unstable_modes": s.unstable, "softest_1_s2": s.softest,
        })),
        "events": path.events.iter().map(|e| json!({"load_factor": e.share, "what": e.words()})).collect::<Vec<_>>(),
        "sensitivities": found.sensitivities.iter().map(|s| {
            (s.parameter.pointer.clone(), json!({"value": s.parameter.value, "derivatives": keyed(&s.row)}))
        }).collect::<Map<_, _>>(),
        "solver": {
            "newton_iterations": path.work.iterations, "residual_evaluations": path.work.residual_evaluations,
            "factorizations": path.work.factorizations, "rejected_steps": path.rejected,
            "largest_correction_left": finite(path.work.correction),
        },
        "wall_s": {"total": found.wall_s},
        "warnings": found.warnings,
    });
    let value = with_meshes(with_accuracy(value, found.accuracy), found.meshes);
    format!("{value:#}\n")
}

/// Key of a quantity, unit included as in `summary.json`.
fn key(column: &Column) -> String {
    let unit = match column.unit {
        "1" => return column.name.clone(),
        "Pa" => "pa",
        "J" => "j",
        "W" => "w",
        other => other,
    };
    format!("{}_{unit}", column.name)
}

/// Writes the files into a folder; others in it stay.
pub fn write(folder: &mut ResultFolder, found: &Found) -> Result<Vec<PathBuf>> {
    let case = found.case.written();
    let mut files = vec![
        (CSV, table(found)),
        (SHAPES, shapes(found)),
        (JSON, json(found)),
        (CASE, case.json.clone()),
    ];
    files.extend(loadpath::draw(&drawn(found)).map(|text| (PICTURE, text)));
    folder.fill_with(&case, files)
}

/// One row a state.
fn table(found: &Found) -> String {
    let mut text: String = found
        .columns
        .iter()
        .map(|c| format!("{} [{}],", c.name, c.unit))
        .collect();
    text.push_str("unstable_modes [1]\n");
    for state in &found.path.states {
        let unstable = state.stability.as_ref().map_or(f64::NAN, |s| s.unstable as f64);
        let row: Vec<String> = state.row.iter().chain([&unstable]).map(|&x| shortest(x)).collect();
        text.push_str(&row.join(","));
        text.push('\n');
    }
    text
}

/// One row a node: `theta [m]`, then x and z of every state.
fn shapes(found: &Found) -> String {
    let states = &found.path.states;
    let length = found.case.beam.length_m;
    let mut text = String::from("theta [m]");
    for state in states {
        let share = shortest(state.share);
        text.push_str(&format!(",x at {share} [m],z at {share} [m]"));
    }
    text.push('\n');
    let nodes = states.first().map_or(0, |s| s.u1.len());
    for i in 0..nodes {
        let theta = length * i as f64 / (nodes - 1) as f64;
        text.push_str(&shortest(theta));
        for state in states {
            text.push_str(&format!(",{},{}", shortest(state.u1[i]), shortest(theta + state.u3[i])));
        }
        text.push('\n');
    }
    text
}

/// The picture's data.
fn drawn(found: &Found) -> LoadPath {
    let states = &found.path.states;
    let stable = |s: &State| s.stability.as_ref().is_none_or(|s| s.unstable == 0);
    let shown = ["tip_u1", "tip_u3", "max_pressure"];
    let curves = found
        .columns
        .iter()
        .enumerate()
        .filter(|(_, c)| shown.contains(&c.name.as_str()));
    let nearest = |share: f64| {
        let far = |k: &usize| (states[*k].share - share).abs();
        (0..states.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
    };
    let every = states.len().div_ceil(DRAWN).max(1);
    let chosen = (0..states.len()).rev().step_by(every).collect::<Vec<_>>();
    let length = found.case.beam.length_m;
    let shape = |k: &usize| {
        let (u1, u3) = (&states[*k].u1, &states[*k].u3);
        let theta = |i: usize| length * i as f64 / (u1.len() - 1) as f64;
        (
            *k,
            u1.clone(),
            u3.iter().enumerate().map(|(i, u)| theta(i) + u).collect(),
        )
    };
    LoadPath {
        case: found.case.name.clone(),
        about: format!(
            "all loads grown together to those at t = {} s",
            shortest(found.options.at_s)
        ),
        shares: states.iter().map(|s| s.share).collect(),
        stable: states.iter().map(stable).collect(),
        curves: curves
            .map(|(k, column)| Curve {
                name: column.name.replace('_', " "),
                unit: column.unit.into(),
                points: states.iter().map(|s| (s.share, s.row[k])).collect(),
            })
            .collect(),
        marks: found
            .path
            .events
            .iter()
            .map(|e| {
                let letter = match e.kind {
                    Kind::LimitPoint => 'L',
                    Kind::Bifurcation => 'B',
                };
                (nearest(e.share), letter)
            })
            .collect(),
        shapes: chosen.iter().rev().map(shape).collect(),
    }
}
