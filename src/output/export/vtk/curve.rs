//! Reference curve at an instant: position and slope of each section.

use std::f64::consts::{PI, TAU};

use crate::numerics::Planar;

/// A cross-section: position of its center (x, z) [m] and slope angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SectionPosition {
    /// Material coordinate [m].
    pub theta: f64,
    /// Transverse position [m].
    pub x: f64,
    /// Axial position [m].
    pub z: f64,
    /// Slope angle `phi` [rad].
    pub angle: f64,
}

impl SectionPosition {
    /// A point of the section in VTK's axes: `height` towards +x, `across` along the width [m].
    pub fn point(&self, height: f64, across: f64) -> [f64; 3] {
        let (sin, cos) = self.angle.sin_cos();
        [self.z - height * sin, self.x + height * cos, across]
    }
}

/// Sections at the nodes, root to tip.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    nodes: Vec<SectionPosition>,
}

impl Curve {
    /// Computes the curve from displacements [m], curvature [1/m] at the nodes, and section angles of cells with shear (`sections`, else
    /// empty). The angle of an inner node is the mean over its two cells. At an end it follows from the curvature there, `kappa = -phi'`.
    pub fn new(theta: &[f64], u1: &[f64], u3: &[f64], curvature: &[f64], sections: &[f64]) -> Self {
        let mut nodes: Vec<SectionPosition> = theta
            .iter()
            .zip(u1.iter().zip(u3))
            .map(|(&theta, (&u1, &u3))| SectionPosition {
                theta,
                x: u1,
                z: theta + u3,
                angle: 0.0,
            })
            .collect();
        let mut cells: Vec<f64> = sections.to_vec();
        for pair in nodes.windows(2).skip(cells.len()) {
            let direction = (pair[1].x - pair[0].x).atan2(pair[1].z - pair[0].z);
            // Unwrapped beyond full turns: a strip may be rolled up.
            let turned = |last: f64| last + (direction - last + PI).rem_euclid(TAU) - PI;
            cells.push(cells.last().map_or(direction, |&last| turned(last)));
        }
        let Some(last) = cells.len().checked_sub(1) else {
            return Self { nodes };
        };
        let half = |k: usize| 0.5 * (theta[k + 1] - theta[k]);
        for (k, node) in nodes.iter_mut().enumerate() {
            node.angle = match k {
                0 => cells[0] + curvature[0] * half(0),
                k if k > last => cells[last] - curvature[k] * half(last),
                k => 0.5 * (cells[k - 1] + cells[k]),
            };
        }
        Self { nodes }
    }

    /// The curve in the axes of the case, of a beam with its root at `origin` and an angle from z towards x [rad].
    pub fn placed(mut self, origin: Planar<f64>, angle: f64) -> Self {
        let direction = Planar::tangent(angle);
        for node in &mut self.nodes {
            let at = origin + Planar::new(node.x, node.z).turned(direction);
            (node.x, node.z) = (at.x, at.z);
            node.angle += angle;
        }
        self
    }

    /// Sections at material coordinates [m], linear between nodes.
    pub fn sections(&self, theta: &[f64]) -> Vec<SectionPosition> {
        theta.iter().map(|&t| self.at(t)).collect()
    }

    /// Section at a material coordinate [m].
    pub fn at(&self, theta: f64) -> SectionPosition {
        let mix = |f: fn(&SectionPosition) -> f64| {
            let values: Vec<f64> = self.nodes.iter().map(f).collect();
            self.interpolate(theta, &values)
        };
        SectionPosition {
            theta,
            x: mix(|s| s.x),
            z: mix(|s| s.z),
            angle: mix(|s| s.angle),
        }
    }

    /// Interpolates a field of the nodes at a material coordinate; exact at a node.
    pub fn interpolate(&self, theta: f64, field: &[f64]) -> f64 {
        let next = self.nodes.partition_point(|s| s.theta < theta).min(field.len() - 1);
        let (k, n) = (next.saturating_sub(1), next);
        let (a, b) = (self.nodes[k].theta, self.nodes[n].theta);
        if theta >= b || a == b {
            return field[n];
        }
        field[k] + (field[n] - field[k]) * (theta - a) / (b - a)
    }

    /// Cell that contains the midpoint of two coordinates.
    pub fn cell(&self, from: f64, to: f64) -> usize {
        let middle = 0.5 * (from + to);
        let next = self.nodes.partition_point(|s| s.theta < middle);
        next.clamp(1, self.nodes.len() - 1) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::Curve;

    /// Goal: sections with shear keep their given angles; others are perpendicular to the line.
    #[test]
    fn sections_that_shear_keep_their_angles() {
        let (theta, rises, still) = ([0.0, 1.0, 2.0], [0.0, 0.1, 0.2], [0.0; 3]);
        let angles = |sections: &[f64]| -> Vec<f64> {
            let curve = Curve::new(&theta, &rises, &still, &still, sections);
            curve.nodes.iter().map(|section| section.angle).collect()
        };
        assert_eq!(angles(&[0.0, 0.0]), [0.0; 3]);
        assert!(angles(&[]).iter().all(|angle| (angle - 0.1_f64.atan()).abs() < 1e-15));
    }
}
