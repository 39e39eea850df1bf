//! Smooth parts of a beam on a mesh of fourth order, and the weights of their stiffness.

use std::ops::Range;

use super::BeamMesh;
use super::sections::in_series;
use crate::case::schema::Case;
use crate::case::{Rotation, spans};
use crate::model::{Model, Section};

/// Largest ratio of stiffness or mass over half a cell of a taper that a mesh of fourth order resolves.
const STEEPEST: f64 = 1.5;

/// Segments at whose beginning sections or cell lengths jump, or a taper begins or ends.
pub fn jumps(case: &Case, model: &Model, segment_lengths: &[f64]) -> Vec<usize> {
    let places = spans::places(case);
    let span = |segment: usize| places.get(segment).map(|place| place.0);
    let graded = |segment: usize| model.within.get(segment).is_some_and(|within| !within.is_empty());
    let jumps = |segment: &usize| {
        let [before, here] = [*segment - 1, *segment];
        let alike = match [before, here].map(graded) {
            [false, false] => model.section_of(before) == model.section_of(here),
            [true, true] => span(before) == span(here),
            _ => false,
        };
        !alike || segment_lengths[before] != segment_lengths[here]
    };
    (1..segment_lengths.len()).filter(jumps).collect()
}

/// True if a taper changes stiffness or mass too much over a cell for a mesh of fourth order.
pub fn is_steep(model: &Model) -> bool {
    let values: [fn(&Section) -> f64; 4] = [
        |section| section.axial_stiffness,
        |section| section.bending_stiffness,
        Section::rotary_inertia,
        |section| section.mass_per_length,
    ];
    let mut steps = model.within.iter().flat_map(|within| within.windows(2));
    steps.any(|pair| {
        let ratio = |value: fn(&Section) -> f64| value(&pair[0]) / value(&pair[1]);
        values
            .into_iter()
            .map(ratio)
            .any(|ratio| ratio.max(1.0 / ratio) > STEEPEST)
    })
}

/// Weights of the moment at a node between two smooth parts, in EI times the mean curvature of that node, the one before and the one behind:
/// both sides have the same moment, and their mean curvatures add up to that of the node, [E77]. `lengths` are those of the cells,
/// `stiffness` those of the node and the next one on each side.
fn border_weights(lengths: [f64; 2], stiffness: [[f64; 2]; 2]) -> [f64; 3] {
    let halves = lengths.map(|length| 0.5 * length);
    let [left, right] = [0, 1].map(|side| {
        let [own, beside] = end_weights(stiffness[side]);
        let [at, next] = stiffness[side];
        [halves[side] * own / at, halves[side] * beside / next]
    });
    let own = left[0] + right[0];
    let mean = halves[0] / stiffness[0][0] + halves[1] / stiffness[1][0];
    [mean / own, -left[1] / own, -right[1] / own]
}

/// Weights of `M/EI` at an end and of e of its neighbor in the mean curvature e of the end, from the EI of both: 2/3 and 1/3 if equal.
fn end_weights([at, next]: [f64; 2]) -> [f64; 2] {
    [4.0 * at, at + next].map(|weight| weight / (7.0 * at - next))
}

/// Corrections of the moments at both nodes of a cell, each by the EI e of `[left, right]`.
type CellSteps = [[f64; 2]; 2];

/// Corrections in a cell inside of a taper, or beside a given slope, from EI at both nodes and the weight g.
fn steps(g: f64, [left, right]: [f64; 2]) -> CellSteps {
    let ratio = left / right;
    [
        [0.5 * g * (3.0 - 1.0 / ratio), -0.5 * g * (1.0 + ratio)],
        [-0.5 * g * (1.0 + 1.0 / ratio), 0.5 * g * (3.0 - ratio)],
    ]
}

/// Corrections of the moment beside an end by that of the end, which is given, and by its own value.
fn steps_beside_end([at, next]: [f64; 2]) -> [f64; 2] {
    let half = 0.5 / (7.0 * at - next);
    [
        -(at + next) * half,
        (5.0 * at * next - next * next - 2.0 * at * at) * half / next,
    ]
}

/// Means over the hat functions of the nodes of a smooth part, half of one at its ends, from the values at its nodes.
fn hat_means(values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    if values.iter().all(|value| *value == values[0]) {
        return values.to_vec();
    }
    let mean = |node: usize| match node {
        0 => 7.0 * values[0] + 6.0 * values[1] - values[2],
        _ if node == last => 7.0 * values[last] + 6.0 * values[last - 1] - values[last - 2],
        _ => values[node - 1] + 10.0 * values[node] + values[node + 1],
    };
    (0..=last).map(|node| mean(node) / 12.0).collect()
}

/// EI on a mesh of fourth order.
#[derive(Clone, Debug, Default)]
pub struct SmoothBending {
    /// [`border_weights`] of the nodes between parts.
    pub borders: Vec<[f64; 3]>,
    /// Corrections in each cell of a beam with tapers; empty without.
    pub steps: Vec<CellSteps>,
    /// For both ends of the beam, weights of `M/EI` of the end and of e of its neighbor, as in [`border_weights`].
    pub end_weights: [[f64; 2]; 2],
}

impl SmoothBending {
    /// From EI on both sides of each node. Also returns the mean of EI at each node, with both sides in series between two parts.
    pub fn new(model: &Model, mesh: &BeamMesh, sides: &[[f64; 2]]) -> (Self, Vec<f64>) {
        let of_part = |Range { start, end }: &Range<usize>| {
            let values = (*start..*end).map(|node| sides[node][1]).chain([sides[*end][0]]);
            hat_means(&values.collect::<Vec<f64>>())
        };
        let parts: Vec<Vec<f64>> = mesh.parts.iter().map(of_part).collect();
        let mut means = parts[0].clone();
        let mut borders = vec![];
        for (pair, range) in parts.windows(2).zip(&mesh.parts) {
            let node = range.end;
            let stiffness = [pair[0][range.len()], pair[1][0]];
            if let Some(mean) = means.last_mut() {
                *mean = in_series(stiffness, mesh.sides_of_node(node).1);
            }
            means.extend(&pair[1][1..]);
            let beside = [pair[0][range.len() - 1], pair[1][1]];
            borders.push(border_weights(
                [mesh.lengths[node - 1], mesh.lengths[node]],
                [0, 1].map(|side| [stiffness[side], beside[side]]),
            ));
        }
        let ends = [(0, 1), (mesh.cells, mesh.cells - 1)];
        let slope_given = [0, 1].map(|end| matches!(model.ends[end].rotation, Rotation::Slope(_)));
        let in_cell = |means: &[f64], at: usize, cell: usize| {
            let [left, right] = [means[at], means[at + 1]];
            let (first, last) = (at == 0, at + 2 == means.len());
            let given = (cell == 0 && slope_given[0]) || (cell + 1 == mesh.cells && slope_given[1]);
            match (first, last) {
                _ if given => steps(0.25, [left, right]),
                (true, _) => [[0.0; 2], steps_beside_end([left, right])],
                (_, true) => {
                    let [by_end, own] = steps_beside_end([right, left]);
                    [[own, by_end], [0.0; 2]]
                }
                _ => steps(1.0 / 6.0, [left, right]),
            }
        };
        let in_part = |(means, part): (&Vec<f64>, &Range<usize>)| -> Vec<CellSteps> {
            part.clone()
                .map(|cell| in_cell(means, cell - part.start, cell))
                .collect()
        };
        let bending = Self {
            end_weights: ends.map(|(end, beside)| end_weights([means[end], means[beside]])),
            steps: match model.within.is_empty() {
                true => vec![],
                false => parts.iter().zip(&mesh.parts).flat_map(in_part).collect(),
            },
            borders,
        };
        (bending, means)
    }
}
