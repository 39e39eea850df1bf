//! Properties of the beam's section from one mesh of the cell.
//!
//! Per cell, at given loads (N, M, p_u, p_l). S and S_side are per unit width of the hollow core (l_b) and of the side
//! walls (w_s - l_b):
//!
//! ```text
//! A q = pitch (N, M, 0, 0) + l_b T^T p,    A = l_b S + (w_s - l_b) S_side on (e, kappa)                [C1]
//! C (N, M, p_u, p_l) = (e, kappa, phi_b l_b a_u, phi_b l_b a_l),    phi_b = 1/pitch                    [C2]
//! ```
//!
//! The side walls share stretch and curvature with the core; their lateral strains are independent and free. Products
//! of loads and conjugate quantities are energies per unit length of the beam. C is therefore symmetric: g* = 1/2
//! load.C load (model.md, 4.2).

use crate::cell::{Cell, Kind, Moments, Part, Response};
use crate::dense::solve;
use crate::error::Error;
use crate::input::Section;

/// Results on one mesh.
#[derive(Debug, Clone)]
pub struct Level {
    /// C of [C2].
    pub compliance: [[f64; 4]; 4],
    /// Largest relative difference of transposed entries before symmetrization.
    pub asymmetry: f64,
    /// kGA [N].
    pub shear_stiffness: f64,
    /// Moments of the upper and lower bladder's cross-section.
    pub cavities: [Moments; 2],
    /// Mass of the solid per unit length [kg/m] and its second moment about the mid-plane [kg m].
    pub solid: [f64; 2],
    /// Permeability of the upper and lower bladder [m^4]; zero without a bladder.
    pub permeability: [f64; 2],
    /// Number of displacement unknowns.
    pub unknowns: usize,
}

impl Level {
    /// Solves a cell.
    pub fn new(section: &Section, cell: &Cell) -> Result<Self, Error> {
        let [pitch, _] = cell.size;
        let (core, side) = (section.bladders.length_m, section.width_m - section.bladders.length_m);
        let response = Response::new(cell, Kind::Hollow)?;
        let walls = Walls::new(section, cell)?;
        let mut a = response.stiffness.map(|row| row.map(|k| core * k));
        for i in 0..2 {
            for j in 0..2 {
                a[i][j] += side * walls.stiffness[i][j];
            }
        }
        let t = response.area_by_strain.map(|row| row.map(|k| core * k));
        let loads = [[pitch, 0.0, 0.0, 0.0], [0.0, pitch, 0.0, 0.0], t[0], t[1]];
        let mut q = [[0.0; 4]; 4];
        for (q, load) in q.iter_mut().zip(loads) {
            *q = solve(a, load).ok_or(Error::Singular)?;
        }
        let mut c = [[0.0; 4]; 4];
        for i in 0..4 {
            for j in 0..4 {
                let work = crate::dense::dot(&loads[i], &q[j]);
                let own = if i >= 2 && j >= 2 {
                    core * response.area_by_pressure[i - 2][j - 2]
                } else {
                    0.0
                };
                c[i][j] = (work + own) / pitch;
            }
        }
        let unlike = |i: usize, j: usize| (c[i][j] - c[j][i]).abs() / (c[i][i] * c[j][j]).sqrt().max(f64::MIN_POSITIVE);
        let asymmetry = (0..4)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| unlike(i, j))
            .fold(response.asymmetry, f64::max);
        let density = |part: Part| match part {
            Part::Solid(m) => (core + side) * cell.materials[m].density_kg_m3 / pitch,
            Part::Upper(m) | Part::Lower(m) => side * cell.materials[m].density_kg_m3 / pitch,
        };
        let [mass, _, rotary] = cell.moments(&density)?;
        let flow = |of: fn(Part) -> bool, area: f64| if area > 0.0 { cell.permeability(&of) } else { Ok(0.0) };
        let upper = flow(|p| matches!(p, Part::Upper(_)), response.cavities[0][0])?;
        let lower = match section.bladders.lower {
            crate::input::Row::Mirrored => upper,
            _ => flow(|p| matches!(p, Part::Lower(_)), response.cavities[1][0])?,
        };
        Ok(Self {
            compliance: std::array::from_fn(|i| std::array::from_fn(|j| (c[i][j] + c[j][i]) / 2.0)),
            asymmetry,
            shear_stiffness: core * response.shear_stiffness(cell)? + side * walls.shear,
            cavities: response.cavities,
            solid: [mass, rotary],
            permeability: [upper, lower],
            unknowns: response.unknowns,
        })
    }
}

/// Side walls beyond the bladders' ends, per unit of their width.
pub(crate) struct Walls {
    pub(crate) stiffness: [[f64; 2]; 2],
    shear: f64,
}

impl Walls {
    pub(crate) fn new(section: &Section, cell: &Cell) -> Result<Self, Error> {
        let [pitch, h] = cell.size;
        if !section.regions.is_empty() && section.width_m > section.bladders.length_m {
            let solid = Response::new(cell, Kind::Filled)?;
            return Ok(Self {
                stiffness: solid.free_stiffness()?,
                shear: solid.shear_stiffness(cell)?,
            });
        }
        // One material: uniaxial stress, and a parabolic shear stress.
        let e = section.material.young_modulus_pa;
        let stiffness = [[e * pitch * h, 0.0], [0.0, e * pitch * h.powi(3) / 12.0]];
        Ok(Self {
            stiffness,
            shear: 5.0 / 6.0 * section.material.shear_modulus() * h,
        })
    }
}
