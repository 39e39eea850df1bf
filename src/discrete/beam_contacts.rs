//! Contact of beams with each other and of a beam with itself, on a mesh.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use super::cell_boxes::CellBoxes;
use super::ledger::EnergyRate;
use super::structure::rest_position;
use super::{BeamMesh, MeshSections, System, Workspace};
use crate::model::contact::{ContactForces, PressingLaw};
use crate::model::{BeamContactLaw, Model};
use crate::numerics::{Planar, Scalar};

/// Distance below which the normal of two lines fades, relative to the distance at which they touch.
const CORE: f64 = 1e-8;

/// `[E107]` Contact of beams: every node x with half its length presses on the nearest point of the other beam's line, straight between
/// its nodes,
///
/// ```text
/// g = r + r_c - |x - x̄|      x̄ = (1 - s) x_c + s x_{c+1} nearest to x      n = (x - x̄)/|x - x̄|
/// f_i = h_i/2 f(g, n, v - v̄), [E61]      f_c loses (1 - s) f_i, f_{c+1} loses s f_i      E gains h_i/2 k S(g)
/// ```
///
/// and the nodes of the other beam on this one alike. s minimizes the distance, so that these forces are derivatives of E. Friction acts on
/// the lines, not on the surfaces: its moment about the place of contact is left out.
#[derive(Clone, Debug)]
pub struct MeshBeamContact {
    law: PressingLaw,
    points: Vec<TouchingNode>,
}

/// A node with the cells that it can touch.
#[derive(Clone, Debug)]
struct TouchingNode {
    node: usize,
    /// Half the length of the node [m].
    measure: f64,
    cells: Vec<Range<usize>>,
}

/// Nearest point of a cell.
struct Touch<T> {
    depth: T,
    normal: Planar<T>,
    s: T,
}

/// Result of a contact of beams.
pub struct BeamContactResult {
    /// Sum of the forces normal to the lines [N].
    pub normal: f64,
    /// Largest depth [m]; if negative, the smallest distance of surfaces.
    pub depth: f64,
}

/// Beams and places of nodes in the straight structure.
struct Places<'a> {
    model: &'a Model,
    mesh: &'a BeamMesh,
    sections: &'a MeshSections,
}

impl Places<'_> {
    /// Number of the beam of a node, common to its pieces.
    fn beam(&self, node: usize) -> usize {
        let piece = self.mesh.beam_of_node(node);
        self.model
            .structure
            .as_ref()
            .map_or(0, |structure| structure.beams[piece].piece.beam)
    }

    fn name(&self, node: usize) -> Option<&str> {
        let piece = self.mesh.beam_of_node(node);
        Some(&self.model.structure.as_ref()?.beams[piece].name)
    }

    fn at(&self, node: usize) -> Planar<f64> {
        rest_position(self.model, self.mesh, node)
    }

    /// Place of a node along its whole beam [m].
    fn along(&self, node: usize) -> f64 {
        let piece = self.mesh.beam_of_node(node);
        let structure = self.model.structure.as_ref();
        let from = structure.map_or(0.0, |structure| structure.beams[piece].piece.from);
        from + self.mesh.node_coordinate(node)
    }

    /// Length of the way from one node to another along their beams, through a joint if the beams are two; none if no joint connects them [m].
    fn way(&self, one: usize, other: usize) -> Option<f64> {
        let beams = [self.beam(one), self.beam(other)];
        let within = (beams[0] == beams[1]).then(|| (self.along(one) - self.along(other)).abs());
        let joints = self.model.structure.iter().flat_map(|structure| &structure.joints);
        let ways = joints.filter_map(|joint| {
            let nearest = |node: usize, beam: usize| {
                let ends = joint.ends().map(|end| {
                    let both = self.mesh.beams[end / 2].ends();
                    both[end % 2].node
                });
                let own = ends.filter(|end| self.beam(*end) == beam);
                let ways = own.map(|end| ((self.along(node) - self.along(end)).abs(), end));
                ways.min_by(|a, b| a.0.total_cmp(&b.0))
            };
            let (near, far) = (nearest(one, beams[0])?, nearest(other, beams[1])?);
            Some(near.0 + far.0 + (self.at(near.1) - self.at(far.1)).squared().sqrt())
        });
        within.into_iter().chain(ways).reduce(f64::min)
    }

    /// True if a contact is that of these nodes' beams.
    fn concerns(&self, law: &BeamContactLaw, one: usize, other: usize) -> bool {
        let Some([a, b]) = &law.between else { return true };
        match [self.name(one), self.name(other)] {
            [Some(one), Some(other)] => (one, other) == (a, b) || (other, one) == (a, b),
            _ => true,
        }
    }

    /// Cells that a node can touch.
    fn cells(&self, law: &BeamContactLaw, node: usize) -> Vec<Range<usize>> {
        let fiber = &self.sections.farthest_fiber;
        let mut all: Vec<Range<usize>> = vec![];
        for cell in (0..self.mesh.cells).filter(|cell| !self.mesh.is_gap(*cell)) {
            if !self.concerns(law, node, cell) {
                continue;
            }
            let near = |end: usize| {
                let reach = fiber[node] + fiber[end];
                let apart = (self.at(end) - self.at(node)).squared().sqrt();
                // a way is no shorter than the straight line
                apart < 2.0 * reach
                    && self
                        .way(node, end)
                        .is_some_and(|way| way < FRAC_PI_2 * reach || apart < reach)
            };
            if near(cell) || near(cell + 1) {
                continue;
            }
            match all.last_mut().filter(|range| range.end == cell) {
                Some(range) => range.end = cell + 1,
                None => all.push(cell..cell + 1),
            }
        }
        all
    }
}

impl MeshBeamContact {
    /// Contacts of a model.
    pub fn all(model: &Model, mesh: &BeamMesh, sections: &MeshSections) -> Vec<Self> {
        let places = Places { model, mesh, sections };
        let of = |law: &BeamContactLaw| {
            let points = (0..mesh.nodes).map(|node| TouchingNode {
                node,
                measure: 0.5 * mesh.node_lengths[node],
                cells: places.cells(law, node),
            });
            Self {
                law: law.pressing,
                points: points.filter(|point| !point.cells.is_empty()).collect(),
            }
        };
        model.beam_contacts.iter().map(of).collect()
    }

    /// The deepest overlap of a node with a cell, and the cell [m].
    fn overlap(&self, system: &System, point: &TouchingNode, boxes: &CellBoxes) -> Option<(usize, f64)> {
        let own = |cell: &usize| point.cells.iter().any(|range| range.contains(cell));
        let near = boxes.near(boxes.places[point.node], system.sections.farthest_fiber[point.node]);
        Self::nearest(system, point.node, near.filter(own), &boxes.places, 0.0)
    }

    /// The nearest of some cells to a node, and the depth there [m]; none if it is not above `least`.
    fn nearest(
        system: &System,
        node: usize,
        cells: impl Iterator<Item = usize>,
        at: &[Planar<f64>],
        least: f64,
    ) -> Option<(usize, f64)> {
        let x = at[node];
        let mut found: Option<(usize, f64)> = None;
        for cell in cells {
            let [a, b] = [at[cell], at[cell + 1]];
            let reach = reach(system, node, cell);
            // no nearer than its middle less half its length
            let (middle, half) = ((a + b) * 0.5, 0.5 * (b - a).squared().sqrt());
            let deepest = reach - ((x - middle).squared().sqrt() - half);
            let bound = found.map_or(least, |(_, depth)| depth);
            if deepest < bound {
                continue;
            }
            let depth = touch(x, [a, b], reach).depth;
            // of equal ones the first, whatever the order of the cells
            let first = found.is_some_and(|(before, _)| depth == bound && cell < before);
            if depth > bound || first {
                found = Some((cell, depth));
            }
        }
        found
    }
}

/// Distance of two lines at which their surfaces touch [m].
fn reach(system: &System, node: usize, cell: usize) -> f64 {
    let fiber = &system.sections.farthest_fiber;
    fiber[node] + fiber[cell].max(fiber[cell + 1])
}

/// Depth of a point of a line beyond the distance `reach` from a cell, at the nearest point of the cell.
fn touch<T: Scalar>(x: Planar<T>, [a, b]: [Planar<T>; 2], reach: f64) -> Touch<T> {
    let along = b - a;
    let s = ((x - a).dot(along) / along.squared()).lift(|s| match s {
        s if s <= 0.0 => (0.0, 0.0),
        s if s >= 1.0 => (1.0, 0.0),
        s => (s, 1.0),
    });
    let off = x - a - along.times(s);
    let core = CORE * reach;
    let distance = (off.squared() + core * core).sqrt();
    Touch {
        depth: -distance + reach,
        normal: off.times(T::constant(1.0) / distance),
        s,
    }
}

/// Sets the forces of contacts on the nodes, elastic ones and those with losses.
pub fn forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    if system.beam_contacts.is_empty() {
        return;
    }
    let mut between = std::mem::take(&mut w.forces.between);
    between.fill([Planar::zero(); 2]);
    let symbolic = w.motion.u.first().is_some_and(|u| u.x.value().is_none());
    let mut boxes = std::mem::take(&mut w.forces.boxes);
    boxes.update(system, &w.motion.u);
    for contact in &system.beam_contacts {
        for point in &contact.points {
            if symbolic {
                let all = point.cells.iter().cloned().flatten();
                all.for_each(|cell| press(system, w, contact, point, cell, &mut between));
            } else if let Some((cell, _)) = contact.overlap(system, point, &boxes) {
                press(system, w, contact, point, cell, &mut between);
            }
        }
    }
    (w.forces.between, w.forces.boxes) = (between, boxes);
}

/// Forces of a node on a cell.
fn pressed<T: Scalar>(
    system: &System,
    w: &Workspace<T>,
    contact: &MeshBeamContact,
    node: usize,
    cell: usize,
) -> (ContactForces<T>, Touch<T>) {
    let ends = [cell, cell + 1];
    let at = |node: usize| system.place(&w.motion.u, node);
    let touch = touch(at(node), ends.map(at), reach(system, node, cell));
    let v = |node: usize| system.in_axes_of_case(node, w.motion.v[node]);
    let [a, b] = ends.map(v);
    let relative = v(node) - a - (b - a).times(touch.s);
    (contact.law.forces(touch.depth, touch.normal, relative), touch)
}

/// Adds the forces of a node on a cell, along the axes of their beams.
fn press<T: Scalar>(
    system: &System,
    w: &Workspace<T>,
    contact: &MeshBeamContact,
    point: &TouchingNode,
    cell: usize,
    between: &mut [[Planar<T>; 2]],
) {
    let (forces, touch) = pressed(system, w, contact, point.node, cell);
    let both = [forces.elastic, forces.damping + forces.friction].map(|force| force * point.measure);
    let shares = [(cell, touch.s - 1.0), (cell + 1, -touch.s)];
    for (k, force) in both.into_iter().enumerate() {
        between[point.node][k] += system.in_axes_of_beam(point.node, force);
        for (node, share) in shares {
            between[node][k] += system.in_axes_of_beam(node, force.times(share));
        }
    }
}

/// Passes the forces on a node to `each`, with the entry of the balance for their work; none for stored energy.
#[inline]
pub fn on_node<T: Scalar>(w: &Workspace<T>, node: usize, each: &mut impl FnMut(Option<EnergyRate>, Planar<T>)) {
    if let Some([elastic, lossy]) = w.forces.between.get(node) {
        each(None, *elastic);
        each(Some(EnergyRate::Damping), *lossy);
    }
}

/// Stored energy of all contacts [J].
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let mut energy = 0.0;
    visit(system, w, |contact, point, depth| {
        energy += point.measure * contact.law.energy(depth);
    });
    energy
}

/// Visits every node of a contact that overlaps another beam, with its depth [m].
fn visit(system: &System, w: &Workspace<f64>, mut each: impl FnMut(&MeshBeamContact, &TouchingNode, f64)) {
    for contact in &system.beam_contacts {
        for point in &contact.points {
            if let Some((_, depth)) = contact.overlap(system, point, &w.forces.boxes) {
                each(contact, point, depth);
            }
        }
    }
}

/// Result of the contact with this number.
pub fn felt(system: &System, w: &Workspace<f64>, number: usize) -> BeamContactResult {
    let contact = &system.beam_contacts[number];
    let mut felt = BeamContactResult {
        normal: 0.0,
        depth: f64::NEG_INFINITY,
    };
    for point in &contact.points {
        let (cells, at) = (point.cells.iter().cloned().flatten(), &w.forces.boxes.places);
        let nearest = MeshBeamContact::nearest(system, point.node, cells, at, f64::NEG_INFINITY);
        if let Some((cell, depth)) = nearest {
            felt.depth = felt.depth.max(depth);
            let (forces, touch) = pressed(system, w, contact, point.node, cell);
            felt.normal += point.measure * (forces.elastic + forces.damping).dot(touch.normal);
        }
    }
    felt
}

/// Largest depth of an overlap [m]; 0 without.
pub fn deepest(system: &System, w: &Workspace<f64>) -> f64 {
    let mut deepest = 0.0_f64;
    visit(system, w, |_, _, depth| deepest = deepest.max(depth));
    deepest
}
