//! A state in the coordinates in which paths are nearly straight.

use std::f64::consts::PI;

use crate::dae::StaticBeam;
use crate::discrete::TimeData;
use crate::model::Kinematics;

/// A beam that bends far moves its nodes on circles: what is extrapolated in displacements stretches it, and stretch costs
/// `EA l²/EI` times what bending costs. Angles and lengths of the cells hardly know of that: a beam that is rolled up by a
/// moment has angles proportional to it.
///
/// ```text
/// (u1, u3) of the nodes  ->  position of node 0, angle and length of each cell
/// ```
///
/// Small rotations are left as they are.
pub struct Natural {
    finite: bool,
    nodes: usize,
}

impl Natural {
    /// For the states of a beam.
    pub fn of(statics: &StaticBeam) -> Self {
        Self {
            finite: statics.system().model.kinematics == Kinematics::FiniteRotation,
            nodes: statics.system().mesh.nodes,
        }
    }

    /// Scaled unknowns with the load factor behind them, as coordinates: x and z of node 0, angles, lengths, all
    /// unknowns. Angles differ from those of `near`, another state, by less than half a turn at the root.
    pub fn of_unknowns(&self, statics: &mut StaticBeam, x: &[f64], near: Option<&[f64]>) -> Vec<f64> {
        if !self.finite {
            return x.to_vec();
        }
        let (across, along) = self.positions(statics, x);
        let cells = self.nodes - 1;
        let mut z = vec![across[0], along[0]];
        let mut before = near.map_or(0.0, |near| near[2]);
        for c in 0..cells {
            let angle = (across[c + 1] - across[c]).atan2(along[c + 1] - along[c]);
            before += (angle - before + PI).rem_euclid(2.0 * PI) - PI;
            z.push(before);
        }
        z.extend((0..cells).map(|c| (across[c + 1] - across[c]).hypot(along[c + 1] - along[c])));
        z.extend_from_slice(x);
        z
    }

    /// The way back. Where both ends are held, what is missing at the tip is shared out along the beam.
    pub fn to_unknowns(&self, statics: &mut StaticBeam, z: &[f64]) -> Vec<f64> {
        if !self.finite {
            return z.to_vec();
        }
        let cells = self.nodes - 1;
        let (angles, lengths) = (&z[2..2 + cells], &z[2 + cells..2 + 2 * cells]);
        let mut x = z[2 + 2 * cells..].to_vec();
        let share = x[x.len() - 1];
        let (system, now) = statics.beam().instant(share);
        let l = &system.layout;
        let h = system.mesh.h;
        let parts: [fn(f64) -> f64; 2] = [f64::sin, f64::cos];
        for (axis, line) in l.lines.iter().enumerate() {
            let free = &line.free;
            let rest = |node: usize| if axis == 1 { h * node as f64 } else { 0.0 };
            let carried = |node: usize| now.carried(axis, node as f64 / cells as f64).value;
            let mut u = Vec::with_capacity(self.nodes);
            let mut at = if free.contains(&0) { z[axis] } else { carried(0) };
            u.push(at);
            for c in 0..cells {
                at += lengths[c] * parts[axis](angles[c]);
                u.push(at - rest(c + 1));
            }
            let missing = if free.contains(&cells) {
                0.0
            } else {
                carried(cells) - u[cells]
            };
            for (node, unknown, _) in line.unknowns() {
                let shared = missing * node as f64 / cells as f64;
                x[unknown] = (u[node] + shared - carried(node)) / l.scales[unknown];
            }
        }
        x
    }

    /// x and z of the nodes [m].
    fn positions(&self, statics: &mut StaticBeam, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (system, now): (_, &TimeData) = statics.beam().instant(x[x.len() - 1]);
        let l = &system.layout;
        let last = (self.nodes - 1) as f64;
        let [across, mut along] = [0, 1].map(|axis| {
            let carried = |node: usize| now.carried(axis, node as f64 / last).value;
            let mut all: Vec<f64> = (0..self.nodes).map(carried).collect();
            for (node, unknown, _) in l.lines[axis].unknowns() {
                all[node] += x[unknown] * l.scales[unknown];
            }
            all
        });
        for (node, z) in along.iter_mut().enumerate() {
            *z += system.mesh.h * node as f64;
        }
        (across, along)
    }
}
