//! Tubes and turbines as lines beside the beam: half ellipses with the length of the tube if both ends are on one side.

use std::f64::consts::PI;

use super::bladders::CutoutLayout;
use super::curve::Curve;
use super::cutout::Cutout;
use super::surface::{Data, Surface};
use crate::case::Case;
use crate::case::schema::BladderEnd;
use crate::case::wiring::bladder_index;
use crate::model::Wet;
use crate::model::network::{LinkKind, NetworkNode};

/// Number of points of a line.
const POINTS: usize = 13;

/// A place fixed to the beam: material coordinate, height and distance across from the reference curve [m].
type Place = [f64; 3];

/// A line between two places.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TubeArc {
    /// Points of the line; only the ends if it joins two parts of a structure.
    line: Vec<Place>,
    /// Parts of its ends.
    parts: [usize; 2],
    /// Length of the tube [m].
    length: f64,
    /// Recorded fluid cells at its ends; none at a junction or port.
    cells: Vec<usize>,
    network: i32,
    turbine: bool,
}

/// All tubes and turbines of a network, including rectified ones. Omits a link with an end that is neither at a bladder nor joined to one.
pub(super) fn all(case: &Case, wet: &Wet, cutouts: &[&Cutout], layout: &CutoutLayout) -> Vec<TubeArc> {
    let network = &wet.network;
    let drawn = |kind: &LinkKind| !matches!(kind, LinkKind::Opening);
    let links = network.links.iter().map(|l| (l.from, l.to, l.kind));
    let bridges = network
        .bridges
        .iter()
        .map(|b| (b.from, b.to, LinkKind::Turbine(b.turbine)));
    let joints: Vec<(NetworkNode, NetworkNode, LinkKind)> = links.chain(bridges).collect();
    let length = case.tubes.as_ref().map_or(0.0, |t| t.length_m);
    let mouth = |node: NetworkNode| mouth(node, wet, cutouts, layout);
    let place = |node: NetworkNode| {
        mouth(node).map(|m| m.0).or_else(|| {
            // A junction or port lies outside the mouths to which it is joined.
            let others = joints
                .iter()
                .filter_map(|(a, b, _)| (*a == node).then_some(*b).or((*b == node).then_some(*a)));
            let mouths: Vec<(usize, Place)> = others.filter_map(mouth).map(|m| m.0).collect();
            let part = mouths.first()?.0;
            let mouths: Vec<Place> = mouths.into_iter().filter(|m| m.0 == part).map(|m| m.1).collect();
            let mean = |k: usize| mouths.iter().map(|m| m[k]).sum::<f64>() / mouths.len() as f64;
            let outside = |across: f64| across + across.signum() * 0.5 * length;
            Some((part, [mean(0), mean(1), outside(mean(2))]))
        })
    };
    let tube = |(from, to, kind): &(NetworkNode, NetworkNode, LinkKind)| {
        let ends = [*from, *to];
        let [(first, start), (second, end)] = [place(*from)?, place(*to)?];
        let line = if first == second {
            arc(start, end, length)
        } else {
            vec![start, end]
        };
        Some(TubeArc {
            line,
            parts: [first, second],
            length,
            cells: ends.into_iter().filter_map(mouth).map(|m| m.1).collect(),
            network: ends.into_iter().find_map(|n| network.component_of(n)).unwrap_or(0) as i32 + 1,
            turbine: matches!(kind, LinkKind::Turbine(_)),
        })
    };
    joints.iter().filter(|j| drawn(&j.2)).filter_map(tube).collect()
}

/// Place at which a bladder's end meets the beam's side, with its part, and the outermost fluid cell there.
fn mouth(node: NetworkNode, wet: &Wet, cutouts: &[&Cutout], layout: &CutoutLayout) -> Option<((usize, Place), usize)> {
    let NetworkNode::Cell { bladder, end } = node else {
        return None;
    };
    let owner = layout
        .bladders
        .iter()
        .find(|b| bladder_index(b.label, wet.per_row) == Some(bladder))?;
    let windows = cutouts.iter().map(|cutout| cutout.window(owner.label));
    let (part, window) = windows.enumerate().find_map(|(part, window)| Some((part, window?)))?;
    let cutout = cutouts[part];
    let height = 0.5 * (cutout.row[0] + cutout.row[1]) * owner.label.signum() as f64;
    let (side, cell) = match end {
        BladderEnd::Inlet => (owner.inlet, owner.first),
        BladderEnd::Outlet => (-owner.inlet, owner.first + layout.cells - 1),
    };
    let place = [0.5 * (window[0] + window[1]), height, side * cutout.half_width];
    Some(((part, place), cell))
}

/// Points from one place to another. On one side of the beam the line bulges outwards to the tube's length; between sides it is straight.
fn arc(from: Place, to: Place, length: f64) -> Vec<Place> {
    let distance = (0..3).map(|k| (to[k] - from[k]).powi(2)).sum::<f64>().sqrt();
    let half = 0.5 * distance;
    // Perimeter of an ellipse with half axes a, b: nearly 2 pi sqrt((a^2 + b^2)/2).
    let bulge = (2.0 * (length / PI).powi(2) - half * half)
        .max(0.04 * half * half)
        .sqrt();
    let bulge = if from[2] * to[2] > 0.0 {
        bulge * from[2].signum()
    } else {
        0.0
    };
    let point = |i: usize| {
        let turn = PI * i as f64 / (POINTS - 1) as f64;
        let share = 0.5 - 0.5 * turn.cos();
        let mut p = [0, 1, 2].map(|k| from[k] + share * (to[k] - from[k]));
        p[2] += bulge * turn.sin();
        p
    };
    (0..POINTS).map(point).collect()
}

/// Lines of the tubes. The pressure of a line is the mean over the fluid cells that it joins [Pa].
pub(super) fn lines(tubes: &[TubeArc], curves: &[Curve], pressure: &[f64]) -> Surface {
    let mut out = Surface::default();
    for tube in tubes {
        let first = out.points.len();
        let [start, end] = tube.parts;
        let at = |part: usize, p: &Place| curves[part].at(p[0]).point(p[1], p[2]);
        match (start == end, tube.line.as_slice()) {
            (false, [from, to]) => out.points.extend(arc(at(start, from), at(end, to), tube.length)),
            (_, line) => out.points.extend(line.iter().map(|p| at(start, p))),
        }
        out.lines.push((first..out.points.len()).collect());
    }
    let mean = |t: &TubeArc| t.cells.iter().map(|&c| pressure[c]).sum::<f64>() / t.cells.len() as f64;
    out.of_cells = vec![
        Data::scalar("pressure_pa", tubes.iter().map(mean).collect()),
        Data::number("network", tubes.iter().map(|t| t.network).collect()),
        Data::number("turbine", tubes.iter().map(|t| i32::from(t.turbine)).collect()),
    ];
    out
}
