//! Joints of a structure on the mesh: ends of beams that share their motion, and the angles of joints.

mod build;
mod elastic;

pub use elastic::MeshedElasticJoint;

use super::{System, TimeData, Workspace};
use crate::case::schema::Hinge;
use crate::model::structure::{hinge_energy, hinge_moments};
use crate::numerics::{Planar, Scalar};

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
    /// True for each end in a joint.
    joined: Vec<bool>,
}

/// A node that follows another.
#[derive(Clone, Debug)]
pub struct Tie {
    /// The node.
    pub node: usize,
    /// The node that it follows.
    pub to: usize,
    /// `(sin δ, cos δ)`.
    turn: Planar<f64>,
    /// Number of the joint's angle, and the arm along the axes of the own beam [m]; none where the places coincide.
    pub arm: Option<(usize, Planar<f64>)>,
}

/// The angle of a joint, common to some of its ends.
#[derive(Clone, Debug)]
pub struct JointAngle {
    /// Number of its joint.
    pub joint: usize,
    /// Rotary inertia `J` [kg m^2].
    pub inertia: f64,
    /// Nodes of its ends, each with -1 for a tip and 1 for a root.
    pub ends: Vec<(usize, f64)>,
    /// True if its rate is an unknown.
    pub moves: bool,
    /// True if its own moments depend on the rate of its unknown.
    pub damped: bool,
    /// The first angle of its joint, to which its unknown is relative: a damper between two angles without inertia then depends on the rate
    /// of one unknown.
    pub relative_to: Option<usize>,
}

/// A hinge between two angles.
#[derive(Clone, Debug)]
pub struct MeshHinge {
    /// Number of its joint.
    pub joint: usize,
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

    /// Rotation of the further beam relative to the first one, and its rate.
    #[inline]
    fn turned<T: Scalar>(&self, w: &Workspace<T>) -> [T; 2] {
        let [first, other] = self.angles;
        [&w.shape.joints.angle, &w.shape.joints.rate].map(|of| of[other] - of[first])
    }

    /// Moment against the rotation [N m].
    #[inline]
    fn moment<T: Scalar>(&self, now: &TimeData, w: &Workspace<T>) -> T {
        let [angle, rate] = self.turned(w);
        let by = hinge_moments(&self.law_now(now), angle, rate);
        by.elastic + by.damping
    }

    /// Power that it takes [W].
    pub fn power(&self, now: &TimeData, w: &Workspace<f64>) -> f64 {
        self.moment(now, w) * self.turned(w)[1]
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

impl Tie {
    /// Displacement of the node from that of the node that it follows.
    pub fn from_first(&self, u: Planar<f64>, angles: &[f64]) -> Planar<f64> {
        u.turned(self.turn) + self.by_arm(angles)
    }

    /// Displacement of the node that it follows from its own.
    pub fn to_first(&self, u: Planar<f64>, angles: &[f64]) -> Planar<f64> {
        (u - self.by_arm(angles)).turned_back(self.turn)
    }

    fn by_arm(&self, angles: &[f64]) -> Planar<f64> {
        self.arm
            .map_or_else(Planar::default, |(angle, arm)| lever(angles[angle], arm).0 - arm)
    }
}

impl MeshJoints {
    /// Number of the angle of an end.
    pub fn angle_of(&self, end: usize) -> Option<usize> {
        self.of_ends.get(end).copied().flatten()
    }

    /// Sets the angles of the beams from the unknown ones, or their rates likewise.
    pub fn add_first<T: Scalar>(&self, angles: &mut [T]) {
        for (k, angle) in self.angles.iter().enumerate() {
            if let Some(first) = angle.relative_to {
                let moved = angles[first];
                angles[k] += moved;
            }
        }
    }

    /// The unknown angles, of angles of the beams.
    pub fn unknowns(&self, angles: &[f64]) -> impl Iterator<Item = f64> {
        let own = self.angles.iter().zip(angles);
        own.map(|(one, angle)| angle - one.relative_to.map_or(0.0, |first| angles[first]))
    }

    /// True for an end in a joint.
    pub fn holds(&self, end: usize) -> bool {
        self.joined.get(end).copied().unwrap_or(false)
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
            let [mut u, mut v, mut a] = [&motion.u, &motion.v, &motion.a].map(|field| field[tie.to].turned(tie.turn));
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
            let moment = hinge.moment(now, w);
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
            let back = force.turned_back(tie.turn);
            r[to_x] += back.x;
            r[to_z] += back.z;
            if let Some((angle, arm)) = tie.arm {
                let (_, across) = lever(w.shape.joints.angle[angle], arm);
                r[own.moment(angle)] += force.dot(across);
            }
        }
        // the first of relative angles moves all
        for (number, angle) in self.angles.iter().enumerate() {
            if let Some(first) = angle.relative_to {
                let own_moment = r[own.moment(number)];
                r[own.moment(first)] += own_moment;
            }
        }
        // unknowns of led nodes equal the motion that they follow
        for (node, axis) in self.led() {
            let line = &lines[axis];
            let at = node - line.free.start;
            r[line.u.start + at] = y[line.u.start + at] - w.motion.u[node][axis];
            if let Some(v) = &line.v {
                r[v.start + at] = y[v.start + at] - w.motion.v[node][axis];
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
        let hinges = self.hinges.iter();
        let hinges = hinges.map(|hinge| hinge_energy(&hinge.law_now(now), hinge.turned(w)[0]));
        let bodies = self.angles.iter().zip(&w.shape.joints.rate);
        [
            hinges.sum::<f64>() + self.elastic.iter().map(|one| one.energy(w)).sum::<f64>(),
            bodies.map(|(angle, rate)| 0.5 * angle.inertia * rate * rate).sum(),
        ]
    }

    /// Power lost in hinges [W].
    pub fn loss(&self, w: &Workspace<f64>) -> f64 {
        let hinges = self.hinges.iter();
        let hinges = hinges.map(|hinge| hinge.law.damping_n_m_s_rad * hinge.turned(w)[1].powi(2));
        hinges.sum::<f64>() + self.elastic.iter().map(|one| one.loss(w)).sum::<f64>()
    }
}

/// `R(φ) a` and `R'(φ) a`.
#[inline]
fn lever<T: Scalar>(angle: T, arm: Planar<f64>) -> (Planar<T>, Planar<T>) {
    let position = Planar::constant(arm).turned(Planar::tangent(angle));
    (position, Planar::new(position.z, -position.x))
}
