//! Discretization of each beam by itself, and of all beams of a structure together.

use super::quantities::MeshProbe;
use super::{
    BeamMesh, ContactPoint, MeshSections, MeshedAttachment, MeshedBody, SampledLoad, System, Workspace, sampled_load,
    smooth_parts,
};
use crate::case::schema::Case;
use crate::case::spans;
use crate::model::structure::BeamOfStructure;
use crate::model::{Model, Structure};
use crate::numerics::{Planar, Scalar};

/// Parts of a system that belong to the nodes and cells of beams.
pub struct BeamParts {
    /// Mesh.
    pub mesh: BeamMesh,
    /// Sections of cells and nodes.
    pub sections: MeshSections,
    /// Distributed loads.
    pub loads: Vec<SampledLoad>,
    /// Attachments.
    pub attached: Vec<MeshedAttachment>,
    /// Bodies with rotary inertia.
    pub bodies: Vec<MeshedBody>,
    /// Contact points.
    pub touching: Vec<ContactPoint>,
    /// Stiffness of the foundation at the nodes.
    pub foundation: Vec<[f64; 2]>,
    /// Recorded places.
    pub probes: Vec<MeshProbe>,
    /// Masses of the nodes [kg].
    pub masses: Vec<f64>,
    /// Lengths over which mass and surroundings act on the nodes [m].
    pub lengths: Vec<f64>,
}

impl BeamParts {
    /// Beams of a model.
    pub fn new(case: &Case, model: &Model) -> Self {
        let structure = model.structure.as_ref();
        structure
            .and_then(|structure| Self::of_structure(structure, model))
            .unwrap_or_else(|| Self::of_beam(case, model))
    }

    fn of_beam(case: &Case, model: &Model) -> Self {
        let lengths = spans::segment_lengths(case);
        let jumps = smooth_parts::jumps(case, model, &lengths);
        let order = match smooth_parts::is_steep(model) {
            true => 2,
            false => case.mesh.order(),
        };
        let mesh = BeamMesh::new(model.length, lengths, case.mesh.cells_per_segment)
            .divided(&jumps)
            .of_order(order);
        Self::on_mesh(case, model, mesh)
    }

    fn on_mesh(case: &Case, model: &Model, mesh: BeamMesh) -> Self {
        let sections = MeshSections::new(model, &mesh);
        let loads = model.loads.iter();
        let loads = loads
            .map(|load| SampledLoad::new(load, model, &sections, &mesh))
            .collect();
        let mut lengths = mesh.node_lengths.clone();
        mesh.lump(&mut lengths);
        let (attached, masses) = MeshedAttachment::all(&model.attachments, &sections, &mesh, &lengths);
        Self {
            loads,
            attached,
            masses,
            bodies: MeshedBody::all(&model.attachments, model.root_and_tip(), model.kinematics, &mesh),
            touching: ContactPoint::all(model, &sections, &mesh),
            foundation: sampled_load::foundation(model, &mesh),
            probes: MeshProbe::all(case, &mesh, &sections),
            lengths,
            sections,
            mesh,
        }
    }

    /// Beams of a structure, one after the other. Signals are those of the whole model.
    fn of_structure(structure: &Structure, model: &Model) -> Option<Self> {
        let one = |beam: &BeamOfStructure| {
            let mut own = beam.model.clone();
            own.effects = model.effects.clone();
            own.loads = model.loads[beam.of_structure[0].clone()].to_vec();
            own.attachments = model.attachments[beam.of_structure[1].clone()].to_vec();
            own.contacts = model.contacts[beam.of_structure[2].clone()].to_vec();
            let lengths = spans::segment_lengths(&beam.case);
            let portion = [beam.piece.from, beam.piece.length].map(|length| length / beam.whole);
            let mesh = BeamMesh::new(own.length, lengths, beam.case.mesh.cells_per_segment);
            let jumps = smooth_parts::jumps(&beam.case, &own, &mesh.segment_lengths);
            let mut parts = Self::on_mesh(&beam.case, &own, mesh.divided(&jumps).of_order(2).portion(portion));
            let along = |share: f64| portion[0] + share * portion[1];
            parts.probes.iter_mut().for_each(|probe| probe.at = along(probe.at));
            if beam.piece.at_end[1] {
                let tip = MeshProbe::at_tip(&beam.name, &parts.mesh, &parts.sections);
                parts.probes.push(tip);
            }
            parts
        };
        let each: Vec<Self> = structure.beams.iter().map(one).collect();
        let mut before = [0, 0];
        let moved = each.into_iter().zip(&structure.beams).map(|(next, beam)| {
            let [_, attachments, contacts] = &beam.of_structure;
            let own = [next.mesh.nodes, next.mesh.segments];
            let next = next.moved(before, [attachments.start, contacts.start]);
            before = [before[0] + own[0], before[1] + own[1]];
            next
        });
        let mut joined = moved.reduce(Self::followed_by)?;
        joined.attached.sort_by_key(|attached| attached.node);
        Some(joined)
    }

    /// The same on a mesh in which its first node has another number, with the numbers of the first attachment and the first contact.
    fn moved(mut self, [nodes, segments]: [usize; 2], [attachment, contact]: [usize; 2]) -> Self {
        self.loads.iter_mut().for_each(|load| load.first += nodes);
        self.attached.iter_mut().for_each(|one| one.shift(nodes, attachment));
        self.bodies.iter_mut().for_each(|one| one.shift(nodes, attachment));
        self.touching.iter_mut().for_each(|one| one.shift(nodes, contact));
        self.probes.iter_mut().for_each(|one| one.shift(nodes, segments));
        self
    }

    /// The same, followed by those of another beam.
    fn followed_by(mut self, next: Self) -> Self {
        self.sections.append(next.sections, self.mesh.nodes);
        self.mesh = self.mesh.followed_by(next.mesh);
        self.loads.extend(next.loads);
        self.attached.extend(next.attached);
        self.bodies.extend(next.bodies);
        self.touching.extend(next.touching);
        self.foundation.extend(next.foundation);
        self.probes.extend(next.probes);
        self.masses.extend(next.masses);
        self.lengths.extend(next.lengths);
        self
    }
}

/// Position of a node of the straight beam or structure in the axes of the case [m].
pub fn rest_position(model: &Model, mesh: &BeamMesh, node: usize) -> Planar<f64> {
    let along = Planar {
        x: 0.0,
        z: mesh.node_coordinate(node),
    };
    match &model.structure {
        None => along,
        Some(structure) => {
            let piece = &structure.beams[mesh.beam_of_node(node)].piece;
            piece.origin + piece.turned(along)
        }
    }
}

impl System {
    /// Position of a node of the straight beam or structure in the axes of the case [m].
    pub fn rest_position(&self, node: usize) -> Planar<f64> {
        rest_position(&self.model, &self.mesh, node)
    }

    /// Part of the mesh whose tip is that of the beam, in a structure that of its first beam.
    pub fn first_tip(&self) -> usize {
        let structure = self.model.structure.as_ref();
        structure.map_or(0, |structure| {
            let tip = structure.beams.iter().position(|beam| beam.piece.at_end[1]);
            tip.unwrap_or(0)
        })
    }

    /// Position of a node in the axes of the case [m].
    pub fn position(&self, w: &Workspace<f64>, node: usize) -> Planar<f64> {
        self.place(&w.motion.u, node)
    }

    /// Position of a node in the axes of the case [m], from the displacements of all nodes.
    pub fn place<T: Scalar>(&self, u: &[Planar<T>], node: usize) -> Planar<T> {
        Planar::constant(self.rest_position(node)) + self.in_axes_of_case(node, u[node])
    }

    /// A vector at a node along the axes of the case, from that along the axes of its beam.
    pub fn in_axes_of_case<T: Scalar>(&self, node: usize, v: Planar<T>) -> Planar<T> {
        match &self.model.structure {
            None => v,
            Some(structure) => structure.beams[self.mesh.beam_of_node(node)].piece.turned(v),
        }
    }

    /// A vector at a node along the axes of its beam, from that along the axes of the case.
    pub fn in_axes_of_beam<T: Scalar>(&self, node: usize, v: Planar<T>) -> Planar<T> {
        match &self.model.structure {
            None => v,
            Some(structure) => structure.beams[self.mesh.beam_of_node(node)].piece.own(v),
        }
    }
}
