//! The unit cell in three dimensions: half of the beam's width with bladder, its end and side wall.
//!
//! ```text
//! u = macroscopic part of stretch and curvature + w,   w periodic along the beam,   u_y = 0 on the plane of symmetry y = 0     [D1]
//! ```
//!
//! All sides are free. A bladder extends to y = l_b/2; beyond it the cross-section is solid. Pressure acts on its walls
//! and its end, so a = volume / l_b. In addition to the plane cell, this cell includes the restraint by the ends, the
//! outward bending of the side walls, and common lateral strains of core and side walls.
//!
//! The mesh consists of layers of the plane cell's mesh across the width.

mod element;

use crate::cell::respond::{cavity_walls, periodic};
use crate::cell::{Cell, Part, folded};
use crate::coefficients::Options;
use crate::dense::{dot, solve};
use crate::element::{GAUSS, shapes, sites};
use crate::error::{Error, Fault};
use crate::input::Section;
use crate::level::Level;
use crate::mesh::Fineness;
use crate::sparse::Factor;
use element::{ROWS, matrix};

/// Limit of the relative size of entries, over the geometric mean of their diagonal entries. Smaller entries are
/// compared with this limit.
pub const SMALL: f64 = 0.01;

/// Compliance from the cell in three dimensions.
#[derive(Debug, Clone)]
pub struct Spatial {
    /// Compliance as of the plane cell, on the finer mesh.
    pub compliance: [[f64; 4]; 4],
    /// Difference from the coarser mesh over the geometric mean of the diagonal entries.
    pub errors: [[f64; 4]; 4],
    /// Difference of the plane cell's compliance over the magnitude of this one; entries below [SMALL] count as
    /// [SMALL].
    pub plane_off: [[f64; 4]; 4],
    /// Number of displacement unknowns of the finer mesh.
    pub unknowns: usize,
}

impl Section {
    /// Compliance of the three-dimensional cell from two meshes. Requires side walls: bladders shorter than the section
    /// is wide.
    pub fn three_dimensional(&self) -> Result<Spatial, Error> {
        let mesh = self.meshes(&Options::default())?.pop().ok_or(Error::Singular)?;
        self.beside(&Level::new(self, &Cell::new(self, &mesh))?)
    }

    /// Compliance of the three-dimensional cell, compared with the finest level of the plane cell.
    pub(crate) fn beside(&self, plane: &Level) -> Result<Spatial, Error> {
        let coarse = Fineness {
            largest: 0.5,
            corner: 0.03,
            wall: 1.4,
            arc: 0.8,
            growth: 1.2,
        };
        let fine = Fineness {
            corner: 0.02,
            ..Fineness::default()
        };
        let (before, _) = self.spatial(&coarse, 3)?;
        let (compliance, unknowns) = self.spatial(&fine, 4)?;
        let plane = &plane.compliance;
        let over = |f: &dyn Fn(usize, usize) -> f64| -> [[f64; 4]; 4] {
            std::array::from_fn(|i| std::array::from_fn(|j| f(i, j)))
        };
        let scale = |i: usize, j: usize| (compliance[i][i] * compliance[j][j]).sqrt().max(f64::MIN_POSITIVE);
        Ok(Spatial {
            errors: over(&|i, j| (compliance[i][j] - before[i][j]).abs() / scale(i, j)),
            plane_off: over(&|i, j| {
                let least = SMALL * scale(i, j);
                (plane[i][j] - compliance[i][j]) / compliance[i][j].abs().max(least)
            }),
            compliance,
            unknowns,
        })
    }

    /// Compliance and number of unknowns on one mesh, with `layers` layers along half a bladder.
    pub fn spatial(&self, fineness: &Fineness, layers: usize) -> Result<([[f64; 4]; 4], usize), Error> {
        let options = Options {
            fineness: *fineness,
            meshes: 1,
        };
        let mesh = self.meshes(&options)?;
        let (length, width) = (self.bladders.length_m, self.width_m);
        if length >= width * (1.0 - 1e-9) {
            let what = "a section in three dimensions needs bladders shorter than the beam's width";
            return Err(Error::Section(vec![Fault {
                place: "/bladders/length_m".to_owned(),
                what: what.to_owned(),
            }]));
        }
        Spread::new(Cell::new(self, &mesh[0]), across(length / 2.0, width / 2.0, layers)).compliance(self)
    }
}

/// Planes between layers, and the number of layers in the bladder. There the thickness grows threefold per layer away
/// from the end.
fn across(end: f64, half: f64, layers: usize) -> (Vec<f64>, usize) {
    let sum: f64 = (0..layers).map(|k| 3.0_f64.powi(k as i32)).sum();
    let mut planes = vec![end];
    for k in 0..layers {
        planes.push(planes[k] - end * 3.0_f64.powi(k as i32) / sum);
    }
    planes[layers] = 0.0;
    planes.reverse();
    let wall = layers.div_ceil(2);
    planes.extend((1..=wall).map(|k| end + (half - end) * k as f64 / wall as f64));
    (planes, layers)
}

/// The plane cell extruded over half the width.
struct Spread {
    cell: Cell,
    planes: Vec<f64>,
    /// Number of layers along the bladder.
    hollow: usize,
}

impl Spread {
    fn new(cell: Cell, (planes, hollow): (Vec<f64>, usize)) -> Self {
        Self { cell, planes, hollow }
    }

    fn compliance(&self, section: &Section) -> Result<([[f64; 4]; 4], usize), Error> {
        let material = |part: Part| match part {
            Part::Solid(m) | Part::Upper(m) | Part::Lower(m) => m,
        };
        let all: Vec<_> = self
            .cell
            .mesh
            .triangles
            .iter()
            .zip(&self.cell.mesh.parts)
            .map(|(t, p)| (*t, material(*p)))
            .collect();
        let flat = periodic(&self.cell, &all)?;
        let levels = 2 * (self.planes.len() - 1) + 1;
        // Number all (node, plane) pairs of the solid, three unknowns each.
        let count = flat.iter().filter(|&&k| k != usize::MAX).max().map_or(0, |m| m + 1);
        let mut number = vec![usize::MAX; count * levels];
        let layers = self.planes.len() - 1;
        let solid = |layer: usize, part: Part| layer >= self.hollow || matches!(part, Part::Solid(_));
        let mut next = 0;
        for layer in 0..layers {
            for (t, &part) in self.cell.mesh.triangles.iter().zip(&self.cell.mesh.parts) {
                if !solid(layer, part) {
                    continue;
                }
                for &node in t {
                    for j in 0..3 {
                        let at = &mut number[flat[node] * levels + 2 * layer + j];
                        if *at == usize::MAX {
                            *at = next;
                            next += 1;
                        }
                    }
                }
            }
        }
        let n = 3 * next;
        let dof = |node: usize, level: usize, c: usize| 3 * number[flat[node] * levels + level] + c;
        // Fixed: across on the plane of symmetry; along and high at one node there.
        let mut held = vec![false; n];
        for k in 0..count {
            if number[k * levels] != usize::MAX {
                held[3 * number[k * levels] + 2] = true;
            }
        }
        let first = (0..count)
            .map(|k| number[k * levels])
            .find(|&k| k != usize::MAX)
            .unwrap_or(0);
        held[3 * first] = true;
        held[3 * first + 1] = true;
        let mut entries = Vec::new();
        let mut sides = vec![vec![0.0; n]; 4];
        let mut corner = [[0.0; 2]; 2];
        for (t, &part) in self.cell.mesh.triangles.iter().zip(&self.cell.mesh.parts) {
            let mut known: Option<(f64, Vec<[f64; ROWS]>)> = None;
            for layer in (0..layers).filter(|&l| solid(l, part)) {
                let thickness = self.planes[layer + 1] - self.planes[layer];
                if known
                    .as_ref()
                    .is_none_or(|(h, _)| (h - thickness).abs() > 1e-12 * thickness)
                {
                    let k = matrix(&self.cell.corners(t), thickness, &self.cell.materials[material(part)])
                        .ok_or_else(folded)?;
                    known = Some((thickness, k));
                }
                let Some((_, k)) = &known else { continue };
                let of = |i: usize| dof(t[i / 3 % 6], 2 * layer + i / 18, i % 3);
                for i in 0..54 {
                    let row = of(i);
                    (0..2).for_each(|a| sides[a][row] += k[54 + a][i]);
                    for j in 0..=i {
                        let column = of(j);
                        if !held[row] && !held[column] {
                            entries.push((row.max(column), row.min(column), k[i][j]));
                            // If two nodes coincide across the period, the mirror entry is at the same position.
                            if row == column && i != j {
                                entries.push((row, column, k[i][j]));
                            }
                        }
                    }
                }
                corner[0][0] += k[54][54];
                corner[1][0] += k[55][54];
                corner[1][1] += k[55][55];
            }
        }
        corner[0][1] = corner[1][0];
        let end = section.bladders.length_m / 2.0;
        let rows: [fn(Part) -> bool; 2] = [|p| matches!(p, Part::Upper(_)), |p| matches!(p, Part::Lower(_))];
        let mut own = [[0.0; 2]; 2];
        for (c, of) in rows.into_iter().enumerate() {
            self.press(&mut sides[2 + c], of, &dof)?;
            let [area, moment, _] = self.cell.moments(&|p| f64::from(of(p)))?;
            own[c] = [area * end, moment * end];
        }
        let stiff = section.material.young_modulus_pa * section.pitch_m;
        for k in (0..n).filter(|&k| held[k]) {
            entries.push((k, k, stiff));
            sides.iter_mut().for_each(|s| s[k] = 0.0);
        }
        let fields = Factor::new(n, &entries)?.solve(&sides);
        let mean = |i: usize, j: usize| (dot(&sides[i], &fields[j]) + dot(&sides[j], &fields[i])) / 2.0;
        let s: [[f64; 2]; 2] = std::array::from_fn(|i| std::array::from_fn(|j| 2.0 * (corner[i][j] - mean(i, j))));
        let t: [[f64; 2]; 2] = std::array::from_fn(|c| std::array::from_fn(|j| 2.0 * (own[c][j] - mean(2 + c, j))));
        let pitch = section.pitch_m;
        let loads = [[pitch, 0.0], [0.0, pitch], t[0], t[1]];
        let mut c = [[0.0; 4]; 4];
        for j in 0..4 {
            let q = solve(s, loads[j]).ok_or(Error::Singular)?;
            for i in 0..4 {
                let more = if i >= 2 && j >= 2 { 2.0 * mean(i, j) } else { 0.0 };
                c[i][j] = (dot(&loads[i], &q) + more) / pitch;
            }
        }
        Ok((
            std::array::from_fn(|i| std::array::from_fn(|j| (c[i][j] + c[j][i]) / 2.0)),
            n,
        ))
    }

    /// Integral of u . n over the walls and the end of a bladder.
    fn press(
        &self,
        side: &mut [f64],
        of: fn(Part) -> bool,
        dof: &dyn Fn(usize, usize, usize) -> usize,
    ) -> Result<(), Error> {
        for (edge, _) in cavity_walls(&self.cell, of) {
            let nodes = edge.map(|k| self.cell.mesh.nodes[k]);
            for [t, w] in GAUSS {
                let (s, ds) = shapes(t, 0.0);
                let (n, d) = ([s[0], s[3], s[1]], [ds[0][0], ds[3][0], ds[1][0]]);
                let tangent: [f64; 2] = std::array::from_fn(|c| (0..3).map(|k| d[k] * nodes[k][c]).sum());
                for layer in 0..self.hollow {
                    let thickness = self.planes[layer + 1] - self.planes[layer];
                    // Integrals of the three quadratic shapes (Simpson's weights).
                    for (j, share) in [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0].into_iter().enumerate() {
                        for k in 0..3 {
                            let f = w * n[k] * share * thickness;
                            side[dof(edge[k], 2 * layer + j, 0)] += f * tangent[1];
                            side[dof(edge[k], 2 * layer + j, 1)] -= f * tangent[0];
                        }
                    }
                }
            }
        }
        for (t, &part) in self.cell.mesh.triangles.iter().zip(&self.cell.mesh.parts) {
            if of(part) {
                for site in sites(&self.cell.corners(t)).ok_or_else(folded)? {
                    (0..6).for_each(|i| side[dof(t[i], 2 * self.hollow, 2)] += site.weight * site.shapes[i]);
                }
            }
        }
        Ok(())
    }
}
