//! Places of the nodes of a structure, for pictures and exports.

use std::ops::Range;

use super::FieldAxis;
use crate::discrete::System;
use crate::numerics::Planar;

/// Nodes of a structure: their beams, and their places in the straight structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlacedNodes {
    /// Beam of each node in `/beams`, from 0.
    pub beam: Vec<usize>,
    /// Material coordinate along the beam [m].
    pub theta: Vec<f64>,
    /// Position in the axes of the case [m].
    pub rest: Vec<Planar<f64>>,
    /// Angle from z towards x of the straight beam [rad].
    pub angle: Vec<f64>,
}

impl PlacedNodes {
    /// Nodes of a system; none for a single beam.
    pub fn new(system: &System) -> Option<Self> {
        system.model.structure.as_ref()?;
        Self::from_axes(|axis| Some(axis.values(system, 0.0)))
    }

    /// Nodes from recorded axes; none without those of a structure, or if their lengths differ.
    pub fn from_axes(mut read: impl FnMut(FieldAxis) -> Option<Vec<f64>>) -> Option<Self> {
        let beam = read(FieldAxis::BeamOfNode).filter(|beam| !beam.is_empty())?;
        let mut of = |axis: FieldAxis| read(axis).filter(|values| values.len() == beam.len());
        let [theta, x, z] = [of(FieldAxis::Nodes)?, of(FieldAxis::RestX)?, of(FieldAxis::RestZ)?];
        let angle = of(FieldAxis::RestAngle)?;
        Some(Self {
            beam: beam.iter().map(|number| (*number as usize).saturating_sub(1)).collect(),
            theta,
            rest: x.into_iter().zip(z).map(|(x, z)| Planar { x, z }).collect(),
            angle,
        })
    }

    /// Ranges of the nodes of each part: a beam, or a part of one between joints.
    pub fn parts(&self) -> Vec<Range<usize>> {
        let mut parts: Vec<Range<usize>> = vec![];
        for node in 0..self.beam.len() {
            let goes_on = node > 0 && self.beam[node] == self.beam[node - 1] && self.theta[node] > self.theta[node - 1];
            match parts.last_mut().filter(|_| goes_on) {
                Some(part) => part.end = node + 1,
                None => parts.push(node..node + 1),
            }
        }
        parts
    }

    /// Vector along the axes of the case, from its components along the axes of the beam of a node.
    pub fn turned(&self, node: usize, v: Planar<f64>) -> Planar<f64> {
        v.turned(Planar::tangent(self.angle[node]))
    }

    /// Position of a node with these displacements along the axes of its beam [m].
    pub fn position(&self, node: usize, u: Planar<f64>) -> Planar<f64> {
        self.rest[node] + self.turned(node, u)
    }

    /// Line `(z, x)` through all nodes with these displacements, broken between parts.
    pub fn line(&self, u1: &[f64], u3: &[f64]) -> Vec<(f64, f64)> {
        let mut line = vec![];
        for part in self.parts() {
            let own = part.map(|node| {
                let at = self.position(
                    node,
                    Planar {
                        x: u1[node],
                        z: u3[node],
                    },
                );
                (at.z, at.x)
            });
            line.extend(own);
            line.push((f64::NAN, f64::NAN));
        }
        line
    }

    /// Size of the straight structure: the largest distance of a node from the first one [m].
    pub fn size(&self) -> f64 {
        let from = self.rest.first().copied().unwrap_or_default();
        let distances = self.rest.iter().map(|at| (*at - from).squared().sqrt());
        distances.fold(0.0, f64::max)
    }
}
