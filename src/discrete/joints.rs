//! Joints of a structure on the mesh: ends of beams that share their motion, and the angles of joints.

use super::elastic_joints::MeshedElasticJoint;
use super::{BeamMesh, System, TimeData, Workspace};
use crate::case::Translation;
use crate::case::schema::{Effect, Hinge};
use crate::model::Model;
use crate::model::structure::{Structure, hinge_energy, hinge_moments};
use crate::numerics::{Planar, Scalar};

/// Distance of places, relative to the length of the mesh's cells, that counts as rounding.
const NEAR: f64 = 1e-9;

/// Joints of a structure; empty for a single beam.
///
/// `[E105]` A joined end follows the first end of its joint. With the rotation δ from the axes of its beam to those of the first, the angle φ
/// of the joint and the arm a from the first place to its own,
///
/// ```text
/// u = R(δ) u_1 + (R(φ) - 1) a      v = R(δ) v_1 + φ_t R'(φ) a      R(φ) (x, z) = (x cos φ + z sin φ, z cos φ - x sin φ)
/// ```
///
/// Forces return by the transpose: the equation of the first node gains `R(δ)ᵀ` times that of its own, the equation of the angle
/// `a·R'(φ)ᵀ` times it. Joined ends thus share their motion without multipliers, and the power of the joint is zero to rounding:
///
/// ```text
/// J φ_tt = Σ M_tip - Σ M_root ± M_hinge + arms        in a massless joint 0
/// ```
///
/// Curvatures of joined ends are those of [E11] with the angle of the joint as their slope. Two beams in one line, joined rigidly, have the
/// equations of one beam, but for bending viscosity between unlike pressures, where they agree to first order in the cells.
#[derive(Clone, Debug, Default)]
pub struct MeshJoints {
    /// Ends that follow the first end of their joint.
    pub ties: Vec<Tie>,
    /// Angles of joints.
    pub angles: Vec<JointAngle>,
    /// Hinges with moments.
    pub hinges: Vec<MeshHinge>,
    /// Elastic joints.
    pub elastic: Vec<MeshedElasticJoint>,
    /// Ends with given motion: index, node and axis.
    pub driven: Vec<(usize, usize, usize)>,
    /// Number of the angle of each end.
    of_ends: Vec<Option<usize>>,
}

/// A node that follows another.
#[derive(Clone, Debug)]
pub struct Tie {
    /// The node.
    pub node: usize,
    /// The node that it follows.
    pub to: usize,
    /// `(cos δ, sin δ)`.
    turn: [f64; 2],
    /// Number of the joint's angle, and the arm along the axes of the own beam [m]; none where the places coincide.
    pub arm: Option<(usize, Planar<f64>)>,
}

/// The angle of a joint, common to some of its ends.
#[derive(Clone, Debug)]
pub struct JointAngle {
    /// Rotary inertia `J` [kg m^2].
    pub inertia: f64,
    /// Nodes of its ends, each with -1 for a tip and 1 for a root.
    pub ends: Vec<(usize, f64)>,
    /// True if its rate is an unknown.
    pub moves: bool,
    /// True if moments depend on its rate.
    pub damped: bool,
}

/// A hinge between two angles.
#[derive(Clone, Debug)]
pub struct MeshHinge {
    /// Numbers of both angles.
    pub angles: [usize; 2],
    /// Spring, damper and stop.
    pub law: Hinge,
}

impl MeshHinge {
    /// Its law, with the present share of the rest angle.
    #[inline]
    fn law_now(&self, now: &TimeData) -> Hinge {
        Hinge {
            rest_rad: now.hinge_rest * self.law.rest_rad,
            ..self.law
        }
    }
}

/// Rotation of the joints of a structure.
#[derive(Clone, Debug)]
pub struct JointMotion<T> {
    /// Angles.
    pub angle: Vec<T>,
    /// Their rates [1/s].
    pub rate: Vec<T>,
    /// Their accelerations, where they have inertia [1/s^2].
    pub acceleration: Vec<T>,
}

impl<T: Scalar> JointMotion<T> {
    /// Joints at rest.
    pub fn new(joints: &MeshJoints) -> Self {
        let zeros = || vec![T::zero(); joints.angles.len()];
        Self {
            angle: zeros(),
            rate: zeros(),
            acceleration: zeros(),
        }
    }
}

/// `R (x, z)` with `(cos, sin)` of its angle.
#[inline]
pub(super) fn turned<T: Scalar>([cos, sin]: [f64; 2], v: Planar<T>) -> Planar<T> {
    Planar::new(v.x * cos + v.z * sin, v.z * cos - v.x * sin)
}

impl Tie {
    /// Displacement of the node from that of the node that it follows.
    pub fn from_first(&self, u: Planar<f64>, angles: &[f64]) -> Planar<f64> {
        turned(self.turn, u) + self.by_arm(angles)
    }

    /// Displacement of the node that it follows from its own.
    pub fn to_first(&self, u: Planar<f64>, angles: &[f64]) -> Planar<f64> {
        let [cos, sin] = self.turn;
        turned([cos, -sin], u - self.by_arm(angles))
    }

    fn by_arm(&self, angles: &[f64]) -> Planar<f64> {
        self.arm
            .map_or_else(Planar::default, |(angle, arm)| lever(angles[angle], arm).0 - arm)
    }
}

impl MeshJoints {
    /// Joints of a model on the joined mesh.
    pub fn new(model: &Model, mesh: &BeamMesh) -> Self {
        let Some(structure) = &model.structure else {
            return Self::default();
        };
        let mut all = Self {
            of_ends: vec![None; model.ends.len()],
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
        let damped = model.section.bends_viscously();
        for joint in &structure.joints {
            let Some(first) = joint.ends().next() else { continue };
            let resists = joint
                .hinge
                .filter(|hinge| hinge.stiffness_n_m_rad > 0.0 || hinge.damping_n_m_s_rad > 0.0 || hinge.stop.is_some());
            let elastic = joint.elastic.is_some();
            let arms = |group: &[usize]| group.iter().any(|end| arm(structure, mesh, first, *end).is_some());
            let mut numbers = vec![];
            for (k, group) in joint.groups.iter().enumerate() {
                let inertia_of_group = if k == 0 { joint.inertia } else { 0.0 };
                if group.len() < 2 && resists.is_none() && !elastic && inertia_of_group == 0.0 {
                    continue; // a free end
                }
                let number = all.angles.len();
                numbers.push(number);
                for end in group {
                    all.of_ends[*end] = Some(number);
                }
                all.angles.push(JointAngle {
                    inertia: inertia_of_group,
                    ends: group.iter().map(|end| (ends[*end].node, -ends[*end].outward)).collect(),
                    moves: inertia && (inertia_of_group > 0.0 || (!elastic && arms(group))),
                    damped: damped
                        || resists.is_some_and(|hinge| hinge.damping_n_m_s_rad > 0.0)
                        || joint.elastic.is_some_and(|law| law.damping != [[0.0; 3]; 3]),
                });
            }
            if let (Some(law), [first, others @ ..]) = (resists, &numbers[..]) {
                all.hinges.extend(others.iter().map(|other| MeshHinge {
                    angles: [*first, *other],
                    law,
                }));
            }
            let turn = |from: usize, to: usize| {
                let [from, to] = [from, to].map(|end| structure.beams[end / 2].piece.angle);
                let (sin, cos) = (from - to).sin_cos();
                [cos, sin]
            };
            let firsts = joint.groups.iter().filter_map(|group| group.first().copied());
            if let (Some(law), [own, others @ ..]) = (joint.elastic, &numbers[..]) {
                all.elastic
                    .extend(others.iter().zip(firsts.clone().skip(1)).map(|(other, end)| {
                        MeshedElasticJoint {
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

    /// Number of the angle of an end.
    pub fn angle_of(&self, end: usize) -> Option<usize> {
        self.of_ends.get(end).copied().flatten()
    }

    /// Sets the motion of driven and of tied nodes.
    pub fn move_nodes<T: Scalar>(&self, now: &TimeData, w: &mut Workspace<T>) {
        let motion = &mut w.motion;
        for &(end, node, axis) in &self.driven {
            if let Some(given) = now.ends[end].u[axis] {
                motion.u[node][axis] = T::constant(given.value);
                motion.v[node][axis] = T::constant(given.rate);
                motion.a[node][axis] = T::constant(given.acceleration);
            }
        }
        for tie in &self.ties {
            let [mut u, mut v, mut a] = [&motion.u, &motion.v, &motion.a].map(|field| turned(tie.turn, field[tie.to]));
            if let Some((angle, arm)) = tie.arm {
                let (position, across) = lever(w.shape.joints.angle[angle], arm);
                let [rate, acceleration] = [w.shape.joints.rate[angle], w.shape.joints.acceleration[angle]];
                u += position - Planar::constant(arm);
                v += across.times(rate);
                a += across.times(acceleration) - position.times(rate.squared());
            }
            (motion.u[tie.node], motion.v[tie.node], motion.a[tie.node]) = (u, v, a);
        }
    }

    /// Completes the equations of joints, from those of momentum of all nodes.
    pub fn rows<T: Scalar>(
        &self,
        (system, now): (&System, &TimeData),
        y: &[T],
        yp: &[T],
        w: &Workspace<T>,
        r: &mut [T],
    ) {
        let own = &system.layout.joints;
        for (number, angle) in self.angles.iter().enumerate() {
            let mut against = T::zero();
            for &(node, sign) in &angle.ends {
                against += system.total_moment(w, node) * sign;
            }
            if angle.inertia > 0.0 && own.rate[number].is_some() {
                against += w.shape.joints.acceleration[number] * angle.inertia;
            }
            r[own.moment(number)] = against;
            if let Some(rate) = own.rate[number] {
                let unknown = own.angle.start + number;
                r[unknown] = yp[unknown] - y[rate];
            }
        }
        for hinge in &self.hinges {
            let [first, other] = hinge.angles;
            let shape = &w.shape;
            let by = hinge_moments(
                &hinge.law_now(now),
                shape.joints.angle[other] - shape.joints.angle[first],
                shape.joints.rate[other] - shape.joints.rate[first],
            );
            let moment = by.elastic + by.damping;
            r[own.moment(other)] += moment;
            r[own.moment(first)] -= moment;
        }
        self.elastic.iter().for_each(|one| one.rows(system, w, r));
        let lines = &system.layout.lines;
        for tie in &self.ties {
            let rows = [0, 1].map(|axis| lines[axis].momentum(tie.node).zip(lines[axis].momentum(tie.to)));
            let [Some((x, to_x)), Some((z, to_z))] = rows else {
                continue;
            };
            let force = Planar::new(r[x], r[z]);
            let [cos, sin] = tie.turn;
            let back = turned([cos, -sin], force);
            r[to_x] += back.x;
            r[to_z] += back.z;
            if let Some((angle, arm)) = tie.arm {
                let (_, across) = lever(w.shape.joints.angle[angle], arm);
                r[own.moment(angle)] += force.dot(across);
            }
            self.follow(system, y, tie.node, w, r);
        }
        for &(_, node, axis) in &self.driven {
            let line = &lines[axis];
            let u = line.u.start + node - line.free.start;
            r[u] = y[u] - w.motion.u[node][axis];
            if let Some(v) = &line.v {
                let v = v.start + node - line.free.start;
                r[v] = y[v] - w.motion.v[node][axis];
            }
        }
    }

    /// Unknowns of a node that follows: they equal its motion.
    fn follow<T: Scalar>(&self, system: &System, y: &[T], node: usize, w: &Workspace<T>, r: &mut [T]) {
        for (axis, line) in system.layout.lines.iter().enumerate() {
            let u = line.u.start + node - line.free.start;
            r[u] = y[u] - w.motion.u[node][axis];
            if let Some(v) = &line.v {
                let v = v.start + node - line.free.start;
                r[v] = y[v] - w.motion.v[node][axis];
            }
        }
    }

    /// Nodes whose unknowns have no momentum of their own: tied and driven ones, the latter with their axis.
    pub fn led(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let ties = self.ties.iter().flat_map(|tie| [(tie.node, 0), (tie.node, 1)]);
        ties.chain(self.driven.iter().map(|&(_, node, axis)| (node, axis)))
    }

    /// Energy of hinges, and of the rotation of bodies [J].
    pub fn energies(&self, now: &TimeData, w: &Workspace<f64>) -> [f64; 2] {
        let shape = &w.shape;
        let hinges = self.hinges.iter().map(|hinge| {
            let [first, other] = hinge.angles.map(|angle| shape.joints.angle[angle]);
            hinge_energy(&hinge.law_now(now), other - first)
        });
        let bodies = self.angles.iter().zip(&shape.joints.rate);
        [
            hinges.sum::<f64>() + self.elastic.iter().map(|one| one.energy(w)).sum::<f64>(),
            bodies.map(|(angle, rate)| 0.5 * angle.inertia * rate * rate).sum(),
        ]
    }

    /// Power lost in hinges [W].
    pub fn loss(&self, w: &Workspace<f64>) -> f64 {
        let rate = |hinge: &MeshHinge| {
            let [first, other] = hinge.angles.map(|angle| w.shape.joints.rate[angle]);
            other - first
        };
        let hinges = self.hinges.iter();
        let hinges = hinges.map(|hinge| hinge.law.damping_n_m_s_rad * rate(hinge).powi(2));
        hinges.sum::<f64>() + self.elastic.iter().map(|one| one.loss(w)).sum::<f64>()
    }
}

/// `R(φ) a` and `R'(φ) a`.
#[inline]
fn lever<T: Scalar>(angle: T, arm: Planar<f64>) -> (Planar<T>, Planar<T>) {
    let (sin, cos) = angle.sin_cos();
    let position = Planar::new(cos * arm.x + sin * arm.z, cos * arm.z - sin * arm.x);
    (position, Planar::new(position.z, -position.x))
}

/// Arm from the first end of a joint to another one, along the axes of its beam [m]; none if both are at one place.
fn arm(structure: &Structure, mesh: &BeamMesh, first: usize, end: usize) -> Option<Planar<f64>> {
    let apart = structure.place_of(end) - structure.place_of(first);
    let near = apart.squared().sqrt() <= NEAR * mesh.shortest;
    (!near).then(|| structure.beams[end / 2].piece.own(apart))
}
