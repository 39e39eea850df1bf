//! Angle unwrapping: directions determine angles except for full turns, which are counted along the beam, and at its root from step to
//! step.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{System, TimeData, Workspace};
use crate::model::Kinematics;
use crate::numerics::Scalar;

/// Unwrapped angles of the last stored state [rad]; those of the next state are within half a turn of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AngleUnwrapping {
    /// Angle of the first cell.
    pub root: f64,
    /// Angle of the cell before each rotational spring, by attachment number; empty without such springs, and if sections have their own
    /// angles.
    pub attached: Vec<f64>,
}

impl AngleUnwrapping {
    /// Unwrapped angles of an evaluated state.
    pub fn new(system: &System, now: &TimeData, w: &Workspace<f64>) -> Self {
        let root = first_angle(system, now, w);
        let mut attached = vec![];
        if system.model.kinematics == Kinematics::FiniteRotation && w.shape.sections.angle.is_empty() {
            for (one, cell) in system.attached.iter().filter_map(|one| Some((one, one.turns_at()?))) {
                attached.resize(system.attached.len(), 0.0);
                attached[one.number] = root - rotation(system, w, cell);
            }
        }
        Self { root, attached }
    }
}

/// Returns `angle` plus the number of full turns for which it is nearest to `to` [rad].
#[inline]
pub fn nearest<T: Scalar>(angle: T, to: f64) -> T {
    angle.lift(|angle| (angle + TAU * ((to - angle) / TAU).round(), 1.0))
}

/// Angle `φ` of the first cell, or θ if sections shear. Unwrapped near the given slope of the root, otherwise near the last angle.
pub fn first_angle(system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
    if let Some(angle) = w.shape.sections.angle.first() {
        return *angle;
    }
    let direction = w.shape.tangent[0];
    match system.model.kinematics {
        Kinematics::Bar => direction.x.atan2(direction.z),
        Kinematics::FiniteRotation => {
            let near = now.ends[0].slope.map_or(now.turns.root, |slope| slope.value);
            nearest(direction.x.atan2(direction.z), near)
        }
        Kinematics::Linear | Kinematics::SmallRotation => w.shape.d3[0].x,
    }
}

/// Angle `φ` of the tip, unwrapped along the beam.
pub fn tip_angle(system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
    let last = system.mesh.nodes - 1;
    let beyond = system.mesh.node_lengths[last] * w.shape.kappa[last];
    first_angle(system, now, w) - (rotation(system, w, last - 1) + beyond)
}

/// Rotation from the first cell to another, `Σ h_i κ_i` over the nodes between them.
pub fn rotation(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    let lengths = &system.mesh.node_lengths[1..=cell];
    lengths
        .iter()
        .zip(&w.shape.kappa[1..=cell])
        .map(|(h, kappa)| h * kappa)
        .sum()
}
