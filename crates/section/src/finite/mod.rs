//! Unit cell at finite strain: energy of the section as a function of stretch, curvature and pressures.
//!
//! ```text
//! Omega(e, kappa, p_u, p_l) = min over w, g0, g1 of  1/pitch (U_core + U_walls) - phi_b l_b sum of p (a - a_rest)     [F5]
//! N = dOmega/de      M = dOmega/dkappa      phi_b l_b (a - a_rest) = -dOmega/dp
//! ```
//!
//! per unit length of the beam. U_core is l_b times the energy [F2] of the cell with its faces carried along an arc
//! [F3]. w is periodic in the frame that rotates with the beam, so pressures follow the walls.
//!
//! The side walls are bars: a fibre at rest height x has the uniaxial energy of the stretch 1 + e + kappa x. This is
//! 4 % above the bending energy of a block at 27 % strain of the outer fibre; the error decreases with the square of
//! the strain. The stretch e is that of the material on the mid-plane of the face, where w is fixed. A force N on a
//! curved beam needs a transverse load kappa N, which acts on the cell at that point. Its effect is 4e-4 of the energy
//! of a block at 5 % stretch and 27 % strain by bending.
//!
//! Layers of another material beside the core are lumped into it: there they are stiffer by the beam's width over l_b.
//! As bars they would hold stretch and curvature twice, since the core's layer moves across the beam and a bar does not.
//!
//! Omega's Hessian is symmetric, and so are all results derived from it.

mod assemble;
pub mod cavity;
pub mod element;
pub mod energy;
pub mod face;
pub mod inflation;
pub mod jet;
pub mod law;
mod solve;

use crate::cell::respond::{cavity_walls, periodic, solids};
use crate::cell::{Cell, Kind, Part};
use crate::error::Error;
use crate::input::{Region, RegionShape, Section};
use crate::sparse::Pattern;
use std::sync::OnceLock;

pub use energy::StrainEnergy;
pub use law::Law;

/// Prescribed quantities of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Stretch minus one, and curvature [1/m].
    Strain([f64; 2]),
    /// Axial force [N] and moment [N m].
    Load([f64; 2]),
}

/// Equilibrium state of a section.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionState {
    /// Stretch minus one, and curvature [1/m].
    pub strain: [f64; 2],
    /// Uniform and anticlastic strain of the core across the width [1], [1/m].
    pub lateral: [f64; 2],
    /// Pressures of the upper and lower bladder [Pa].
    pub pressures_pa: [f64; 2],
    /// Omega of [F5] [N].
    pub potential_n: f64,
    /// Axial force [N] and moment [N m].
    pub resultants: [f64; 2],
    /// Area changes of the bladders [m^2]: volume changes over their length.
    pub areas_m2: [f64; 2],
    /// Second derivatives of Omega over (e, kappa, p_upper, p_lower).
    pub tangent: [[f64; 4]; 4],
    /// Total number of Newton iterations.
    pub iterations: usize,
}

/// A cell prepared for finite strain. Forces are per unit of the core's width l_b.
pub struct FiniteCell {
    cell: Cell,
    law: Law,
    /// Elements of the solid with their materials.
    solid: Vec<([usize; 6], usize)>,
    independent: Vec<usize>,
    /// Position along the beam of a node on a face; zero for other nodes.
    face: Vec<f64>,
    /// First of the two fixed unknowns.
    held: usize,
    /// Wall edges (first, middle, last) of the upper and lower bladder.
    walls: [Vec<[usize; 3]>; 2],
    /// Width of the side walls over that of the core.
    side: f64,
    /// Heights between which the side walls are bars: those outside of layers.
    bars: Vec<[f64; 2]>,
    width: f64,
    nodes: usize,
    /// Areas of the bladders at rest [m^2].
    areas: [f64; 2],
    /// Sparsity pattern of the stiffness, equal in all states.
    pattern: OnceLock<Pattern>,
}

/// State of a cell.
#[derive(Debug, Clone)]
pub struct State {
    /// Periodic displacements and bubbles.
    w: Vec<f64>,
    /// e, kappa, g0, g1.
    q: [f64; 4],
}

impl FiniteCell {
    /// Finite-strain cell from a cell of the section. Where bladders are shorter than the beam is wide, regions must be
    /// layers.
    pub fn new(section: &Section, mut cell: Cell, law: Law) -> Result<Self, Error> {
        let side = section.width_m / section.bladders.length_m - 1.0;
        let bars = outside_layers(section);
        if side > 0.0 && bars.is_none() {
            let what = "a section with regions other than layers at finite strain needs a bladder length equal to the beam's width";
            let place = "/bladders/length_m".to_owned();
            return Err(Error::Section(vec![crate::error::Fault {
                place,
                what: what.to_owned(),
            }]));
        }
        if side > 0.0 {
            let layers = cell.materials.iter_mut().skip(1);
            layers.for_each(|layer| layer.young_modulus_pa *= 1.0 + side);
        }
        let [pitch, height] = cell.size;
        let solid: Vec<_> = solids(&cell, Kind::Hollow).collect();
        let independent = periodic(&cell, &solid)?;
        let used = |k: usize| independent[k] != usize::MAX;
        let at = |(k, p): (usize, &[f64; 2])| {
            let on = used(k) && (p[0].abs() - pitch / 2.0).abs() < 1e-9 * pitch;
            if on { p[0].signum() * pitch / 2.0 } else { 0.0 }
        };
        let face: Vec<f64> = cell.mesh.nodes.iter().enumerate().map(at).collect();
        let on_axis = |k: &usize| face[*k] != 0.0 && cell.mesh.nodes[*k][1].abs() < 1e-9 * height;
        let held = (0..face.len())
            .find(on_axis)
            .ok_or_else(|| Error::Mesh("no vertex on the mid-plane of a face".to_owned()))?;
        let upper = cavity_walls(&cell, |p| matches!(p, Part::Upper(_)));
        let lower = cavity_walls(&cell, |p| matches!(p, Part::Lower(_)));
        let nodes = independent
            .iter()
            .filter(|&&k| k != usize::MAX)
            .max()
            .map_or(0, |m| m + 1);
        let mut found = Self {
            held: 2 * independent[held],
            walls: [upper, lower].map(|w| w.into_iter().map(|(edge, _)| edge).collect()),
            width: section.bladders.length_m,
            law,
            solid,
            independent,
            face,
            side,
            bars: bars.unwrap_or_default(),
            nodes,
            areas: [0.0; 2],
            pattern: OnceLock::new(),
            cell,
        };
        found.areas = found.assemble(&found.rest(), [0.0; 2]).ok_or(Error::Singular)?.areas;
        Ok(found)
    }

    /// The state at rest.
    pub fn rest(&self) -> State {
        State {
            w: vec![0.0; 2 * (self.nodes + self.solid.len())],
            q: [0.0; 4],
        }
    }
}

/// Heights outside of layers, from the bottom to the top; None if a region is no layer.
fn outside_layers(section: &Section) -> Option<Vec<[f64; 2]>> {
    let layer = |region: &Region| match region.shape {
        RegionShape::Layer { high_m } => Some(high_m),
        _ => None,
    };
    let mut layers: Vec<[f64; 2]> = section.regions.iter().map(layer).collect::<Option<_>>()?;
    layers.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let half = section.height_m / 2.0;
    let ends = layers.iter().map(|layer| layer[0]).chain([half]);
    let starts = std::iter::once(-half).chain(layers.iter().map(|layer| layer[1]));
    Some(
        starts
            .zip(ends)
            .map(|(low, high)| [low, high])
            .filter(|[low, high]| low < high)
            .collect(),
    )
}
