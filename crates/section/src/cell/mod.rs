//! One unit cell: its mesh, and its response to stretch, curvature and pressures.
//!
//! ```text
//! u = macroscopic part + w,   w periodic in z                                                    [L1]
//! macroscopic   u_z = z (e + kappa x)      u_x = -kappa z^2/2 - g1 y^2/2      u_y = y (g0 + g1 x)
//! strains       zz = e + kappa x           yy = g0 + g1 x                     no shear
//! ```
//!
//! e is the stretch and kappa the curvature of the beam (positive: the +x fibre in tension). g0 and g1 are the uniform
//! and the anticlastic strain across the width. They are free: their conjugate forces vanish, except for the thrust of
//! the fluid on the two ends of a bladder. A bladder's volume per length changes by
//!
//! ```text
//! da = boundary integral of u . n + A (g0 + g1 x_c)                                              [L2]
//! ```
//!
//! The first term contains the cavity's macroscopic strain A (e + kappa x_c). Pressure p does the work p da: it acts on
//! the walls, and through the ends with p A at the centroid x_c. The response is therefore reciprocal by construction.

pub(crate) mod respond;
mod shear;

use crate::element::poisson;
use crate::error::Error;
use crate::geometry::outline::{Outline, inside};
use crate::input::{Material, Point, Row, Section};
use crate::mesh::{Domain, Fineness, Mesh, Quadratic};
use crate::permeability;

pub use respond::{Kind, Response};

/// Part of the cell that contains a triangle, with the index of its material in [Cell::materials].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Solid.
    Solid(usize),
    /// The upper row's bladder, with the material around it.
    Upper(usize),
    /// The lower row's bladder, with the material around it.
    Lower(usize),
}

/// A meshed unit cell.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Quadratic triangles, including those of cavities.
    pub mesh: Quadratic<Part>,
    /// Material of the section, then those of the regions.
    pub materials: Vec<Material>,
    /// Pitch and height [m].
    pub size: [f64; 2],
}

/// Outlines of the upper and the lower bladder.
pub fn bladders(section: &Section) -> [Option<Outline>; 2] {
    let own = |row: &Row| match row {
        Row::Bladder(bladder) => Some(Outline::bladder(bladder)),
        _ => None,
    };
    let upper = own(&section.bladders.upper);
    let lower = match section.bladders.lower {
        Row::Mirrored => upper.as_ref().map(Outline::mirrored),
        ref row => own(row),
    };
    [upper, lower]
}

/// Coarsest mesh of a section's cell.
pub fn mesh(section: &Section, fineness: &Fineness) -> Result<Mesh<Part>, Error> {
    let (half_pitch, half) = (section.pitch_m / 2.0, section.height_m / 2.0);
    let rows = bladders(section);
    let mirrored = section.bladders.lower == Row::Mirrored && section.regions.is_empty();
    let bottom = if mirrored { 0.0 } else { -half };
    let mut outlines = vec![Outline::rectangle([-half_pitch, half_pitch], [bottom, half])];
    let regions: Vec<Outline> = section
        .regions
        .iter()
        .map(|r| Outline::region(&r.shape, section.pitch_m))
        .collect();
    outlines.extend(rows.iter().take(if mirrored { 1 } else { 2 }).flatten().cloned());
    outlines.extend(regions.iter().cloned());
    let cavities: Vec<Option<Vec<Point>>> = rows.iter().map(|r| r.as_ref().map(Outline::chords)).collect();
    let regions: Vec<Vec<Point>> = regions.iter().map(Outline::chords).collect();
    let part = |p: Point| {
        let material = regions.iter().position(|r| inside(r, p)).map_or(0, |k| k + 1);
        let within = |k: usize| cavities[k].as_ref().is_some_and(|c| inside(c, p));
        Some(match (within(0), within(1)) {
            (true, _) => Part::Upper(material),
            (_, true) => Part::Lower(material),
            _ => Part::Solid(material),
        })
    };
    let domain = Domain {
        outlines,
        half_pitch: Some(half_pitch),
        mirrored,
    };
    let mesh = Mesh::new(&domain, fineness, &part)?;
    let other = |part| match part {
        Part::Upper(k) => Part::Lower(k),
        part => part,
    };
    Ok(if mirrored { mesh.with_mirror(&other) } else { mesh })
}

/// Integrals over a cavity: area [m^2], area times height of the centroid [m^3], second moment about the mid-plane
/// [m^4].
pub type Moments = [f64; 3];

impl Cell {
    /// Cell from a mesh of the section's cell.
    pub fn new(section: &Section, mesh: &Mesh<Part>) -> Self {
        let regions = section.regions.iter().map(|r| r.material);
        let materials = std::iter::once(section.material).chain(regions).collect();
        Self {
            mesh: mesh.quadratic(),
            materials,
            size: [section.pitch_m, section.height_m],
        }
    }

    /// The six nodes of a triangle.
    pub fn corners(&self, triangle: &[usize; 6]) -> [Point; 6] {
        triangle.map(|k| self.mesh.nodes[k])
    }

    /// Moments of the parts of the cell, weighted by `weight`.
    pub fn moments(&self, weight: &dyn Fn(Part) -> f64) -> Result<Moments, Error> {
        let mut sum = [0.0; 3];
        for (triangle, &part) in self.mesh.triangles.iter().zip(&self.mesh.parts) {
            let w = weight(part);
            if w == 0.0 {
                continue;
            }
            for site in crate::element::sites(&self.corners(triangle)).ok_or_else(folded)? {
                let x = site.place[1];
                sum[0] += w * site.weight;
                sum[1] += w * site.weight * x;
                sum[2] += w * site.weight * x * x;
            }
        }
        Ok(sum)
    }

    /// Permeability q1 [m^4] of the bladders selected by `of`: see [permeability].
    pub fn permeability(&self, of: &dyn Fn(Part) -> bool) -> Result<f64, Error> {
        let chosen: Vec<[usize; 6]> = self
            .mesh
            .triangles
            .iter()
            .zip(&self.mesh.parts)
            .filter(|(_, p)| of(**p))
            .map(|(t, _)| *t)
            .collect();
        permeability::flow(&self.mesh.nodes, &chosen, &|nodes| poisson::matrix(nodes))
    }
}

/// Error for a folded element.
pub fn folded() -> Error {
    Error::Mesh("an element beside a curve is folded".to_owned())
}
