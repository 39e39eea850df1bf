//! Condensed stiffness of the cell, without the periodic part.
//!
//! ```text
//! energy per width   1/2 w.Kw + w.Fq + 1/2 q.Mq - p.(Gw + Hq),    q = (e, kappa, g0, g1), p = (p_u, p_l)     [L3]
//! w = K^-1 (G^T p - F q)
//! S = M - F^T K^-1 F      T = H - G K^-1 F      R = G K^-1 G^T                                              [L4]
//! forces  S q - T^T p,    areas  T q + R p
//! ```

use super::{Cell, Moments, Part, folded};
use crate::dense::{dot, solve};
use crate::element::solid::{self, Matrix};
use crate::element::{GAUSS, shapes};
use crate::error::Error;
use crate::sparse::Factor;
use std::collections::HashMap;

/// Prism across the beam's width that the cell represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Between the ends of the bladders.
    Hollow,
    /// Side walls beyond the ends of the bladders, where the cell is solid.
    Filled,
}

/// The cell's response per unit of width.
pub struct Response {
    /// S of [L4] over (e, kappa, g0, g1).
    pub stiffness: [[f64; 4]; 4],
    /// T of [L4]: area of the upper and lower bladder by q.
    pub area_by_strain: [[f64; 4]; 2],
    /// R of [L4].
    pub area_by_pressure: [[f64; 2]; 2],
    /// Moments of the cavities.
    pub cavities: [Moments; 2],
    /// Largest relative asymmetry of S and R before symmetrization.
    pub asymmetry: f64,
    /// Number of displacement unknowns.
    pub unknowns: usize,
    pub(crate) factor: Factor,
    /// K^-1 applied to the columns of F and the rows of G.
    pub(crate) fields: Vec<Vec<f64>>,
    pub(crate) sides: Vec<Vec<f64>>,
    /// Independent node of each node; `usize::MAX` for nodes without solid.
    pub(crate) independent: Vec<usize>,
    pub(crate) elements: Vec<([usize; 6], Matrix)>,
}

impl Response {
    /// Solves the cell.
    pub fn new(cell: &Cell, kind: Kind) -> Result<Self, Error> {
        let solid: Vec<([usize; 6], usize)> = solids(cell, kind).collect();
        let independent = periodic(cell, &solid)?;
        let count = independent
            .iter()
            .filter(|&&k| k != usize::MAX)
            .max()
            .map_or(0, |m| m + 1);
        let n = 2 * count;
        let mut elements = Vec::with_capacity(solid.len());
        let mut entries = Vec::with_capacity(solid.len() * 78 + 2);
        let mut sides = vec![vec![0.0; n]; 4];
        let mut macroscopic = [[0.0; 4]; 4];
        for &(triangle, material) in &solid {
            let k = solid::matrix(&cell.corners(&triangle), &cell.materials[material]).ok_or_else(folded)?;
            let dofs = dofs(&triangle, &independent);
            for i in 0..12 {
                for j in 0..12 {
                    // The first two unknowns are fixed to prevent rigid-body translation.
                    if dofs[i] >= dofs[j] && dofs[j] >= 2 {
                        entries.push((dofs[i], dofs[j], k[i][j]));
                    }
                }
                for (a, side) in sides.iter_mut().enumerate() {
                    side[dofs[i]] += k[i][12 + a];
                }
            }
            for a in 0..4 {
                for b in 0..4 {
                    macroscopic[a][b] += k[12 + a][12 + b];
                }
            }
            elements.push((triangle, k));
        }
        let stiff = cell.materials[0].young_modulus_pa;
        entries.extend([(0, 0, stiff), (1, 1, stiff)]);
        let factor = Factor::new(n, &entries)?;
        let mut cavities = [[0.0; 3]; 2];
        if kind == Kind::Hollow {
            let walls = [
                walls(cell, &independent, n, Part::is_upper),
                walls(cell, &independent, n, Part::is_lower),
            ];
            sides.extend(walls);
            cavities = [
                cell.moments(&|p| f64::from(p.is_upper()))?,
                cell.moments(&|p| f64::from(p.is_lower()))?,
            ];
        } else {
            sides.extend([vec![0.0; n], vec![0.0; n]]);
        }
        for side in &mut sides {
            side[0] = 0.0;
            side[1] = 0.0;
        }
        let fields = factor.solve(&sides);
        let gram: Vec<Vec<f64>> = sides
            .iter()
            .map(|a| fields.iter().map(|b| dot(a, b)).collect())
            .collect();
        let mean = |i: usize, j: usize| (gram[i][j] + gram[j][i]) / 2.0;
        let unlike = |i: usize, j: usize| {
            (gram[i][j] - gram[j][i]).abs() / (gram[i][i] * gram[j][j]).sqrt().max(f64::MIN_POSITIVE)
        };
        let pairs = (0..6).flat_map(|i| (0..i).map(move |j| (i, j)));
        let asymmetry = pairs.map(|(i, j)| unlike(i, j)).fold(0.0, f64::max);
        let stiffness = std::array::from_fn(|i| std::array::from_fn(|j| macroscopic[i][j] - mean(i, j)));
        let area_by_strain = std::array::from_fn(|c| {
            let [area, first, _] = cavities[c];
            let own = [area, first, area, first];
            std::array::from_fn(|j| own[j] - mean(4 + c, j))
        });
        let area_by_pressure = std::array::from_fn(|c| std::array::from_fn(|d| mean(4 + c, 4 + d)));
        Ok(Self {
            stiffness,
            area_by_strain,
            area_by_pressure,
            cavities,
            asymmetry,
            unknowns: n,
            factor,
            fields,
            sides,
            independent,
            elements,
        })
    }

    /// Strains (e, 1, g0, g1) of a unit curvature without axial force, lateral forces and pressure. The moment per
    /// width is S q over the pitch.
    pub fn unit_curvature(&self) -> Result<[f64; 4], Error> {
        let s = &self.stiffness;
        let free = [0, 2, 3];
        let a = free.map(|i| free.map(|j| s[i][j]));
        let [e, g0, g1] = solve(a, free.map(|i| -s[i][1])).ok_or(Error::Singular)?;
        Ok([e, 1.0, g0, g1])
    }

    /// Stiffness over (e, kappa) with the lateral strains free, per width [N m^-1, N, N m times pitch].
    pub fn free_stiffness(&self) -> Result<[[f64; 2]; 2], Error> {
        let s = &self.stiffness;
        let lateral = [[s[2][2], s[2][3]], [s[3][2], s[3][3]]];
        let mut out = [[0.0; 2]; 2];
        for j in 0..2 {
            let g = solve(lateral, [s[2][j], s[3][j]]).ok_or(Error::Singular)?;
            for (i, row) in out.iter_mut().enumerate() {
                row[j] = s[i][j] - s[i][2] * g[0] - s[i][3] * g[1];
            }
        }
        Ok(out)
    }

    /// Displacements `[along, high]` of the periodic part at every node for q and p; zero for nodes without solid.
    pub fn periodic_part(&self, q: [f64; 4], p: [f64; 2]) -> Vec<[f64; 2]> {
        let loads = [-q[0], -q[1], -q[2], -q[3], p[0], p[1]];
        let value = |dof: usize| loads.iter().zip(&self.fields).map(|(l, f)| l * f[dof]).sum::<f64>();
        let node = |&k: &usize| {
            if k == usize::MAX {
                [0.0; 2]
            } else {
                [value(2 * k), value(2 * k + 1)]
            }
        };
        self.independent.iter().map(node).collect()
    }
}

impl Part {
    pub(super) fn is_upper(self) -> bool {
        matches!(self, Part::Upper(_))
    }

    pub(super) fn is_lower(self) -> bool {
        matches!(self, Part::Lower(_))
    }
}

/// Load-carrying triangles with their materials.
pub(crate) fn solids(cell: &Cell, kind: Kind) -> impl Iterator<Item = ([usize; 6], usize)> {
    let material = move |part: Part| match (part, kind) {
        (Part::Solid(m), _) | (Part::Upper(m) | Part::Lower(m), Kind::Filled) => Some(m),
        _ => None,
    };
    cell.mesh
        .triangles
        .iter()
        .zip(&cell.mesh.parts)
        .filter_map(move |(t, &p)| material(p).map(|m| (*t, m)))
}

/// Indices of the twelve unknowns of a triangle.
pub(crate) fn dofs(triangle: &[usize; 6], independent: &[usize]) -> [usize; 12] {
    std::array::from_fn(|i| 2 * independent[triangle[i / 2]] + i % 2)
}

/// Numbers the nodes of the solid; nodes on the right face have the numbers of their partners on the left face.
pub(crate) fn periodic(cell: &Cell, solid: &[([usize; 6], usize)]) -> Result<Vec<usize>, Error> {
    let [pitch, height] = cell.size;
    let nodes = &cell.mesh.nodes;
    let mut used = vec![false; nodes.len()];
    solid.iter().for_each(|(t, _)| t.iter().for_each(|&k| used[k] = true));
    let on = |k: usize, side: f64| used[k] && (nodes[k][0] - side * pitch / 2.0).abs() < 1e-9 * pitch;
    let face = |side: f64| {
        let mut all: Vec<usize> = (0..nodes.len()).filter(|&k| on(k, side)).collect();
        all.sort_by(|&a, &b| nodes[a][1].total_cmp(&nodes[b][1]));
        all
    };
    let (left, right) = (face(-1.0), face(1.0));
    let paired = |(&a, &b): (&usize, &usize)| (nodes[a][1] - nodes[b][1]).abs() < 1e-7 * height;
    if left.len() != right.len() || !left.iter().zip(&right).all(paired) {
        return Err(Error::Mesh("the two faces of the period do not match".to_owned()));
    }
    let mut independent = vec![usize::MAX; nodes.len()];
    let fellow: HashMap<usize, usize> = right.iter().copied().zip(left.iter().copied()).collect();
    let own = (0..nodes.len()).filter(|k| used[*k] && !fellow.contains_key(k));
    own.enumerate().for_each(|(number, k)| independent[k] = number);
    for (right, left) in fellow {
        independent[right] = independent[left];
    }
    Ok(independent)
}

/// Boundary integral of N_i n over a cavity's wall: derivative of its area by the nodal displacements.
pub(crate) fn walls(cell: &Cell, independent: &[usize], n: usize, of: fn(Part) -> bool) -> Vec<f64> {
    let mut out = vec![0.0; n];
    for ([a, middle, b], _) in cavity_walls(cell, of) {
        let nodes = [a, b, middle].map(|k| cell.mesh.nodes[k]);
        for [t, w] in GAUSS {
            // Shapes of an edge from those of the triangle: L0 = 1 - t, L1 = t, L2 = 0.
            let (s, ds) = shapes(t, 0.0);
            let shape = [s[0], s[1], s[3]];
            let slope = [ds[0][0], ds[1][0], ds[3][0]];
            let d: [f64; 2] = std::array::from_fn(|c| (0..3).map(|k| slope[k] * nodes[k][c]).sum());
            // Counter-clockwise along (dz, dx): the outward normal is (dx, -dz).
            for (k, node) in [a, b, middle].into_iter().enumerate() {
                out[2 * independent[node]] += w * shape[k] * d[1];
                out[2 * independent[node] + 1] -= w * shape[k] * d[0];
            }
        }
    }
    out
}

/// Edges (first, middle, last) between the selected cavities and the solid, counter-clockwise about the cavity.
pub(crate) fn cavity_walls(cell: &Cell, of: fn(Part) -> bool) -> Vec<([usize; 3], Part)> {
    let mut open: HashMap<usize, ([usize; 3], Part)> = HashMap::new();
    for (t, &part) in cell.mesh.triangles.iter().zip(&cell.mesh.parts) {
        if !of(part) {
            continue;
        }
        for k in 0..3 {
            let middle = t[3 + k];
            if open.remove(&middle).is_none() {
                open.insert(middle, ([t[k], middle, t[(k + 1) % 3]], part));
            }
        }
    }
    let mut all: Vec<_> = open.into_values().collect();
    all.sort_by_key(|(edge, _)| edge[1]);
    all
}
