//! What a disturbance is made of: bending modes of the dry beam, motion along it, fluid.

use nalgebra::{DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

use crate::case::{Rotation, Translation};
use crate::discrete::System;

/// Bending modes looked at.
const MODES: usize = 8;

/// What most of the energy of a disturbance is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// A bending mode of the dry beam, counted from 1.
    Bending(usize),
    /// Motion along the beam.
    Along,
    /// Fluid and bladders.
    Fluid,
}

impl std::fmt::Display for Part {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bending(mode) => write!(f, "mode {mode}"),
            Self::Along => f.write_str("the motion along the beam"),
            Self::Fluid => f.write_str("the fluid"),
        }
    }
}

/// Bending modes of the straight dry beam on its mesh.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Angular frequencies [1/s], ascending; rigid motions left out.
    pub frequencies: Vec<f64>,
    /// Shapes at the free nodes, `Σ mass u² = 1` [1/kg^(1/2)], one a row.
    shapes: Vec<Vec<f64>>,
    /// Mass of the free nodes [kg].
    masses: Vec<f64>,
}

impl Modes {
    /// The lowest modes of a system: stiffness `Σ EI κ² length` of the curvatures at nodes, mass at nodes. Empty where nothing
    /// can move across.
    pub fn new(system: &System) -> Self {
        let (mesh, free) = (&system.mesh, &system.layout.lines[0].free);
        let (section, h, n) = (&system.model.section, system.mesh.h, free.len());
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        let mut bend = |terms: &[(usize, f64)], length: f64| {
            for (i, a) in terms.iter().filter(|(i, _)| free.contains(i)) {
                for (j, b) in terms.iter().filter(|(j, _)| free.contains(j)) {
                    stiffness[(i - free.start, j - free.start)] += section.bending_stiffness * a * b * length;
                }
            }
        };
        let per = 1.0 / (h * h);
        for i in 1..mesh.nodes - 1 {
            bend(&[(i - 1, per), (i, -2.0 * per), (i + 1, per)], h);
        }
        for (end, inner, k) in [(0, 1, 0), (mesh.nodes - 1, mesh.nodes - 2, 1)] {
            // a held slope: half a cell over which the angle of the next cell is lost
            if matches!(system.model.ends[k].rotation, Rotation::Slope(_)) {
                bend(&[(end, -2.0 * per), (inner, 2.0 * per)], 0.5 * h);
            }
        }
        let masses = system.masses[free.clone()].to_vec();
        let reduced = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] / (masses[i] * masses[j]).sqrt());
        let eigen = SymmetricEigen::new(reduced);
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let rigid = 1e-6 * section.bending_stiffness / (section.mass_per_length * system.model.length.powi(4));
        let kept: Vec<usize> = order
            .into_iter()
            .filter(|&k| eigen.eigenvalues[k] > rigid)
            .take(MODES)
            .collect();
        Self {
            frequencies: kept.iter().map(|&k| eigen.eigenvalues[k].sqrt()).collect(),
            shapes: kept
                .iter()
                .map(|&k| (0..n).map(|i| eigen.eigenvectors[(i, k)] / masses[i].sqrt()).collect())
                .collect(),
            masses,
        }
    }

    /// Energies of a small disturbance of the scaled unknowns [J]: of every mode, along the beam, of the fluid.
    fn energies(&self, system: &System, v: &[f64]) -> (Vec<f64>, f64, f64) {
        let (l, s) = (&system.layout, &system.model.section);
        let [across, along] = &l.lines;
        let at = |k: usize| v[k] * l.scales[k];
        let modal = |first: usize, shape: &[f64]| -> f64 {
            let terms = shape.iter().zip(&self.masses).enumerate();
            terms.map(|(k, (shape, mass))| shape * mass * at(first + k)).sum()
        };
        let bending = self.shapes.iter().zip(&self.frequencies).map(|(shape, w)| {
            let rate = across.v.as_ref().map_or(0.0, |v| modal(v.start, shape));
            0.5 * ((w * modal(across.u.start, shape)).powi(2) + rate * rate)
        });
        let (stretch, _) = stretched(system, v);
        let h = system.mesh.h;
        let speeds = along.v.iter().flat_map(|v| v.clone());
        let speed: f64 = speeds.map(|k| at(k).powi(2)).sum();
        let along = 0.5 * (s.axial_stiffness * stretch + s.mass_per_length * h * speed);
        let fluid = system
            .model
            .wet
            .as_ref()
            .zip(system.fluid.as_ref())
            .map_or(0.0, |(wet, fluid)| {
                let squares: f64 = l.network.area.clone().map(|k| at(k).powi(2)).sum();
                0.5 * squares * fluid.ds / wet.compliance()
            });
        (bending.collect(), along, fluid)
    }

    /// What the energy of a disturbance of the scaled unknowns in a part is made of: the squares add up to twice that [J^(1/2)]. Empty for
    /// the fluid.
    pub fn coordinates(&self, system: &System, part: Part, v: &[f64]) -> Vec<f64> {
        let (l, s) = (&system.layout, &system.model.section);
        let [across, along] = &l.lines;
        let at = |k: usize| v[k] * l.scales[k];
        match part {
            Part::Bending(mode) => {
                let (shape, w) = (&self.shapes[mode - 1], self.frequencies[mode - 1]);
                let modal = |first: usize| -> f64 {
                    let terms = shape.iter().zip(&self.masses).enumerate();
                    terms.map(|(k, (shape, mass))| shape * mass * at(first + k)).sum()
                };
                let rate = across.v.as_ref().map_or(0.0, |v| modal(v.start));
                vec![w * modal(across.u.start), rate]
            }
            Part::Along => {
                let h = system.mesh.h;
                let u3 = displacements(system, v);
                let stretch = u3.windows(2).map(|u| (u[1] - u[0]) * (s.axial_stiffness / h).sqrt());
                let speeds = along.v.iter().flat_map(|v| v.clone());
                stretch
                    .chain(speeds.map(|k| at(k) * (s.mass_per_length * h).sqrt()))
                    .collect()
            }
            Part::Fluid => vec![],
        }
    }

    /// Angular frequency [1/s] that the dry beam has in the shape of a disturbance most of whose energy is in `part`: of motion
    /// along it by Rayleigh's quotient; 0 for the fluid.
    pub fn frequency(&self, system: &System, part: Part, v: &[Vec<f64>; 2]) -> f64 {
        match part {
            Part::Bending(mode) => self.frequencies[mode - 1],
            Part::Along => {
                let [a, b] = v.each_ref().map(|v| stretched(system, v));
                let s = &system.model.section;
                let mass = s.mass_per_length * (a.1 + b.1);
                (s.axial_stiffness * (a.0 + b.0) / mass.max(f64::MIN_POSITIVE)).sqrt()
            }
            Part::Fluid => 0.0,
        }
    }

    /// What most of the energy of a disturbance is in, given by real and imaginary part, and its share of the whole.
    pub fn dominant(&self, system: &System, v: &[Vec<f64>; 2]) -> (Part, f64) {
        let mut parts: Vec<(Part, f64)> = (1..=self.frequencies.len())
            .map(Part::Bending)
            .chain([Part::Along, Part::Fluid])
            .map(|part| (part, 0.0))
            .collect();
        for v in v {
            let (bending, along, fluid) = self.energies(system, v);
            for (part, energy) in parts.iter_mut().zip(bending.into_iter().chain([along, fluid])) {
                part.1 += energy;
            }
        }
        let whole: f64 = parts.iter().map(|p| p.1).sum();
        let (part, energy) = parts
            .into_iter()
            .fold((Part::Fluid, 0.0), |most, p| if p.1 > most.1 { p } else { most });
        (part, if whole > 0.0 { energy / whole } else { 0.0 })
    }
}

/// Displacements along the beam of a disturbance [m] at the free nodes and at held ends.
fn displacements(system: &System, v: &[f64]) -> Vec<f64> {
    let l = &system.layout;
    let held = |k: usize| matches!(system.model.ends[k].axial, Translation::Displacement(_));
    let free = l.lines[1].u.clone().map(|k| v[k] * l.scales[k]);
    (held(0).then_some(0.0).into_iter())
        .chain(free)
        .chain(held(1).then_some(0.0))
        .collect()
}

/// `Σ Δu3²/h` over the cells and `Σ u3² h` over the free nodes of a disturbance.
fn stretched(system: &System, v: &[f64]) -> (f64, f64) {
    let h = system.mesh.h;
    let u3 = displacements(system, v);
    let squares = u3.iter().map(|u| u * u).sum::<f64>() * h;
    (u3.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>() / h, squares)
}
