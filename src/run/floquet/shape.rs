//! Parts of a disturbance: bending modes of the dry beam, motion along it, fluid.

use std::ops::Range;

use nalgebra::{DMatrix, SymmetricEigen};
use serde::{Deserialize, Serialize};

use crate::case::Rotation;
use crate::discrete::System;
use crate::discrete::layout::LineLayout;
use crate::model::Kinematics;

/// Number of bending modes.
const MODES: usize = 8;

/// The part with most of the energy of a disturbance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EnergyPart {
    /// A bending mode of the dry beam, counted from 1.
    Bending(usize),
    /// Motion along the beam.
    Along,
    /// Fluid and bladders.
    Fluid,
}

impl std::fmt::Display for EnergyPart {
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
pub struct DryBendingModes {
    /// Angular frequencies [1/s], ascending; rigid motions left out.
    pub frequencies: Vec<f64>,
    /// Shapes at the free nodes, one in each row, `Σ mass u² = 1` [1/kg^(1/2)].
    shapes: Vec<Vec<f64>>,
    /// Mass of the free nodes [kg].
    masses: Vec<f64>,
    /// Direction of the disturbed beam in every cell: components across and along.
    tangents: Vec<[f64; 2]>,
}

impl DryBendingModes {
    /// Lowest modes of a system, from the stiffness `Σ EI κ² length` of the curvatures at nodes and the mass at nodes; empty if no node
    /// can move across. `state` are the scaled unknowns that are disturbed.
    pub fn new(system: &System, state: &[f64]) -> Self {
        let (mesh, free) = (&system.mesh, &system.layout.lines[0].free);
        let (section, n) = (&system.model.section, free.len());
        let mut stiffness = DMatrix::<f64>::zeros(n, n);
        let mut bend = |terms: &[(usize, f64)], length: f64| {
            for (i, a) in terms.iter().filter(|(i, _)| free.contains(i)) {
                for (j, b) in terms.iter().filter(|(j, _)| free.contains(j)) {
                    stiffness[(i - free.start, j - free.start)] += section.bending_stiffness * a * b * length;
                }
            }
        };
        for i in 1..mesh.nodes - 1 {
            let [left, right] = [i - 1, i].map(|cell| mesh.per_length[cell] * mesh.per_node_length[i]);
            bend(
                &[(i - 1, left), (i, -left - right), (i + 1, right)],
                mesh.node_lengths[i],
            );
        }
        for (end, inner, k) in [(0, 1, 0), (mesh.nodes - 1, mesh.nodes - 2, 1)] {
            // a held slope: within half a cell the angle changes to that of the next cell
            if matches!(system.model.ends[k].rotation, Rotation::Slope(_)) {
                let per = mesh.per_length[end.min(inner)] * mesh.per_node_length[end];
                bend(&[(end, -per), (inner, per)], mesh.node_lengths[end]);
            }
        }
        let masses = system.masses[free.clone()].to_vec();
        let reduced = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] / (masses[i] * masses[j]).sqrt());
        if n == 0 {
            // nothing moves across
            let tangents = tangents(system, state);
            return Self {
                frequencies: vec![],
                shapes: vec![],
                masses,
                tangents,
            };
        }
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
            tangents: tangents(system, state),
        }
    }

    /// Energies of a small disturbance of the scaled unknowns [J]: of every mode, of motion along the beam, of the fluid.
    fn energies(&self, system: &System, v: &[f64]) -> (Vec<f64>, f64, f64) {
        let l = &system.layout;
        let across = &l.lines[0];
        let at = |k: usize| v[k] * l.scales[k];
        let modal = |first: usize, shape: &[f64]| -> f64 {
            let terms = shape.iter().zip(&self.masses).enumerate();
            terms.map(|(k, (shape, mass))| shape * mass * at(first + k)).sum()
        };
        let bending = self.shapes.iter().zip(&self.frequencies).map(|(shape, w)| {
            let rate = across.v.as_ref().map_or(0.0, |v| modal(v.start, shape));
            0.5 * ((w * modal(across.u.start, shape)).powi(2) + rate * rate)
        });
        let along = self.coordinates(system, EnergyPart::Along, v);
        let along = 0.5 * squares(&along);
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

    /// Coordinates of a disturbance of the scaled unknowns in a part. Their squares add up to twice its energy there
    /// [J^(1/2)]. Empty for
    /// the fluid.
    pub fn coordinates(&self, system: &System, part: EnergyPart, v: &[f64]) -> Vec<f64> {
        let (l, s) = (&system.layout, &system.model.section);
        let across = &l.lines[0];
        let at = |k: usize| v[k] * l.scales[k];
        match part {
            EnergyPart::Bending(mode) => {
                let (shape, w) = (&self.shapes[mode - 1], self.frequencies[mode - 1]);
                let modal = |first: usize| -> f64 {
                    let terms = shape.iter().zip(&self.masses).enumerate();
                    terms.map(|(k, (shape, mass))| shape * mass * at(first + k)).sum()
                };
                let rate = across.v.as_ref().map_or(0.0, |v| modal(v.start));
                vec![w * modal(across.u.start), rate]
            }
            EnergyPart::Along => {
                let mesh = &system.mesh;
                let [stretches, speeds] = [self.stretches(system, v), self.speeds(system, v)];
                let weighted = |(value, h): (&f64, &f64), by: f64| value * (by * h).sqrt();
                let stretches = stretches
                    .iter()
                    .zip(&mesh.lengths)
                    .map(|both| weighted(both, s.axial_stiffness));
                let speeds = speeds
                    .iter()
                    .zip(&mesh.node_lengths)
                    .map(|both| weighted(both, s.mass_per_length));
                stretches.chain(speeds).collect()
            }
            EnergyPart::Fluid => vec![],
        }
    }

    /// Angular frequency [1/s] of the dry beam in the shape of a disturbance with most of its energy in `part`. For motion along the
    /// beam it is Rayleigh's quotient; for the fluid it is 0.
    pub fn frequency(&self, system: &System, part: EnergyPart, v: &[Vec<f64>; 2]) -> f64 {
        match part {
            EnergyPart::Bending(mode) => self.frequencies[mode - 1],
            EnergyPart::Along => {
                let (s, mesh) = (&system.model.section, &system.mesh);
                let weighted = |values: &[f64], lengths: &[f64]| -> f64 {
                    values.iter().zip(lengths).map(|(value, h)| h * value * value).sum()
                };
                let (mut stretch, mut moved) = (0.0, 0.0);
                for v in v {
                    stretch += weighted(&self.stretches(system, v), &mesh.lengths);
                    let along = self.along(&nodes(system, v, |line| Some(&line.u)));
                    moved += weighted(&along, &mesh.node_lengths);
                }
                (s.axial_stiffness * stretch / (s.mass_per_length * moved).max(f64::MIN_POSITIVE)).sqrt()
            }
            EnergyPart::Fluid => 0.0,
        }
    }

    /// Part with most of the energy of a disturbance, given by real and imaginary part, and the fraction in this part.
    pub fn dominant(&self, system: &System, v: &[Vec<f64>; 2]) -> (EnergyPart, f64) {
        let mut parts: Vec<(EnergyPart, f64)> = (1..=self.frequencies.len())
            .map(EnergyPart::Bending)
            .chain([EnergyPart::Along, EnergyPart::Fluid])
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
            .fold((EnergyPart::Fluid, 0.0), |most, p| if p.1 > most.1 { p } else { most });
        (part, if whole > 0.0 { energy / whole } else { 0.0 })
    }

    /// Strains along the disturbed beam, one for each cell. A bent beam that bends further does not stretch, although it
    /// moves along its
    /// straight axis.
    fn stretches(&self, system: &System, v: &[f64]) -> Vec<f64> {
        let u = nodes(system, v, |line| Some(&line.u));
        let cells = u.windows(2).zip(&self.tangents);
        let each = cells.map(|(u, t)| t[0] * (u[1][0] - u[0][0]) + t[1] * (u[1][1] - u[0][1]));
        each.zip(&system.mesh.per_length)
            .map(|(e, inverse)| e * inverse)
            .collect()
    }

    /// Speeds along the disturbed beam [m/s], one for each node.
    fn speeds(&self, system: &System, v: &[f64]) -> Vec<f64> {
        self.along(&nodes(system, v, |line| line.v.as_ref()))
    }

    /// Components of node vectors along the disturbed beam, by the mean direction of the adjacent cells.
    fn along(&self, vectors: &[[f64; 2]]) -> Vec<f64> {
        let (tangents, last) = (&self.tangents, self.tangents.len() - 1);
        let each = vectors.iter().enumerate().map(|(i, v)| {
            let sides = [tangents[i.saturating_sub(1)], tangents[i.min(last)]];
            sides.iter().map(|t| 0.5 * (t[0] * v[0] + t[1] * v[1])).sum()
        });
        each.collect()
    }
}

/// Direction in which the beam is stretched in every cell, components across and along, [E11] [E26]: `∂e/∂(u1', u3')`.
fn tangents(system: &System, state: &[f64]) -> Vec<[f64; 2]> {
    let u = nodes(system, state, |line| Some(&line.u));
    let cells = u
        .windows(2)
        .zip(&system.mesh.per_length)
        .map(|(u, inverse)| [0, 1].map(|axis| (u[1][axis] - u[0][axis]) * inverse));
    let each = cells.map(|[across, along]| match system.model.kinematics {
        Kinematics::Bar | Kinematics::Linear => [0.0, 1.0],
        Kinematics::SmallRotation => [across, 1.0],
        Kinematics::FiniteRotation => {
            let length = across.hypot(1.0 + along);
            [across / length, (1.0 + along) / length]
        }
    });
    each.collect()
}

/// Values of the scaled unknowns across and along at all nodes, in SI units; 0 at nodes without an unknown.
fn nodes(system: &System, v: &[f64], unknowns: impl Fn(&LineLayout) -> Option<&Range<usize>>) -> Vec<[f64; 2]> {
    let l = &system.layout;
    let mut all = vec![[0.0; 2]; system.mesh.nodes];
    for (axis, line) in l.lines.iter().enumerate() {
        let places = line.free.clone().zip(unknowns(line).cloned().unwrap_or_default());
        places.for_each(|(node, k)| all[node][axis] = v[k] * l.scales[k]);
    }
    all
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum()
}
