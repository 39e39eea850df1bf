//! What a load path leaves behind: `path.csv`, `shapes.csv`, `equilibrium.json`, `path.svg`, and its words.

mod words;

use std::path::PathBuf;

use super::folder::{CASE, ResultFolder};
use super::numbers::shortest;
use super::plot::Curve;
use super::plot::loadpath::{self, LoadPath};
use super::records;
use crate::case::schema::Case;
use crate::discrete::quantities::{Observable, Role};
use crate::error::Result;
use crate::results;
use crate::results::equilibrium::{self as kept, Equilibrium, Numbers};
use crate::results::run::{Bands, Status};
use crate::run::equilibrium::{Event, Kind, Options, Path, Sensitivity, Stability, State};
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
    /// What uncertain numbers leave open of the last state.
    pub bands: Bands,
}

/// The text of `equilibrium.json`.
pub fn json(found: &Found) -> String {
    let path = found.path;
    let keyed = |values: &[f64]| -> Numbers {
        let pairs = found.columns.iter().zip(values).skip(1);
        pairs.map(|(column, value)| (column.key(), Some(*value))).collect()
    };
    let last = path.states.last();
    let stability = |s: &Stability| kept::Stability {
        stable: s.unstable == 0,
        unstable_modes: s.unstable,
        softest_1_s2: s.softest,
    };
    let several = !found.options.via_s.is_empty();
    let event = |e: &Event| kept::Event {
        load_factor: e.load_factor(),
        stage: several.then_some(e.stage + 1),
        what: e.words().into(),
    };
    let derivatives = |s: &Sensitivity| {
        let (value, derivatives) = (s.parameter.value, keyed(&s.row));
        (s.parameter.pointer.clone(), kept::Derivatives { value, derivatives })
    };
    results::text(&Equilibrium {
        case: found.case.name.clone(),
        status: path.fault.as_ref().map_or(Status::Finished, |_| Status::Failed),
        reason: path.fault.as_ref().map(|f| f.what.clone()),
        loads_at_s: found.options.at_s,
        via_s: found.options.via_s.clone(),
        valves_s: found.options.valves_s.clone(),
        load_factor: last.map(State::load_factor),
        states: path.states.len(),
        quantities: last.map(|s| keyed(&s.row)),
        bands: found.bands.clone(),
        stability: last.and_then(|s| s.stability.as_ref()).map(stability),
        events: path.events.iter().map(event).collect(),
        sensitivities: found.sensitivities.iter().map(derivatives).collect(),
        solver: kept::Work {
            newton_iterations: path.work.iterations,
            residual_evaluations: path.work.residual_evaluations,
            factorizations: path.work.factorizations,
            rejected_steps: path.rejected,
            largest_correction_left: path.work.correction,
        },
        wall_s: kept::Wall { total: found.wall_s },
        warnings: found.warnings.to_vec(),
        accuracy: found.accuracy.cloned(),
        meshes: found.meshes.cloned(),
    })
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

/// One row a state; which stage it belongs to, from 1, where there are several.
fn table(found: &Found) -> String {
    let several = !found.options.via_s.is_empty();
    let columns = found.columns.iter().map(|c| format!("{} [{}]", c.name, c.unit));
    let rows = found.path.states.iter().map(|state| {
        let unstable = state.stability.as_ref().map_or(f64::NAN, |s| s.unstable as f64);
        let stage = several.then_some(state.stage as f64 + 1.0);
        state
            .row
            .iter()
            .copied()
            .chain([unstable])
            .chain(stage)
            .map(shortest)
            .collect()
    });
    let stage = several.then(|| "stage [1]".into());
    records::text(columns.chain(["unstable_modes [1]".into()]).chain(stage), rows)
}

/// One row a node: `theta [m]`, then x and z of every state.
fn shapes(found: &Found) -> String {
    let states = &found.path.states;
    let length = found.case.beam.length_m;
    let shares = states.iter().map(|state| shortest(state.load_factor()));
    let columns = shares.flat_map(|share| [format!("x at {share} [m]"), format!("z at {share} [m]")]);
    let nodes = states.first().map_or(0, |s| s.u1.len());
    let rows = (0..nodes).map(|i| {
        let theta = length * i as f64 / (nodes - 1) as f64;
        let places = states.iter().flat_map(|state| [state.u1[i], theta + state.u3[i]]);
        [theta].into_iter().chain(places).map(shortest).collect()
    });
    records::text(["theta [m]".into()].into_iter().chain(columns), rows)
}

/// What the loads are those of.
fn about(options: &Options) -> String {
    let all = options.via_s.iter().chain([&options.at_s]);
    let instants: Vec<String> = all.map(|at| format!("{} s", shortest(*at))).collect();
    match instants.as_slice() {
        [at] => format!("all loads grown together to those at t = {at}"),
        _ => format!("loads at t = {}, one after the other", instants.join(", ")),
    }
}

/// The picture's data.
fn drawn(found: &Found) -> LoadPath {
    let states = &found.path.states;
    let stable = |s: &State| s.stability.as_ref().is_none_or(|s| s.unstable == 0);
    // of probes the deflection: ends may be held
    let shown = |name: &str| match Observable::named(name) {
        Some(one) => one.role() == Role::Headline,
        None => name.ends_with("_u1"),
    };
    let curves = found.columns.iter().enumerate().filter(|(_, c)| shown(&c.name));
    let nearest = |share: f64| {
        let far = |k: &usize| (states[*k].load_factor() - share).abs();
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
        about: about(found.options),
        shares: states.iter().map(State::load_factor).collect(),
        stable: states.iter().map(stable).collect(),
        curves: curves
            .map(|(k, column)| Curve {
                name: column.name.replace('_', " "),
                unit: column.unit.into(),
                points: states.iter().map(|s| (s.load_factor(), s.row[k])).collect(),
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
                (nearest(e.load_factor()), letter)
            })
            .collect(),
        shapes: chosen.iter().rev().map(shape).collect(),
    }
}
