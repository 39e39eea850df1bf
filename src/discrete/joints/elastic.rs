//! Elastic joints of a structure, on a mesh.

use crate::case::schema::ElasticJoint;
use crate::discrete::{System, Workspace};
use crate::model::structure::elastic_forces;
use crate::numerics::{Planar, Scalar};

/// An elastic joint of two nodes, [E106].
#[derive(Clone, Debug)]
pub struct MeshedElasticJoint {
    /// Number of its joint.
    pub joint: usize,
    /// Nodes of both places.
    pub nodes: [usize; 2],
    /// Numbers of their angles.
    pub angles: [usize; 2],
    /// `(sin, cos)` of the angle from the axes of the first beam to those of the second.
    pub turn: Planar<f64>,
    /// `X_2 - X_1` along the axes of the first beam [m].
    pub apart: Planar<f64>,
    /// Stiffness and damping.
    pub law: ElasticJoint,
}

/// Relative motion of both places.
struct Stretched<T> {
    /// `R(-φ_1) (x_2 - x_1)`.
    between: Planar<T>,
    /// `(d, β)`.
    by: [T; 3],
    /// Its rate.
    rates: [T; 3],
}

impl MeshedElasticJoint {
    fn stretched<T: Scalar>(&self, w: &Workspace<T>) -> Stretched<T> {
        let [first, other] = self.nodes;
        let [angles, rates] = [&w.shape.joints.angle, &w.shape.joints.rate].map(|of| self.angles.map(|k| of[k]));
        let direction = Planar::tangent(angles[0]);
        let apart = Planar::constant(self.apart);
        let between = (apart + w.motion.u[other].turned(self.turn) - w.motion.u[first]).turned_back(direction);
        let moving = (w.motion.v[other].turned(self.turn) - w.motion.v[first]).turned_back(direction)
            + Planar::new(-between.z, between.x).times(rates[0]);
        let d = between - apart;
        Stretched {
            between,
            by: [d.x, d.z, angles[1] - angles[0]],
            rates: [moving.x, moving.z, rates[1] - rates[0]],
        }
    }

    /// Adds its forces and moments to the equations of nodes and angles.
    pub fn rows<T: Scalar>(&self, system: &System, w: &Workspace<T>, r: &mut [T]) {
        let Stretched { between, by, rates } = self.stretched(w);
        let [x, z, moment] = elastic_forces(&self.law, by, rates);
        // on the first beam, along its axes
        let force = Planar::new(x, z).turned(Planar::tangent(w.shape.joints.angle[self.angles[0]]));
        let on_other = force.turned_back(self.turn);
        let lines = &system.layout.lines;
        for (axis, line) in lines.iter().enumerate() {
            if let [Some(first), Some(other)] = self.nodes.map(|node| line.momentum(node)) {
                r[first] -= force[axis];
                r[other] += on_other[axis];
            }
        }
        let [first, other] = self.angles.map(|angle| system.layout.joints.moment(angle));
        r[other] += moment;
        r[first] -= moment + x * between.z - z * between.x;
    }

    /// Stored energy [J].
    pub fn energy(&self, w: &Workspace<f64>) -> f64 {
        let by = self.stretched(w).by;
        0.5 * dot(by, elastic_forces(&self.law, by, [0.0; 3]))
    }

    /// Power that it takes [W].
    pub fn power(&self, w: &Workspace<f64>) -> f64 {
        let Stretched { by, rates, .. } = self.stretched(w);
        dot(rates, elastic_forces(&self.law, by, rates))
    }

    /// Dissipated power [W].
    pub fn loss(&self, w: &Workspace<f64>) -> f64 {
        let Stretched { rates, .. } = self.stretched(w);
        dot(rates, elastic_forces(&self.law, [0.0; 3], rates))
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
