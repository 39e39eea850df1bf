//! Shear stiffness of the cell.
//!
//! In a long beam under a constant transverse force V the moment varies along the beam: M' = -V. For a unit gradient of
//! the curvature, kappa(z) = z from the middle of the cell, the displacement is
//!
//! ```text
//! u = macroscopic part with strains z (e1 + x), z (g0 + g1 x)  +  z w1  +  v,     v periodic        [L5]
//! ```
//!
//! Here (e1, 1, g0, g1) and w1 are the strains and the periodic part of a unit curvature without force. From one cell
//! to the next the field grows by pitch times that of the unit curvature. v is in equilibrium if
//!
//! ```text
//! a(u, v*) = pitch * (forces of the unit curvature on the right face) . v*    for all periodic v*   [L6]
//! ```
//!
//! Uniform strains are added so that the mean axial force, moment and lateral forces over the cell vanish. Shear
//! strains by the gradient of the lateral strain along the beam are neglected, as in plane stress. The energy beyond
//! that of the moment is the shear energy:
//! ```text
//! energy / pitch = EI pitch^2/24 + V^2 / 2 kGA,     V = EI  (per unit of width)                     [L7]
//! ```

use super::Cell;
use super::respond::{Response, dofs};
use crate::dense::{dot, solve};
use crate::element::solid::ROWS;
use crate::error::Error;

impl Response {
    /// kGA per unit of width [N/m], by [L7].
    pub fn shear_stiffness(&self, cell: &Cell) -> Result<f64, Error> {
        let pitch = cell.size[0];
        let q1 = self.unit_curvature()?;
        let w1 = self.periodic_part(q1, [0.0; 2]);
        let nodes = &cell.mesh.nodes;
        let right = |k: usize| (nodes[k][0] - pitch / 2.0).abs() < 1e-9 * pitch;
        let mut side = vec![0.0; self.unknowns];
        let mut mean = [0.0; 4];
        for (triangle, k) in &self.elements {
            let dofs = dofs(triangle, &self.independent);
            let mut unit = [0.0; ROWS];
            let mut grown = [0.0; ROWS];
            for i in 0..12 {
                let (node, c) = (triangle[i / 2], i % 2);
                unit[i] = w1[node][c];
                grown[i] = nodes[node][0] * w1[node][c];
            }
            unit[12..16].copy_from_slice(&q1);
            grown[16..].copy_from_slice(&q1);
            for i in 0..12 {
                side[dofs[i]] -= dot(&k[i], &grown);
                if right(triangle[i / 2]) {
                    side[dofs[i]] += pitch * dot(&k[i], &unit);
                }
            }
            (0..4).for_each(|a| mean[a] -= dot(&k[12 + a], &grown));
        }
        side[0] = 0.0;
        side[1] = 0.0;
        let [v] = self.factor.solve(&[side]).try_into().map_err(|_| Error::Singular)?;
        (0..4).for_each(|a| mean[a] -= dot(&self.sides[a], &v));
        let q = solve(self.stiffness, mean).ok_or(Error::Singular)?;
        let added = self.periodic_part(q, [0.0; 2]);
        let mut energy = 0.0;
        for (triangle, k) in &self.elements {
            let dofs = dofs(triangle, &self.independent);
            let mut u = [0.0; ROWS];
            for i in 0..12 {
                let (node, c) = (triangle[i / 2], i % 2);
                u[i] = nodes[node][0] * w1[node][c] + v[dofs[i]] + added[node][c];
            }
            u[12..16].copy_from_slice(&q);
            u[16..].copy_from_slice(&q1);
            energy += (0..ROWS).map(|i| u[i] * dot(&k[i], &u)).sum::<f64>() / 2.0;
        }
        let ei = dot(&self.stiffness[1], &q1) / pitch;
        Ok(ei * ei / (2.0 * (energy / pitch - ei * pitch * pitch / 24.0)))
    }
}
