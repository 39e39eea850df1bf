//! Contact points with obstacles, on a mesh.

use super::ledger::EnergyRate;
use super::{BeamMesh, MeshSections, System, Workspace};
use crate::model::Model;
use crate::model::contact::ContactForces;
use crate::numerics::{Planar, Scalar};

/// `[E62]` Contact point: every node, with its length, or one place between two nodes,
///
/// ```text
/// x̄ = Σ hat_i x_i      f_i = hat_i w f(x̄, v̄)      E gains w k S(g)        w = h_i, at a place 1
/// ```
///
/// x is the position of a node, `(u1, θ + u3)`: force, work and energy are consistent on every mesh.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    /// Number of the contact in the model.
    pub number: usize,
    /// Node before the contact point.
    node: usize,
    /// Weights of that node and of the next.
    weights: [f64; 2],
    /// `w`: length that the point represents [m], 1 for a single place.
    measure: f64,
    /// Position in the straight beam [m].
    coordinate: f64,
    /// `r`, distance of the touching surface from the beam's line [m].
    reach: f64,
}

impl ContactPoint {
    /// Contact points of a model, ordered by place.
    pub fn all(model: &Model, sections: &MeshSections, mesh: &BeamMesh) -> Vec<Self> {
        let mut all = vec![];
        for (number, contact) in model.contacts.iter().enumerate() {
            let mut push = |place: f64, measure: f64| {
                let node = (place as usize).min(mesh.cells - 1);
                let share = place - node as f64;
                let reach = match contact.follows_section {
                    // of the higher section beside a node the edge touches
                    true if share == 0.0 || share == 1.0 => sections.farthest_fiber[place as usize],
                    true => model.section_of(mesh.segment_of(node)).farthest_fiber(),
                    false => contact.reach,
                };
                all.push(Self {
                    reach,
                    number,
                    node,
                    weights: [1.0 - share, share],
                    measure,
                    coordinate: mesh.coordinate(place),
                });
            };
            match contact.at {
                Some(at) => push(mesh.place(at), 1.0),
                None => (0..mesh.nodes).for_each(|i| push(i as f64, mesh.node_lengths[i])),
            }
        }
        all.sort_by_key(|one| one.node);
        all
    }

    /// Moves it to a mesh in which its first node and the first contact have other numbers.
    pub(super) fn shift(&mut self, nodes: usize, number: usize) {
        self.number += number;
        self.node += nodes;
    }

    fn between<T: Scalar>(&self, values: &[Planar<T>]) -> Planar<T> {
        values[self.node] * self.weights[0] + values[self.node + 1] * self.weights[1]
    }

    fn place<T: Scalar>(&self, u: &[Planar<T>]) -> Planar<T> {
        let u = self.between(u);
        Planar::new(u.x, u.z + self.coordinate)
    }

    /// Forces at the contact point [N].
    pub fn forces<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> ContactForces<T> {
        let law = &system.model.contacts[self.number];
        let ContactForces {
            elastic,
            damping,
            friction,
        } = law.forces(self.place(&w.motion.u), self.between(&w.motion.v), self.reach);
        ContactForces {
            elastic: elastic * self.measure,
            damping: damping * self.measure,
            friction: friction * self.measure,
        }
    }

    /// Penetration depth and its rate [m, m/s].
    pub fn depth(&self, system: &System, w: &Workspace<f64>) -> [f64; 2] {
        let law = &system.model.contacts[self.number];
        let (depth, normal) = law.depth(self.place(&w.motion.u), self.reach);
        [depth, -self.between(&w.motion.v).dot(normal)]
    }
}

/// Passes the contact forces on a node to `each`, with the balance entry of their work; none for stored energy.
#[inline]
pub fn forces<T: Scalar>(
    system: &System,
    w: &Workspace<T>,
    node: usize,
    each: &mut impl FnMut(Option<EnergyRate>, Planar<T>),
) {
    let first = system.touching.partition_point(|one| one.node + 1 < node);
    for one in system.touching[first..].iter().take_while(|one| one.node <= node) {
        let weight = one.weights[node - one.node];
        if weight == 0.0 {
            continue;
        }
        let f = one.forces(system, w);
        each(None, f.elastic * weight);
        if system.model.contacts[one.number].is_lossy() {
            each(Some(EnergyRate::Damping), (f.damping + f.friction) * weight);
        }
    }
}

/// Energy stored in contacts [J].
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let each = system.touching.iter().map(|one| {
        let [depth, _] = one.depth(system, w);
        one.measure * system.model.contacts[one.number].energy(depth)
    });
    each.sum()
}

/// Results of a contact.
pub struct ContactResult {
    /// Sum of the forces normal to the face [N].
    pub normal: f64,
    /// Sum of the friction forces along the face [N].
    pub friction: f64,
    /// Largest depth [m]; if negative, the smallest distance.
    pub depth: f64,
    /// Resultant force on the beam [N].
    pub force: Planar<f64>,
}

/// Results of the contact with this number.
pub fn felt(system: &System, w: &Workspace<f64>, number: usize) -> ContactResult {
    let law = &system.model.contacts[number];
    let mut felt = ContactResult {
        normal: 0.0,
        friction: 0.0,
        depth: f64::NEG_INFINITY,
        force: Planar::default(),
    };
    for one in system.touching.iter().filter(|one| one.number == number) {
        let f = one.forces(system, w);
        let (depth, normal) = law.depth(one.place(&w.motion.u), one.reach);
        felt.normal += (f.elastic + f.damping).dot(normal);
        felt.friction += f.friction.dot(normal.normal());
        felt.depth = felt.depth.max(depth);
        felt.force += f.elastic + f.damping + f.friction;
    }
    felt
}

/// Distance of each contact point from a circle, plus a quarter of its bend radius: no longer motion can pass over the circle.
fn free_ways<'a>(system: &'a System, u: &'a [Planar<f64>]) -> impl Iterator<Item = (&'a ContactPoint, f64)> {
    system.touching.iter().filter_map(|one| {
        let law = &system.model.contacts[one.number];
        let (depth, _) = law.depth(one.place(u), one.reach);
        Some((one, 0.25 * law.bend_radius()? - depth.min(0.0)))
    })
}

/// Longest step that cannot pass over a circle [s].
pub fn longest_step(system: &System, w: &Workspace<f64>) -> f64 {
    let each = free_ways(system, &w.motion.u).map(|(one, way)| way / one.between(&w.motion.v).squared().sqrt());
    each.fold(f64::INFINITY, f64::min)
}

/// True if the beam may pass over a circle between two states of displacements.
pub fn may_pass_over(system: &System, from: &[Planar<f64>], to: &[Planar<f64>]) -> bool {
    free_ways(system, from).any(|(one, way)| (one.between(to) - one.between(from)).squared() > way * way)
}

/// Largest depth at any obstacle, and its rate [m, m/s]; zero without contact.
pub fn deepest(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let depths = system.touching.iter().map(|one| one.depth(system, w));
    depths.fold([0.0; 2], |a, b| if b[0] > a[0] { b } else { a })
}
