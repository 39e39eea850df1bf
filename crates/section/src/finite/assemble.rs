//! Energy, forces and stiffness of the whole cell in a state.

use super::element::{self, ROWS, answer};
use super::face::{Carried, carry};
use super::{FiniteCell, State, cavity};

/// Unknowns of an element: twelve of w, two of the bubble, e, kappa, g0, g1.
const ALL: usize = ROWS + 2;

/// Eight-point Gauss-Legendre rule on [-1, 1]: (point, weight) of the positive half.
const LEGENDRE: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// Energy of the cell and its derivatives, per unit of the core's width.
pub(super) struct System {
    pub energy: f64,
    /// Derivatives by w and by q.
    pub force: Vec<f64>,
    pub by_q: [f64; 4],
    /// Lower triangle of the stiffness over w.
    pub entries: Vec<(usize, usize, f64)>,
    /// Columns of the stiffness over q.
    pub border: Vec<Vec<f64>>,
    pub corner: [[f64; 4]; 4],
    /// Volumes of both bladders over their rest length, with derivatives by w and q. Their second derivatives are part
    /// of the stiffness.
    pub areas: [f64; 2],
    pub area_by_w: [Vec<f64>; 2],
    pub area_by_q: [[f64; 4]; 2],
}

impl FiniteCell {
    /// Assembles in a state under pressures. None if an element is inverted.
    pub(super) fn assemble(&self, state: &State, pressures: [f64; 2]) -> Option<System> {
        let n = state.w.len();
        let mut system = System {
            energy: 0.0,
            force: vec![0.0; n],
            by_q: [0.0; 4],
            entries: Vec::with_capacity(self.solid.len() * 105 + 2),
            border: vec![vec![0.0; n]; 4],
            corner: [[0.0; 4]; 4],
            areas: [0.0; 2],
            area_by_w: [vec![0.0; n], vec![0.0; n]],
            area_by_q: [[0.0; 4]; 2],
        };
        let [e, kappa, g0, g1] = state.q;
        let nodes = &self.cell.mesh.nodes;
        let carried = |node: usize| {
            let k = 2 * self.independent[node];
            carry([state.w[k], nodes[node][1] + state.w[k + 1]], self.face[node], e, kappa)
        };
        for (number, (triangle, material)) in self.solid.iter().enumerate() {
            let bubble = 2 * (self.nodes + number);
            let mut u = [0.0; ROWS];
            let mut faces: [Option<Carried>; 6] = [const { None }; 6];
            for (i, &node) in triangle.iter().enumerate() {
                let k = 2 * self.independent[node];
                u[2 * i..2 * i + 2].copy_from_slice(&state.w[k..k + 2]);
                if self.face[node] != 0.0 {
                    let c = carried(node);
                    u[2 * i] = c.place[0] - nodes[node][0];
                    u[2 * i + 1] = c.place[1] - nodes[node][1];
                    faces[i] = Some(c);
                }
            }
            u[12..].copy_from_slice(&[state.w[bubble], state.w[bubble + 1], g0, g1]);
            let material = &self.cell.materials[*material];
            let law = material.law.unwrap_or(self.law);
            let local = answer(&self.cell.corners(triangle), material, &law, &u)?;
            system.energy += local.energy;
            let (force, stiffness) = carry_over(&local, &faces);
            let dof = |i: usize| {
                if i < 12 {
                    2 * self.independent[triangle[i / 2]] + i % 2
                } else {
                    bubble + i - 12
                }
            };
            for i in 0..14 {
                let row = dof(i);
                system.force[row] += force[i];
                for j in 0..14 {
                    if row >= dof(j) {
                        system.entries.push((row, dof(j), stiffness[i][j]));
                    }
                }
                (0..4).for_each(|a| system.border[a][row] += stiffness[i][14 + a]);
            }
            for a in 0..4 {
                system.by_q[a] += force[14 + a];
                (0..4).for_each(|b| system.corner[a][b] += stiffness[14 + a][14 + b]);
            }
        }
        for (row, edges) in self.walls.iter().enumerate() {
            for edge in edges {
                self.press(&mut system, state, row, *edge, pressures[row]);
            }
        }
        self.bars(&mut system, state.q)?;
        self.hold(&mut system);
        Some(system)
    }

    /// Adds a wall edge under pressure p, with the energy -p a.
    fn press(&self, system: &mut System, state: &State, row: usize, edge: [usize; 3], p: f64) {
        let dofs = edge.map(|node| 2 * self.independent[node]);
        let place = |k: usize| {
            let [z, x] = self.cell.mesh.nodes[edge[k]];
            [z + state.w[dofs[k]], x + state.w[dofs[k] + 1]]
        };
        let part = cavity::edge([place(0), place(1), place(2)], state.q[2], state.q[3]);
        system.areas[row] += part.value;
        system.energy -= p * part.value;
        for i in 0..6 {
            let at = dofs[i / 2] + i % 2;
            system.area_by_w[row][at] += part.gradient[i];
            system.force[at] -= p * part.gradient[i];
            for j in 0..6 {
                let to = dofs[j / 2] + j % 2;
                if at >= to {
                    system.entries.push((at, to, -p * part.hessian[i][j]));
                }
            }
            (0..2).for_each(|a| system.border[2 + a][at] -= p * part.hessian[i][6 + a]);
        }
        for a in 0..2 {
            system.area_by_q[row][2 + a] += part.gradient[6 + a];
            system.by_q[2 + a] -= p * part.gradient[6 + a];
        }
    }

    /// Adds the side walls as bars.
    fn bars(&self, system: &mut System, [e, kappa, ..]: [f64; 4]) -> Option<()> {
        if self.side == 0.0 {
            return Some(());
        }
        let material = &self.cell.materials[0];
        for &[low, high] in &self.bars {
            let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
            for [place, weight] in LEGENDRE {
                for x in [middle - place * half, middle + place * half] {
                    let stretch = 1.0 + e + kappa * x;
                    let [v, d, dd] = self
                        .law
                        .bar(material.shear_modulus(), material.bulk_modulus(), stretch)?;
                    let w = self.side * self.cell.size[0] * weight * half;
                    system.energy += w * v;
                    let by = [1.0, x];
                    for a in 0..2 {
                        system.by_q[a] += w * d * by[a];
                        (0..2).for_each(|b| system.corner[a][b] += w * dd * by[a] * by[b]);
                    }
                }
            }
        }
        Some(())
    }

    /// Fixes the mid-plane node of the faces.
    fn hold(&self, system: &mut System) {
        let held = |k: usize| k == self.held || k == self.held + 1;
        system.entries.retain(|&(i, j, _)| !held(i) && !held(j));
        let stiff = self.cell.materials[0].young_modulus_pa;
        for k in [self.held, self.held + 1] {
            system.entries.push((k, k, stiff));
            system.force[k] = 0.0;
            system.border.iter_mut().for_each(|column| column[k] = 0.0);
        }
    }
}

/// Force and stiffness over w, bubble and q, from those over displacements by the chain rule through [F3].
fn carry_over(local: &element::Answer, faces: &[Option<Carried>; 6]) -> ([f64; ALL], [[f64; ALL]; ALL]) {
    // Rows: displacements, bubble, g0, g1. Columns: w, bubble, e, kappa, g0, g1.
    let mut t = [[0.0; ALL]; ROWS];
    for i in 0..14 {
        t[i][i] = 1.0;
    }
    t[14][16] = 1.0;
    t[15][17] = 1.0;
    for (k, c) in faces.iter().enumerate() {
        let Some(c) = c else { continue };
        for a in 0..2 {
            (0..2).for_each(|b| t[2 * k + a][2 * k + b] = c.by_shape[a][b]);
            t[2 * k + a][14] = c.by_stretch[a];
            t[2 * k + a][15] = c.by_curvature[a];
        }
    }
    let mut force = [0.0; ALL];
    let mut half = [[0.0; ALL]; ROWS];
    let mut stiffness = [[0.0; ALL]; ALL];
    for i in 0..ROWS {
        for j in 0..ALL {
            force[j] += local.force[i] * t[i][j];
            for k in 0..ROWS {
                half[i][j] += local.stiffness[i][k] * t[k][j];
            }
        }
    }
    for i in 0..ALL {
        for j in 0..ALL {
            stiffness[i][j] = (0..ROWS).map(|k| t[k][i] * half[k][j]).sum();
        }
    }
    for (k, c) in faces.iter().enumerate() {
        let Some(c) = c else { continue };
        for a in 0..2 {
            let f = local.force[2 * k + a];
            for b in 0..2 {
                stiffness[2 * k + b][15] += f * c.shape_curvature[a][b];
                stiffness[15][2 * k + b] += f * c.shape_curvature[a][b];
            }
            stiffness[14][15] += f * c.stretch_curvature[a];
            stiffness[15][14] += f * c.stretch_curvature[a];
            stiffness[15][15] += f * c.curvature_twice[a];
        }
    }
    (force, stiffness)
}
