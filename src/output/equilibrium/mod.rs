//! Output files of a load path, `path.csv`, `shapes.csv`, `equilibrium.json` and `path.svg`, and its text.

mod text;

use super::folder::ResultFolder;
use super::numbers::shortest;
use super::plot::canvas::{LineStyle, TextAnchor, TextStyle};
use super::plot::colour::PALETTE;
use super::plot::deflection::structure_panel;
use super::plot::picture::{Glyph, Panel, Picture, PictureAxis, PictureSeries, equally_scaled};
use super::plot::{extent, over_time};
use super::records;
use crate::case::schema::Case;
use crate::discrete::System;
use crate::discrete::quantities::{FieldAxis, Observable, PlacedNodes, QuantityRole};
use crate::error::Result;
use crate::numerics::Planar;
use crate::results;
use crate::results::equilibrium::{self as kept, EquilibriumPath, NamedNumbers};
use crate::results::run::{Bands, Status};
use crate::run::equilibrium::{
    EquilibriumEvent, EquilibriumOptions, EquilibriumSensitivity, EquilibriumStability, EquilibriumState, EventKind,
    Path,
};
use crate::run::record::HistoryColumn;
use crate::run::summary::Accuracy;
use crate::study::refine::meshes::Meshes;

pub use text::describe;

/// One row per state.
pub const CSV: &str = "path.csv";
/// Positions of all nodes, two columns per state.
pub const SHAPES: &str = "shapes.csv";
/// The last state and the path to it.
pub const JSON: &str = "equilibrium.json";
/// Load factor over displacement, and shapes.
pub const PICTURE: &str = "path.svg";

/// Largest number of shapes in the picture.
const DRAWN: usize = 16;

/// A load path with its context.
pub struct LoadPath<'a> {
    /// The case.
    pub case: &'a Case,
    /// Requested options.
    pub options: &'a EquilibriumOptions,
    /// The path.
    pub path: &'a Path,
    /// Columns of its states.
    pub columns: &'a [HistoryColumn],
    /// Wall time [s].
    pub wall_s: f64,
    /// Warnings.
    pub warnings: &'a [String],
    /// Derivatives of the last state's columns with respect to parameters of the case.
    pub sensitivities: &'a [EquilibriumSensitivity],
    /// Estimated errors, if an accuracy was requested.
    pub accuracy: Option<&'a Accuracy>,
    /// Effect of the mesh on the last state, if no accuracy was requested.
    pub meshes: Option<&'a Meshes>,
    /// Uncertainty bands of the last state.
    pub bands: Bands,
}

/// The text of `equilibrium.json`.
pub fn json(found: &LoadPath) -> String {
    let path = found.path;
    let keyed = |values: &[f64]| -> NamedNumbers {
        let pairs = found.columns.iter().zip(values).skip(1);
        pairs.map(|(column, value)| (column.key(), Some(*value))).collect()
    };
    let last = path.states.last();
    let stability = |s: &EquilibriumStability| kept::StabilityRecord {
        stable: s.unstable == 0,
        unstable_modes: s.unstable,
        softest_1_s2: s.softest,
    };
    let several = !found.options.via_s.is_empty();
    let event = |e: &EquilibriumEvent| kept::PathEvent {
        load_factor: e.load_factor(),
        stage: several.then_some(e.stage + 1),
        what: e.describe().into(),
    };
    let derivatives = |s: &EquilibriumSensitivity| {
        let (value, derivatives) = (s.parameter.value, keyed(&s.row));
        (
            s.parameter.pointer.clone(),
            kept::EquilibriumDerivatives { value, derivatives },
        )
    };
    results::text(&EquilibriumPath {
        case: found.case.name.clone(),
        status: path.fault.as_ref().map_or(Status::Finished, |_| Status::Failed),
        reason: path.fault.as_ref().map(|f| f.what.clone()),
        loads_at_s: found.options.at_s,
        via_s: found.options.via_s.clone(),
        valves_s: found.options.valves_s.clone(),
        load_factor: last.map(EquilibriumState::load_factor),
        states: path.states.len(),
        quantities: last.map(|s| keyed(&s.row)),
        bands: found.bands.clone(),
        stability: last.and_then(|s| s.stability.as_ref()).map(stability),
        events: path.events.iter().map(event).collect(),
        sensitivities: found.sensitivities.iter().map(derivatives).collect(),
        solver: kept::PathWork {
            newton_iterations: path.work.iterations,
            residual_evaluations: path.work.residual_evaluations,
            factorizations: path.work.factorizations,
            rejected_steps: path.rejected,
            largest_correction_left: path.work.correction,
        },
        wall_s: kept::WallRecord { total: found.wall_s },
        warnings: found.warnings.to_vec(),
        accuracy: found.accuracy.cloned(),
        meshes: found.meshes.cloned(),
    })
}

/// Writes the files into a folder; other files in it stay.
pub fn write(folder: &mut ResultFolder, found: &LoadPath) -> Result<()> {
    let system = System::new(found.case)?;
    let (theta, placed) = (FieldAxis::Nodes.values(&system, 0.0), PlacedNodes::new(&system));
    let shapes = shapes(found, &theta, placed.as_ref());
    let files = vec![(CSV, table(found)), (SHAPES, shapes), (JSON, json(found))];
    let picture = (PICTURE, drawn(found, &theta, placed.as_ref()));
    folder.fill_with(&found.case.written(), files, picture)
}

/// One row per state, with its stage (from 1) if there are several.
fn table(found: &LoadPath) -> String {
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

/// One row per node: `theta [m]`, then x and z of every state. In a structure the name of the beam precedes them, and x and z are along the
/// axes of the case.
fn shapes(found: &LoadPath, theta: &[f64], placed: Option<&PlacedNodes>) -> String {
    let states = &found.path.states;
    let shares = states.iter().map(|state| shortest(state.load_factor()));
    let columns = shares.flat_map(|share| [format!("x at {share} [m]"), format!("z at {share} [m]")]);
    let nodes = states.first().map_or(0, |s| s.u1.len());
    let name = |beam: usize| found.case.beams[beam].name.clone();
    let rows = (0..nodes).map(|i| {
        let places = states.iter().flat_map(|state| match placed {
            None => [state.u1[i], theta[i] + state.u3[i]],
            Some(placed) => {
                let at = placed.position(
                    i,
                    Planar {
                        x: state.u1[i],
                        z: state.u3[i],
                    },
                );
                [at.x, at.z]
            }
        });
        let numbers = [theta[i]].into_iter().chain(places).map(shortest);
        placed
            .map(|placed| name(placed.beam[i]))
            .into_iter()
            .chain(numbers)
            .collect()
    });
    let first = placed
        .map(|_| "beam".to_owned())
        .into_iter()
        .chain(["theta [m]".into()]);
    records::text(first.chain(columns), rows)
}

/// Description of the loads.
fn about(options: &EquilibriumOptions) -> String {
    let all = options.via_s.iter().chain([&options.at_s]);
    let instants: Vec<String> = all.map(|at| format!("{} s", shortest(*at))).collect();
    match instants.as_slice() {
        [at] => format!("all loads grown together to those at t = {at}"),
        _ => format!("loads at t = {}, one after the other", instants.join(", ")),
    }
}

/// Picture of the load factor over displacement (solid where stable), and of shapes along the path.
fn drawn(found: &LoadPath, theta: &[f64], placed: Option<&PlacedNodes>) -> Option<String> {
    let states = &found.path.states;
    let stable = |k: usize| states[k].stability.as_ref().is_none_or(|s| s.unstable == 0);
    // of probes only the deflection, since ends may be held
    let shown = |name: &str| match Observable::named(name) {
        Some(one) => one.role() == QuantityRole::Headline,
        None => name.ends_with("_u1"),
    };
    let nearest = |share: f64| {
        let far = |k: &usize| (states[*k].load_factor() - share).abs();
        (0..states.len()).min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0)
    };
    let over = |(k, column): (usize, &HistoryColumn)| {
        let points: Vec<_> = states.iter().map(|s| (s.row[k], s.load_factor())).collect();
        let mut series: Vec<_> = (1..points.len())
            .map(|k| {
                let stroke = match stable(k - 1) && stable(k) {
                    true => LineStyle::solid(PALETTE[0], 1.8),
                    false => LineStyle::dashed(PALETTE[1], 1.8, (3.0, 3.0)),
                };
                PictureSeries::line(points[k - 1..=k].iter().copied(), stroke)
            })
            .collect();
        series.push(PictureSeries::marks(
            points.iter().copied(),
            Glyph::Square(1.4),
            PALETTE[0],
        ));
        for event in &found.path.events {
            let letter = match event.kind {
                EventKind::LimitPoint => "L",
                EventKind::Bifurcation => "B",
            };
            let at = points[nearest(event.load_factor())];
            series.push(PictureSeries::marks([at], Glyph::Box(4.0), PALETTE[3]));
            series.push(PictureSeries::label(
                at,
                (8.0, -8.0),
                letter,
                TextStyle::new(11.0, TextAnchor::Left),
            ));
        }
        let moves = points.iter().any(|p| p.0.abs() > 0.0);
        let x = PictureAxis::new(column.name.replace('_', " "), column.unit, 4);
        moves.then(|| Panel::new((200.0, 240.0), x, PictureAxis::new("load factor", "1", 6), series))
    };
    let curves = found.columns.iter().enumerate().filter(|(_, c)| shown(&c.name));
    let panels: Vec<Panel> = curves.filter_map(over).collect();
    if states.len() < 2 || panels.is_empty() {
        return None;
    }
    let width = 230.0 * panels.len().max(2) as f64 - 30.0;
    let rows = [
        Some(panels),
        shapes_drawn(found, theta, placed, width).map(|panel| vec![panel]),
    ];
    let picture = Picture {
        title: format!("{} · equilibria", found.case.name),
        about: about(found.options),
        rows: rows.into_iter().flatten().collect(),
    };
    picture.svg()
}

/// Some shapes of the path, from blue to red, with equal scales along and across.
fn shapes_drawn(found: &LoadPath, theta: &[f64], placed: Option<&PlacedNodes>, width: f64) -> Option<Panel> {
    let states = &found.path.states;
    let chosen: Vec<&EquilibriumState> = states
        .iter()
        .rev()
        .step_by(states.len().div_ceil(DRAWN).max(1))
        .collect();
    let shape = |state: &EquilibriumState| -> Vec<(f64, f64)> {
        let all = state.u1.iter().zip(&state.u3).zip(theta);
        match placed {
            None => all.map(|((u1, u3), theta)| (theta + u3, *u1)).collect(),
            Some(placed) => placed.line(&state.u1, &state.u3),
        }
    };
    let shapes: Vec<_> = chosen.into_iter().rev().map(shape).collect();
    let places: Vec<f64> = (0..shapes.len()).map(|k| k as f64).collect();
    let legend = "squares: states; dashed: unstable; B bifurcation, L limit point";
    if let Some(placed) = placed {
        let panel = structure_panel(placed, over_time(&places, shapes), width)?;
        return Some(panel.headed(format!(
            "shape, blue at rest, red at the end of the path, dashed straight; {legend}"
        )));
    }
    let over = |of: fn(&(f64, f64)) -> f64| extent(shapes.iter().flatten().map(of));
    let (z, x, height) = equally_scaled(over(|p| p.0)?, over(|p| p.1)?, width);
    let name = "shape: z = θ + u₃; blue at rest, red at the end of the path";
    let z = PictureAxis::new(name, "m", 8).between(z.0, z.1);
    let x = PictureAxis::new("x = u₁", "m", ((height / 34.0) as usize).max(3)).between(x.0, x.1);
    let panel = Panel::new((width, height), z, x, over_time(&places, shapes));
    Some(panel.headed(legend))
}
