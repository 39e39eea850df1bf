//! Attachments of the beam, on a mesh.

use super::angle_unwrapping::nearest;
use super::residual::momentum;
use super::{BeamMesh, MeshSections, System, TimeData, Workspace};
use crate::model::{AttachedBody, Kinematics};
use crate::numerics::{Planar, Scalar};

/// An attachment, at a place between nodes and between midpoints of cells.
///
/// `[E49]` Its motion is interpolated between the adjacent nodes. Its force and mass are distributed to them with the same weights, the
/// hat functions of [E46], so that its work is exact:
///
/// ```text
/// ū = Σ hat_i u_i      F = f - k ū - c ū_t      f_i = hat_i F      m h_i gains hat_i M      E gains k ū²/2
/// ```
///
/// `[E68]` A follower force rotates with the beam, or with the section if sections shear, at the angle of its place. It is distributed
/// with the same weights:
///
/// ```text
/// F gains T e_t(φ) + S e_n(φ)      φ = φ_c - (θ - θ_c) κ_i, c its cell and i the node beside it; at ends the angle of [E11]
/// small rotations   F gains (g T φ - S, T)
/// ```
///
/// `[E50]` A rotational spring acts on the angle interpolated between the midpoints of its two cells, and its couple is distributed to
/// them. The beam in between is in series with it, also in the half cell at an end, where only one cell receives the couple:
///
/// ```text
/// φ̄ = (1 - s) φ_c + s φ_{c+1}      h r_c λ_c² gains (1 - s) K φ̄, c + 1 gains s K φ̄      E gains K φ̄²/2
/// 1/K = 1/k + h s (1 - s)/EI      at the ends   φ̄ = φ_c,  1/K = 1/k + (h/2 - d)/EI, d the distance to the end
/// ```
#[derive(Clone, Debug)]
pub struct MeshedAttachment {
    /// Number of the attachment in the model.
    pub number: usize,
    /// Node before the attachment.
    pub node: usize,
    /// Weights of that node and of the next.
    pub weights: [f64; 2],
    /// Transverse and axial springs [N/m].
    pub stiffness: Planar<f64>,
    /// Transverse and axial dashpots [N s/m].
    pub damping: Planar<f64>,
    /// Cell, a node at one of its ends, and the distance of the place beyond the cell's midpoint [m].
    beyond: (usize, usize, f64),
    /// Two cells with their weights.
    cells: [(usize, f64); 2],
    /// `K` [N m].
    turning_stiffness: f64,
}

impl MeshedAttachment {
    /// Moves it to a mesh in which its first node and the first attachment have other numbers.
    pub(super) fn shift(&mut self, nodes: usize, number: usize) {
        self.number += number;
        self.node += nodes;
        self.beyond.0 += nodes;
        self.beyond.1 += nodes;
        self.cells.iter_mut().for_each(|(cell, _)| *cell += nodes);
    }

    /// Attachments of a model, ordered by place, and the masses of the nodes [kg], from the beam lengths [m] of the nodes and from the
    /// attachments.
    pub fn all(
        attachments: &[AttachedBody],
        sections: &MeshSections,
        mesh: &BeamMesh,
        lengths: &[f64],
    ) -> (Vec<Self>, Vec<f64>) {
        let mut all: Vec<_> = (0..attachments.len())
            .map(|number| Self::new(number, &attachments[number], sections, mesh))
            .collect();
        all.sort_by_key(|attached| attached.node);
        let mut masses: Vec<f64> = lengths
            .iter()
            .zip(&sections.mass)
            .map(|(length, mass)| mass * length)
            .collect();
        for attached in &all {
            for (k, weight) in attached.weights.into_iter().enumerate() {
                masses[attached.node + k] += weight * attachments[attached.number].mass;
            }
        }
        (all, masses)
    }

    fn new(number: usize, attachment: &AttachedBody, sections: &MeshSections, mesh: &BeamMesh) -> Self {
        let place = mesh.place(attachment.at);
        let (node, weights) = share(place, mesh.cells);
        let (first, last) = (0.5, mesh.cells as f64 - 0.5);
        let beyond = |cell: usize, by: f64| by * mesh.lengths[cell] / sections.bending_of_cells[cell];
        let (cells, in_series) = if place <= first {
            ([(0, 1.0), (0, 0.0)], beyond(0, first - place))
        } else if place >= last {
            let cell = mesh.cells - 1;
            ([(cell, 1.0), (cell, 0.0)], beyond(cell, place - last))
        } else {
            let (cell, share) = mesh.between_midpoints(place);
            let (share, in_series) = sections.turning(cell, share, mesh);
            ([(cell, 1.0 - share), (cell + 1, share)], in_series)
        };
        let nearest = (place as usize).min(mesh.cells - 1);
        let by = place - (nearest as f64 + 0.5);
        let k = attachment.turning_stiffness;
        Self {
            number,
            beyond: (nearest, nearest + usize::from(by > 0.0), by * mesh.lengths[nearest]),
            node,
            weights,
            stiffness: attachment.stiffness,
            damping: attachment.damping,
            cells,
            turning_stiffness: k / (1.0 + k * in_series),
        }
    }

    /// Interpolates nodal values at the attachment.
    #[inline]
    pub fn between<T: Scalar>(&self, values: &[Planar<T>]) -> Planar<T> {
        values[self.node] * self.weights[0] + values[self.node + 1] * self.weights[1]
    }

    /// Given forces [N], including followers at the angle of the place.
    #[inline]
    pub fn given<T: Scalar>(&self, system: &System, now: &TimeData, w: &Workspace<T>) -> Planar<T> {
        let given = now.point_force[self.number];
        let dead = Planar::constant(given.dead);
        if given.follower == Planar::default() {
            return dead;
        }
        let (cell, node, by) = self.beyond;
        let sizes = [given.follower.z, given.follower.x];
        dead + momentum::follower(
            system,
            sizes,
            || momentum::tangent_beyond(w, cell, node, by),
            || momentum::angle_beyond(w, cell, node, by),
        )
    }

    /// Force of its springs [N].
    #[inline]
    pub fn spring<T: Scalar>(&self, w: &Workspace<T>) -> Planar<T> {
        let u = self.between(&w.motion.u);
        Planar::new(u.x * -self.stiffness.x, u.z * -self.stiffness.z)
    }

    /// Force of its dashpots [N].
    #[inline]
    pub fn dashpot<T: Scalar>(&self, w: &Workspace<T>) -> Planar<T> {
        let v = self.between(&w.motion.v);
        Planar::new(v.x * -self.damping.x, v.z * -self.damping.z)
    }

    /// Cell before the rotational spring, if there is one.
    pub(super) fn turns_at(&self) -> Option<usize> {
        (self.turning_stiffness > 0.0).then_some(self.cells[0].0)
    }

    /// Unwrapped angle at the rotational spring.
    #[inline]
    fn angle<T: Scalar>(&self, system: &System, now: &TimeData, w: &Workspace<T>) -> T {
        let sections = &w.shape.sections.angle;
        let near = now.turns.attached.get(self.number).copied().unwrap_or(0.0);
        let direction = |cell: usize| w.shape.tangent[cell].x.atan2(w.shape.tangent[cell].z);
        let [a, b] = self.cells.map(|(cell, weight)| match system.model.kinematics {
            _ if !sections.is_empty() => sections[cell] * weight,
            Kinematics::Bar => T::zero(),
            Kinematics::FiniteRotation => nearest(direction(cell), near) * weight,
            Kinematics::Linear | Kinematics::SmallRotation => w.shape.d3[cell].x * weight,
        });
        a + b
    }

    /// Power of its rotational spring on the beam [W].
    pub fn turning_power(&self, system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
        if self.turning_stiffness == 0.0 {
            return 0.0;
        }
        let rates = self.cells.map(|(cell, weight)| w.shape.angle_rate[cell] * weight);
        -self.turning_stiffness * self.angle(system, now, w) * (rates[0] + rates[1])
    }

    /// Energy of the springs [J].
    pub fn energy(&self, system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
        let (u, angle) = (self.between(&w.motion.u), self.angle(system, now, w));
        let turning = self.turning_stiffness * angle * angle;
        0.5 * (self.stiffness.x * u.x * u.x + self.stiffness.z * u.z * u.z + turning)
    }
}

/// Node before a place, given in units of cells, and the weights of that node and of the next.
pub(super) fn share(place: f64, cells: usize) -> (usize, [f64; 2]) {
    let node = (place as usize).min(cells - 1);
    let share = place - node as f64;
    (node, [1.0 - share, share])
}

/// Attachments next to a node, with the node's weight.
#[inline]
pub fn at_node(attached: &[MeshedAttachment], node: usize) -> impl Iterator<Item = (&MeshedAttachment, f64)> {
    let first = attached.partition_point(|a| a.node + 1 < node);
    let near = attached[first..].iter().take_while(move |a| a.node <= node);
    near.map(move |a| (a, a.weights[node - a.node]))
}

/// Couples per length of rotational springs, cell by cell [N].
#[inline]
pub fn turning<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &mut Workspace<T>,
    mut add: impl FnMut(T, usize, &mut Workspace<T>),
) {
    for attached in system.attached.iter().filter(|a| a.turning_stiffness > 0.0) {
        let couple = attached.angle(system, now, w) * attached.turning_stiffness;
        for (cell, weight) in attached.cells {
            if weight > 0.0 {
                add(couple * (weight * system.mesh.per_length[cell]), cell, w);
            }
        }
    }
}

/// Torque of all rotational springs on the beam, positive in the direction of growing φ [N m].
pub fn torque(system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
    let couples = system
        .attached
        .iter()
        .map(|a| a.turning_stiffness * a.angle(system, now, w));
    -couples.sum::<f64>()
}
