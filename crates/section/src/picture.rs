//! Deformation of the cell under each of its four loads, as plain arrays for a picture.

use crate::cell::{Cell, Kind, Part, Response};
use crate::coefficients::Options;
use crate::dense::solve;
use crate::error::Error;
use crate::input::{Point, Section};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A mesh and its displacements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Picture {
    /// Nodes `[along, high]` of the solid at rest [m].
    pub nodes_m: Vec<Point>,
    /// Quadratic triangles: vertices 0, 1, 2, then the middles of 01, 12, 20.
    pub triangles: Vec<[usize; 6]>,
    /// Triangle edges on the boundary of the solid: end, middle, end.
    pub outline: Vec<[usize; 3]>,
    /// Material index of each triangle: 0 for the section, k for the k-th region.
    pub materials: Vec<usize>,
    /// Displacements `[along, high]` [m] of every node under N = 1 N, M = 1 N m, p_upper = 1 Pa and p_lower = 1 Pa. The
    /// cell's middle does not rotate.
    pub displacements_m: [Vec<[f64; 2]>; 4],
}

impl Section {
    /// Picture of the cell on the second finest mesh.
    pub fn picture(&self, options: &Options) -> Result<Picture, Error> {
        let meshes = self.meshes(options)?;
        let cell = Cell::new(self, &meshes[meshes.len().saturating_sub(2)]);
        let response = Response::new(&cell, Kind::Hollow)?;
        let (core, side) = (self.bladders.length_m, self.width_m - self.bladders.length_m);
        let walls = crate::level::Walls::new(self, &cell)?;
        let mut a = response.stiffness.map(|row| row.map(|k| core * k));
        (0..2).for_each(|i| (0..2).for_each(|j| a[i][j] += side * walls.stiffness[i][j]));
        let pitch = self.pitch_m;
        let thrust = response.area_by_strain.map(|row| row.map(|k| core * k));
        let loads = [[pitch, 0.0, 0.0, 0.0], [0.0, pitch, 0.0, 0.0], thrust[0], thrust[1]];
        let mut displacements = [const { Vec::new() }; 4];
        for (k, load) in loads.into_iter().enumerate() {
            let q = solve(a, load).ok_or(Error::Singular)?;
            let pressure = [f64::from(k == 2), f64::from(k == 3)];
            let periodic = response.periodic_part(q, pressure);
            let whole = |(w, &[z, x]): (&[f64; 2], &Point)| [w[0] + z * (q[0] + q[1] * x), w[1] - q[1] * z * z / 2.0];
            displacements[k] = periodic.iter().zip(&cell.mesh.nodes).map(whole).collect();
        }
        let solid = cell.mesh.triangles.iter().zip(&cell.mesh.parts);
        let (triangles, materials): (Vec<_>, Vec<_>) = solid
            .filter_map(|(t, part)| {
                if let Part::Solid(m) = part {
                    Some((*t, *m))
                } else {
                    None
                }
            })
            .unzip();
        let walls = crate::cell::respond::cavity_walls(&cell, |p| matches!(p, Part::Solid(_)));
        let mut picture = Picture {
            nodes_m: cell.mesh.nodes,
            triangles,
            outline: walls.into_iter().map(|(edge, _)| edge).collect(),
            materials,
            displacements_m: displacements,
        };
        picture.drop_unused();
        Ok(picture)
    }
}

impl Picture {
    /// Removes nodes without triangles, which are inside the cavities.
    fn drop_unused(&mut self) {
        let mut place = vec![usize::MAX; self.nodes_m.len()];
        self.triangles.iter().flatten().for_each(|&k| place[k] = 0);
        let kept: Vec<usize> = (0..place.len()).filter(|&k| place[k] == 0).collect();
        kept.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        self.nodes_m = kept.iter().map(|&k| self.nodes_m[k]).collect();
        for field in &mut self.displacements_m {
            *field = kept.iter().map(|&k| field[k]).collect();
        }
        self.triangles.iter_mut().flatten().for_each(|k| *k = place[*k]);
        self.outline.iter_mut().flatten().for_each(|k| *k = place[*k]);
    }
}
