//! Attached bodies with rotary inertia, on a mesh.

use super::attached::share;
use super::ledger::EnergyRate;
use super::residual::{rotating_frame, solid};
use super::{BeamMesh, System, TimeData, Workspace};
use crate::case::{ResolvedEnd, Rotation};
use crate::model::{AttachedBody, Kinematics};
use crate::numerics::{Planar, Scalar};

/// A body on the beam: rotary inertia, and a mass with its center beside the beam's line.
///
/// `[E69]` Its angle is a weighted mean over up to four cells around its place, and its couple is distributed to them:
///
/// ```text
/// φ̄ = Σ w_c φ_c      h r_c λ_c² gains w_c J φ̄_tt      E gains J φ̄_t²/2
/// Σ w_c = 1      Σ w_c θ_c = θ̄      Σ h_i m_i² = θ̄,  m_i = Σ_{c > i} w_c
/// inside   w = (-γ, 1 - s + γ, s + γ, -γ)   2 γ (1 + γ) = s (1 - s)      one cell from an end   w = (1 - s - γ, s + 2 γ, -γ)   2 γ (s + γ) = s (1 - s)
/// within half a cell of an end that turns   w = (a, 1 - a)   a² = 3/2 - d/h,  d the distance to the end
/// ```
///
/// A couple bends the beam between its support and the place: its angle is `C θ̄/EI`, and on the mesh `C Σ h_i m_i²/EI`, with the share
/// m_i carried by node i. The weights equate both: the beam has its exact stiffness at the place, and frequencies are of second order.
/// Next to an end that can rotate, the place itself cannot be exact as well. It is then off by less than a third of a cell, which affects
/// only bending at the very end.
///
/// `[E70]` The mass center rotates with the beam, or with the section if sections shear; its offset is b across and a
/// along:
///
/// ```text
/// x_G = x̄ + q(φ̄)      q = b (cos φ, -sin φ) + a (sin φ, cos φ)      q' = dq/dφ      f its weight and body force
/// F gains -M (φ_tt q' + φ_t² q'')      J φ_tt gains M q'·(ū_tt + φ_tt q' + φ_t² q'') - f·q'      E gains M (φ_t q'·ū_t + φ_t² q'²/2)
/// small rotations   q = (b + a φ - g b φ²/2, a - b φ - g a φ²/2)
/// ```
///
/// These are Lagrange's equations of the energies for any q: the energy balance is exact in all kinematics.
#[derive(Clone, Debug)]
pub struct MeshedBody {
    /// Number of the attachment in the model.
    pub number: usize,
    /// Node before the body.
    pub node: usize,
    /// Weights of that node and of the next.
    hats: [f64; 2],
    /// First of the body's cells.
    first: usize,
    /// Weights of the body's cells; 0 for missing cells.
    weights: [f64; 4],
    /// `J` [kg m²].
    inertia: f64,
    /// `M` [kg].
    mass: f64,
    /// `(b, a)` [m].
    offset: Planar<f64>,
}

/// Derivatives of the position of a mass center by the angle, `q'` and `q''` [m].
struct Arm<T> {
    first: Planar<T>,
    second: Planar<T>,
}

/// Motion of a body.
struct Motion {
    arm: Arm<f64>,
    /// Velocity of the place [m/s].
    v: Planar<f64>,
    /// `φ_t` [1/s].
    turning: f64,
}

impl MeshedBody {
    /// Rotating bodies of a model.
    pub fn all(
        attachments: &[AttachedBody],
        ends: &[ResolvedEnd; 2],
        kinematics: Kinematics,
        mesh: &BeamMesh,
    ) -> Vec<Self> {
        if kinematics == Kinematics::Bar {
            return vec![];
        }
        let turns = [&ends[0], &ends[1]].map(|end| matches!(end.rotation, Rotation::Moment(_)));
        let bodies = attachments.iter().enumerate().filter(|(_, one)| one.is_body());
        let body = |(number, one): (usize, &AttachedBody)| {
            let place = mesh.place(one.at);
            let (node, hats) = share(place, mesh.cells);
            let (first, weights) = cells(place, mesh.cells, turns);
            Self {
                number,
                node,
                hats,
                first,
                weights,
                inertia: one.inertia,
                mass: one.mass,
                offset: one.offset,
            }
        };
        bodies.map(body).collect()
    }

    /// Moves it to a mesh in which its first node and the first attachment have other numbers.
    pub(super) fn shift(&mut self, nodes: usize, number: usize) {
        self.number += number;
        (self.node, self.first) = (self.node + nodes, self.first + nodes);
    }

    /// Cells of the body with their weights.
    pub fn cells(&self) -> impl Iterator<Item = (usize, f64)> {
        (self.first..).zip(self.weights).filter(|(_, weight)| *weight != 0.0)
    }

    fn is_eccentric(&self) -> bool {
        self.offset != Planar::default()
    }

    fn between<T: Scalar>(&self, values: &[Planar<T>]) -> Planar<T> {
        values[self.node] * self.hats[0] + values[self.node + 1] * self.hats[1]
    }

    fn mean<T: Scalar>(&self, of: impl Fn(usize) -> T) -> T {
        let mut mean = T::zero();
        for (cell, weight) in self.cells() {
            mean += of(cell) * weight;
        }
        mean
    }

    /// Unit tangent at the mean angle of its cells.
    fn tangent<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> Planar<T> {
        let sections = &w.shape.sections.angle;
        if !sections.is_empty() {
            return Planar::tangent(self.mean(|cell| sections[cell]));
        }
        // starts at the first cell and adds the rotations at the nodes between cells
        let mut turn = T::zero();
        let mut beyond = 1.0 - self.weights[0];
        for (node, weight) in (self.first + 1..system.mesh.cells).zip(&self.weights[1..]) {
            if beyond != 0.0 {
                turn += w.shape.kappa[node] * (beyond * -system.mesh.node_lengths[node]);
            }
            beyond -= weight;
        }
        let (sine, cosine) = turn.sin_cos();
        let tangent = w.shape.tangent[self.first];
        tangent.times(cosine) - tangent.normal().times(sine)
    }

    fn arm<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> Arm<T> {
        let Planar { x: across, z: along } = self.offset;
        let kinematics = system.model.kinematics;
        if kinematics == Kinematics::FiniteRotation {
            let tangent = self.tangent(system, w);
            let normal = tangent.normal();
            return Arm {
                first: -(tangent * across + normal * along),
                second: normal * across - tangent * along,
            };
        }
        let first = Planar::constant(Planar { x: along, z: -across });
        if kinematics != Kinematics::SmallRotation {
            let second = Planar::zero();
            return Arm { first, second };
        }
        let second = Planar::constant(self.offset) * -1.0;
        Arm {
            first: first + second.times(self.small_angle(w)),
            second,
        }
    }

    /// Angle for small rotations.
    fn small_angle<T: Scalar>(&self, w: &Workspace<T>) -> T {
        let sections = &w.shape.sections.angle;
        self.mean(|cell| sections.get(cell).copied().unwrap_or(w.shape.d3[cell].x))
    }

    /// Position of the mass center relative to the place, `q` [m].
    fn center<T: Scalar>(&self, system: &System, w: &Workspace<T>, arm: &Arm<T>) -> Planar<T> {
        if system.model.kinematics == Kinematics::FiniteRotation {
            return -arm.second;
        }
        let angle = self.small_angle(w);
        Planar::constant(self.offset) + (arm.first - arm.second.times(angle * 0.5)).times(angle)
    }

    /// `φ_t` of the body's cells.
    fn turning<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> T {
        self.mean(|c| match system.model.kinematics {
            _ if !w.shape.sections.angle.is_empty() => w.shape.angle_rate[c],
            Kinematics::FiniteRotation => solid::angle_rate(system, w, c),
            _ => (w.motion.v[c + 1].x - w.motion.v[c].x) * system.mesh.per_length[c],
        })
    }

    /// `φ_tt` of the body's cells, by [E13].
    fn speeding<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> T {
        let (inverse, v, a) = (&system.mesh.per_length, &w.motion.v, &w.motion.a);
        self.mean(|c| match system.model.kinematics {
            _ if !w.shape.sections.angle.is_empty() => w.shape.sections.acceleration[c],
            Kinematics::FiniteRotation => {
                let (tangent, stretch) = (w.shape.tangent[c], w.shape.stretch[c]);
                let stretching = tangent.dot((v[c + 1] - v[c]) * inverse[c]);
                let across = tangent.cross((a[c + 1] - a[c]) * inverse[c]);
                (across - stretching * solid::angle_rate(system, w, c) * 2.0) / stretch
            }
            _ => (a[c + 1].x - a[c].x) * inverse[c],
        })
    }

    /// Additional force of an offset mass at the place, beyond that of a mass without offset, `-M (φ_tt q' + φ_t² q'')`
    /// [N].
    fn force<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> Planar<T> {
        let arm = self.arm(system, w);
        let turning = self.turning(system, w).squared();
        let carried = arm.first.times(self.speeding(system, w)) + arm.second.times(turning);
        carried * -self.mass
    }

    /// Couple of the body's inertia and weight against rotation [N m].
    fn couple<T: Scalar>(&self, system: &System, now: &TimeData, w: &Workspace<T>) -> T {
        let mut couple = T::zero();
        let moves = system.layout.inertia;
        if moves && self.inertia > 0.0 {
            couple += self.speeding(system, w) * self.inertia;
        }
        if self.is_eccentric() || system.model.frame.is_some() {
            couple -= self.given_couple(system, now, w);
        }
        if self.is_eccentric() && moves {
            let own = self.between(&w.motion.a) * self.mass - self.force(system, w);
            couple += self.arm(system, w).first.dot(own);
        }
        couple
    }

    /// Couple of the weight and of a rotating frame, in the direction of growing φ [N m].
    fn given_couple<T: Scalar>(&self, system: &System, now: &TimeData, w: &Workspace<T>) -> T {
        let arm = self.arm(system, w);
        let weight = Planar::constant(now.point_force[self.number].weight);
        let place = |node| rotating_frame::place(system, w, node);
        let Some((before, after)) = place(self.node).zip(place(self.node + 1)) else {
            return arm.first.dot(weight);
        };
        let at = before * self.hats[0] + after * self.hats[1] + self.center(system, w, &arm);
        let v = self.between(&w.motion.v) + arm.first.times(self.turning(system, w));
        let force = weight + rotating_frame::acceleration(system, now, at, v) * self.mass;
        arm.first.dot(force) - T::constant(self.inertia * now.frame_rotation.rate)
    }

    /// Additional force of a rotating frame at the place, beyond that on a mass without offset [N].
    fn force_of_frame<T: Scalar>(&self, system: &System, now: &TimeData, w: &Workspace<T>) -> Planar<T> {
        let arm = self.arm(system, w);
        let v = arm.first.times(self.turning(system, w));
        rotating_frame::acceleration(system, now, self.center(system, w, &arm), v) * self.mass
    }

    /// Adds the impulses [kg m/s] of nodes by velocity jumps.
    pub fn add_impulses(&self, system: &System, w: &Workspace<f64>, jumps: &[Planar<f64>], all: &mut [Planar<f64>]) {
        let inverse = &system.mesh.per_length;
        let turned = |c: usize| match system.model.kinematics {
            Kinematics::FiniteRotation => w.shape.tangent[c].normal() * (-inverse[c] / w.shape.stretch[c]),
            _ => Planar { x: inverse[c], z: 0.0 },
        };
        let first = self.arm(system, w).first;
        let turning = self.mean(|c| turned(c).dot(jumps[c + 1] - jumps[c]));
        let moved = self.between(jumps) + first * turning;
        let twist = self.mass * first.dot(moved) + self.inertia * turning;
        for (k, hat) in self.hats.into_iter().enumerate() {
            all[self.node + k] += first * (self.mass * turning * hat);
        }
        for (c, weight) in self.cells() {
            let handed = turned(c) * (twist * weight);
            all[c] -= handed;
            all[c + 1] += handed;
        }
    }

    fn motion(&self, system: &System, w: &Workspace<f64>) -> Motion {
        Motion {
            arm: self.arm(system, w),
            v: self.between(&w.motion.v),
            turning: self.turning(system, w),
        }
    }

    /// Kinetic energy of the offset mass beyond that of a mass at the place, and energy of the rotary inertia [J].
    pub fn energies(&self, system: &System, w: &Workspace<f64>) -> [f64; 2] {
        let Motion { arm, v, turning } = self.motion(system, w);
        let own = 0.5 * turning * arm.first.squared() + arm.first.dot(v);
        [self.mass * turning * own, 0.5 * self.inertia * turning * turning]
    }

    /// Momentum beyond that of a mass at the place, and angular momentum about the place [kg m/s, kg m²/s].
    pub fn momenta(&self, system: &System, w: &Workspace<f64>) -> (Planar<f64>, f64) {
        let Motion { arm, v, turning } = self.motion(system, w);
        let moved = v + arm.first * turning;
        let about = self.mass * arm.first.dot(moved) + self.inertia * turning;
        (arm.first * (self.mass * turning), about)
    }

    /// Power of the couple by weight and frame [W].
    pub fn power_of_couple(&self, system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
        self.given_couple(system, now, w) * self.turning(system, w)
    }

    /// External terms of the balances: a force in the balance of momentum of nodes, and a torque about the place in the balance of
    /// angular momentum. The torque is that of weight and frame, and of the motion under small rotations [N, N m].
    pub fn outside(&self, system: &System, now: &TimeData, w: &Workspace<f64>) -> (Planar<f64>, f64) {
        let Motion { arm, v, turning } = self.motion(system, w);
        let given = self.given_couple(system, now, w);
        if !system.layout.inertia {
            return (Planar::default(), given);
        }
        let moved = v + arm.first * turning;
        let of_motion = self.mass * turning * arm.second.dot(moved);
        (self.force(system, w), given + of_motion)
    }

    /// Interpolates values of the two adjacent nodes at the place.
    pub fn at_place(&self, of: impl Fn(usize) -> Planar<f64>) -> Planar<f64> {
        of(self.node) * self.hats[0] + of(self.node + 1) * self.hats[1]
    }
}

/// Passes the forces of each eccentric body on a node to `each`, with the balance entry of their work; none for stored energy.
#[inline]
pub fn forces<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
    each: &mut impl FnMut(Option<EnergyRate>, Planar<T>),
) {
    for body in system.bodies.iter().filter(|body| body.is_eccentric()) {
        let near = body.node == node || body.node + 1 == node;
        if near && system.layout.inertia {
            each(None, body.force(system, w) * body.hats[node - body.node]);
        }
        if near && system.model.frame.is_some() {
            let force = body.force_of_frame(system, now, w);
            each(Some(EnergyRate::Loads), force * body.hats[node - body.node]);
        }
    }
}

/// Couples per length of all bodies, cell by cell [N].
#[inline]
pub fn turning<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &mut Workspace<T>,
    mut add: impl FnMut(T, usize, &mut Workspace<T>),
) {
    for body in &system.bodies {
        let couple = body.couple(system, now, w);
        for (cell, weight) in body.cells() {
            add(couple * (weight * system.mesh.per_length[cell]), cell, w);
        }
    }
}

/// First cell and weights for a place in units of cells, [E69].
fn cells(place: f64, cells: usize, turns: [bool; 2]) -> (usize, [f64; 4]) {
    let last = cells as f64;
    if place > 0.5 * last {
        // mirrored at the tip
        let (first, seen) = cells_from_root(last - place, cells, turns[1]);
        let count = seen.iter().rposition(|weight| *weight != 0.0).map_or(1, |k| k + 1);
        let mut weights = [0.0; 4];
        for (k, weight) in seen.into_iter().take(count).enumerate() {
            weights[count - 1 - k] = weight;
        }
        return (cells - count - first, weights);
    }
    cells_from_root(place, cells, turns[0])
}

/// First cell and weights for places in the half next to the root.
fn cells_from_root(place: f64, cells: usize, turns: bool) -> (usize, [f64; 4]) {
    if cells == 1 {
        return (0, [1.0, 0.0, 0.0, 0.0]);
    }
    if place <= 0.5 {
        let own = if turns { (1.5 - place).sqrt() } else { 1.0 };
        return (0, [own, 1.0 - own, 0.0, 0.0]);
    }
    let cell = ((place - 0.5) as usize).min(cells - 2);
    let s = place - 0.5 - cell as f64;
    if cell >= 1 && cell + 2 < cells {
        let more = 0.5 * ((1.0 + 2.0 * s * (1.0 - s)).sqrt() - 1.0);
        return (cell - 1, [-more, 1.0 - s + more, s + more, -more]);
    }
    if cell == 0 && cells > 2 {
        let more = 0.5 * ((2.0 * s - s * s).sqrt() - s);
        return (0, [1.0 - s - more, s + 2.0 * more, -more, 0.0]);
    }
    (cell, [1.0 - s, s, 0.0, 0.0])
}
