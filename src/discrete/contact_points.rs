//! Contact points with walls, on a mesh.

use super::ledger::EnergyRate;
use super::{BeamMesh, System, Workspace};
use crate::model::ContactWall;
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
    /// Number of the wall in the model.
    pub number: usize,
    /// Node before the contact point.
    node: usize,
    /// Weights of that node and of the next.
    weights: [f64; 2],
    /// `w`: length that the point represents [m], 1 for a single place.
    measure: f64,
    /// Position in the straight beam [m].
    coordinate: f64,
}

impl ContactPoint {
    /// Contact points of a model, ordered by place.
    pub fn all(contacts: &[ContactWall], mesh: &BeamMesh) -> Vec<Self> {
        let mut all = vec![];
        for (number, contact) in contacts.iter().enumerate() {
            let mut push = |place: f64, measure: f64| {
                let node = (place as usize).min(mesh.cells - 1);
                let share = place - node as f64;
                all.push(Self {
                    number,
                    node,
                    weights: [1.0 - share, share],
                    measure,
                    coordinate: place * mesh.h,
                });
            };
            match contact.at {
                Some(at) => push(at * mesh.cells as f64, 1.0),
                None => (0..mesh.nodes).for_each(|i| push(i as f64, mesh.node_length(i))),
            }
        }
        all.sort_by_key(|one| one.node);
        all
    }

    fn between<T: Scalar>(&self, values: &[Planar<T>]) -> Planar<T> {
        values[self.node] * self.weights[0] + values[self.node + 1] * self.weights[1]
    }

    fn place<T: Scalar>(&self, w: &Workspace<T>) -> Planar<T> {
        let u = self.between(&w.motion.u);
        Planar::new(u.x, u.z + self.coordinate)
    }

    /// Forces at the contact point [N].
    pub fn forces<T: Scalar>(&self, system: &System, w: &Workspace<T>) -> ContactForces<T> {
        let law = &system.model.contacts[self.number];
        let ContactForces {
            elastic,
            damping,
            friction,
        } = law.forces(self.place(w), self.between(&w.motion.v));
        ContactForces {
            elastic: elastic * self.measure,
            damping: damping * self.measure,
            friction: friction * self.measure,
        }
    }

    /// Penetration depth and its rate [m, m/s].
    pub fn depth(&self, system: &System, w: &Workspace<f64>) -> [f64; 2] {
        let law = &system.model.contacts[self.number];
        [law.depth(self.place(w)), -self.between(&w.motion.v).dot(law.normal)]
    }
}

/// Passes the forces of walls on a node to `each`, with the balance entry of their work; none for stored energy.
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

/// Energy stored in walls [J].
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let each = system.touching.iter().map(|one| {
        let [depth, _] = one.depth(system, w);
        one.measure * system.model.contacts[one.number].energy(depth)
    });
    each.sum()
}

/// Results for a wall: normal force, friction force along its face, and largest depth [N, N, m]; a negative depth is
/// the distance.
pub fn felt(system: &System, w: &Workspace<f64>, number: usize) -> [f64; 3] {
    let law = &system.model.contacts[number];
    let mut felt = [0.0, 0.0, f64::NEG_INFINITY];
    for one in system.touching.iter().filter(|one| one.number == number) {
        let f = one.forces(system, w);
        felt[0] += (f.elastic + f.damping).dot(law.normal);
        felt[1] += f.friction.dot(law.normal.normal());
        felt[2] = felt[2].max(one.depth(system, w)[0]);
    }
    felt
}

/// Largest depth at any wall, and its rate [m, m/s]; zero without contact.
pub fn deepest(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let depths = system.touching.iter().map(|one| one.depth(system, w));
    depths.fold([0.0; 2], |a, b| if b[0] > a[0] { b } else { a })
}
