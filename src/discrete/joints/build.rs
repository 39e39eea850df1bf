//! Joints of a model on a mesh.

use super::{JointAngle, MeshHinge, MeshJoints, MeshedElasticJoint, Tie};
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::discrete::BeamMesh;
use crate::model::{Model, Structure};
use crate::numerics::Planar;

/// Distance of places, relative to the length of the mesh's cells, that counts as rounding.
const NEAR: f64 = 1e-9;

impl MeshJoints {
    /// Joints of a model on the joined mesh.
    pub fn new(model: &Model, mesh: &BeamMesh) -> Self {
        let Some(structure) = &model.structure else {
            return Self::default();
        };
        let mut all = Self {
            of_ends: vec![None; model.ends.len()],
            joined: vec![false; model.ends.len()],
            ..Self::default()
        };
        let ends: Vec<_> = mesh.ends().map(|(_, end)| end).collect();
        for (k, end) in model.ends.iter().enumerate() {
            for (axis, motion) in [&end.transverse, &end.axial].into_iter().enumerate() {
                if matches!(motion, Translation::Displacement(_)) {
                    all.driven.push((k, ends[k].node, axis));
                }
            }
        }
        let inertia = model.effects.has(Effect::SolidInertia);
        for (number, joint) in structure.joints.iter().enumerate() {
            let Some(first) = joint.ends().next() else { continue };
            joint.ends().for_each(|end| all.joined[end] = true);
            let resists = joint
                .hinge
                .filter(|hinge| hinge.stiffness_n_m_rad > 0.0 || hinge.damping_n_m_s_rad > 0.0 || hinge.stop.is_some());
            let elastic = joint.elastic.is_some();
            let losing = resists.is_some_and(|hinge| hinge.damping_n_m_s_rad > 0.0)
                || joint.elastic.is_some_and(|law| law.damping[2][2] > 0.0);
            let viscous = |group: &[usize]| {
                let mut sections = group.iter().map(|end| &structure.beams[end / 2].model.section);
                sections.any(|section| section.bends_viscously())
            };
            let slides = joint.elastic.is_some_and(|law| law.damps_motion());
            let inertia_of_joint = match joint.groups.first() {
                Some(own) if slides && joint.inertia == 0.0 && !viscous(own) => half_cell(structure, mesh, first),
                _ => joint.inertia,
            };
            let arms = |group: &[usize]| group.iter().any(|end| arm(structure, mesh, first, *end).is_some());
            let inertia_of = |k: usize| if k == 0 { inertia_of_joint } else { 0.0 };
            let moves = |k: usize, group: &[usize]| inertia && (inertia_of(k) > 0.0 || (!elastic && arms(group)));
            let mut groups = joint.groups.iter().enumerate();
            // otherwise the damper depends on differences of unknown rates alone
            let regular = groups.any(|(k, group)| moves(k, group) || viscous(group));
            let mut numbers: Vec<usize> = vec![];
            for (k, group) in joint.groups.iter().enumerate() {
                if group.len() < 2 && resists.is_none() && !elastic && inertia_of(k) == 0.0 {
                    continue; // a free end
                }
                let angle = all.angles.len();
                let relative_to = numbers.first().copied().filter(|_| losing && !regular);
                numbers.push(angle);
                for end in group {
                    all.of_ends[*end] = Some(angle);
                }
                all.angles.push(JointAngle {
                    joint: number,
                    inertia: inertia_of(k),
                    ends: group.iter().map(|end| (ends[*end].node, -ends[*end].outward)).collect(),
                    moves: moves(k, group),
                    relative_to,
                    damped: viscous(group) || (losing && (regular || relative_to.is_some())),
                });
            }
            if let (Some(law), [first, others @ ..]) = (resists, &numbers[..]) {
                all.hinges.extend(others.iter().map(|other| MeshHinge {
                    joint: number,
                    angles: [*first, *other],
                    law,
                }));
            }
            let turn = |from: usize, to: usize| {
                let [from, to] = [from, to].map(|end| structure.beams[end / 2].piece.angle);
                Planar::tangent(from - to)
            };
            let firsts = joint.groups.iter().filter_map(|group| group.first().copied());
            if let (Some(law), [own, others @ ..]) = (joint.elastic, &numbers[..]) {
                all.elastic
                    .extend(others.iter().zip(firsts.clone().skip(1)).map(|(other, end)| {
                        MeshedElasticJoint {
                            joint: number,
                            nodes: [ends[first].node, ends[end].node],
                            angles: [*own, *other],
                            turn: turn(end, first),
                            apart: structure.beams[first / 2]
                                .piece
                                .own(structure.place_of(end) - structure.place_of(first)),
                            law,
                        }
                    }));
            }
            for (group, of_group) in joint.groups.iter().zip(firsts) {
                let to = if elastic { of_group } else { first };
                for end in group.iter().copied().filter(|end| *end != to) {
                    all.ties.push(Tie {
                        node: ends[end].node,
                        to: ends[to].node,
                        turn: turn(to, end),
                        arm: all.of_ends[end].zip(arm(structure, mesh, to, end)),
                    });
                }
            }
        }
        all
    }
}

/// Rotary inertia of the half cell beside an end [kg m^2]. It turns with an elastic joint that damps displacements: their rate depends on
/// the turning of the joint by the distance of both places, so little that a massless angle would be neither given by its balance nor by
/// its rate.
fn half_cell(structure: &Structure, mesh: &BeamMesh, end: usize) -> f64 {
    let (beam, place) = (&structure.beams[end / 2], mesh.beams[end / 2].ends()[end % 2]);
    beam.model.section.mass_per_length * mesh.lengths[place.cell].powi(3) / 24.0
}

/// Arm from the first end of a joint to another one, along the axes of its beam [m]; none if both are at one place.
fn arm(structure: &Structure, mesh: &BeamMesh, first: usize, end: usize) -> Option<Planar<f64>> {
    let apart = structure.place_of(end) - structure.place_of(first);
    let near = apart.squared().sqrt() <= NEAR * mesh.shortest;
    (!near).then(|| structure.beams[end / 2].piece.own(apart))
}
