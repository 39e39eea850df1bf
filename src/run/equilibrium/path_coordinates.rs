//! Coordinates of a state in which paths are nearly straight.

use std::f64::consts::PI;

use super::structures;
use crate::dae::StaticBeam;
use crate::discrete::TimeData;
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Natural coordinates: position of the first node, angles and lengths of the cells. A strongly bent beam moves its nodes on
/// circles. Extrapolated displacements stretch it, and stretch costs `EA l²/EI` times as much as bending. Angles and lengths of
/// the cells depend little on that: a beam rolled up by a moment has angles proportional to it.
///
/// ```text
/// (u1, u3) of the nodes  ->  position of node 0, angle and length of each cell
/// ```
///
/// For kinematics other than finite rotation, displacements remain the coordinates.
pub struct PathCoordinates {
    finite: bool,
    nodes: usize,
    /// First nodes of the beams of a structure, behind the first.
    roots: Vec<usize>,
}

impl PathCoordinates {
    /// Creates the coordinates for states of a beam.
    pub fn new(statics: &StaticBeam) -> Self {
        let mesh = &statics.system().mesh;
        Self {
            finite: statics.system().model.kinematics == Kinematics::FiniteRotation,
            nodes: mesh.nodes,
            roots: mesh.beams[1..].iter().map(|beam| beam.nodes.start).collect(),
        }
    }

    /// Converts scaled unknowns and the load factor behind them to coordinates: x and z of node 0, angles, lengths, all
    /// unknowns. At the
    /// root, angles differ from those of another state `near` by less than half a turn.
    pub fn of_unknowns(&self, statics: &mut StaticBeam, x: &[f64], near: Option<&[f64]>) -> Vec<f64> {
        if !self.finite {
            return x.to_vec();
        }
        let (across, along) = self.positions(statics, x);
        let cells = self.nodes - 1;
        let mut z = vec![across[0], along[0]];
        let mut before = near.map_or(0.0, |near| near[2]);
        for c in 0..cells {
            if self.roots.contains(&c) {
                before = near.map_or(0.0, |near| near[2 + c]);
            }
            let angle = (across[c + 1] - across[c]).atan2(along[c + 1] - along[c]);
            before += (angle - before + PI).rem_euclid(2.0 * PI) - PI;
            z.push(before);
        }
        z.extend((0..cells).map(|c| (across[c + 1] - across[c]).hypot(along[c + 1] - along[c])));
        z.extend_from_slice(x);
        z
    }

    /// Converts coordinates to scaled unknowns. If both ends are held, the mismatch at the tip is distributed along the beam.
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
        let mesh = &system.mesh;
        if system.model.structure.is_some() {
            let mut u = vec![Planar::default(); self.nodes];
            for (axis, line) in l.lines.iter().enumerate() {
                for (node, unknown, _) in line.unknowns() {
                    u[node][axis] = x[unknown] * l.scales[unknown];
                }
            }
            let mut joint_angles: Vec<f64> = l.joints.angle.clone().map(|k| x[k] * l.scales[k]).collect();
            system.joints.add_first(&mut joint_angles);
            let lines: Vec<Planar<f64>> = angles
                .iter()
                .zip(lengths)
                .map(|(a, l)| Planar::tangent(*a) * *l)
                .collect();
            structures::assemble(system, &lines, &joint_angles, &mut u);
            for (axis, line) in l.lines.iter().enumerate() {
                for (node, unknown, _) in line.unknowns() {
                    x[unknown] = u[node][axis] / l.scales[unknown];
                }
            }
            return x;
        }
        let parts: [fn(f64) -> f64; 2] = [f64::sin, f64::cos];
        for (axis, line) in l.lines.iter().enumerate() {
            let free = &line.free;
            let rest = |node: usize| if axis == 1 { mesh.node_coordinate(node) } else { 0.0 };
            let carried = |node: usize| now.carried(axis, mesh.share(node)).value;
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
                let shared = missing * mesh.share(node);
                x[unknown] = (u[node] + shared - carried(node)) / l.scales[unknown];
            }
        }
        x
    }

    /// Positions x and z of the nodes [m].
    fn positions(&self, statics: &mut StaticBeam, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (system, now): (_, &TimeData) = statics.beam().instant(x[x.len() - 1]);
        let l = &system.layout;
        let [across, mut along] = [0, 1].map(|axis| {
            let carried = |node: usize| now.carried(axis, system.mesh.share(node)).value;
            let mut all: Vec<f64> = (0..self.nodes).map(carried).collect();
            for (node, unknown, _) in l.lines[axis].unknowns() {
                all[node] += x[unknown] * l.scales[unknown];
            }
            all
        });
        for (node, z) in along.iter_mut().enumerate() {
            *z += system.mesh.node_coordinate(node);
        }
        (across, along)
    }
}
