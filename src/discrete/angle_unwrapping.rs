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
    /// Angles of the first cells of the further beams of a structure.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further: Vec<f64>,
    /// Angle of the cell before each rotational spring, by attachment number; empty without such springs, and if sections have their own
    /// angles.
    pub attached: Vec<f64>,
}

impl AngleUnwrapping {
    /// Unwrapped angles of an evaluated state.
    pub fn new(system: &System, now: &TimeData, w: &Workspace<f64>) -> Self {
        let root = first_angle(system, now, w, 0);
        let further = (1..system.mesh.beams.len())
            .map(|beam| first_angle(system, now, w, beam))
            .collect();
        let mut attached = vec![];
        if system.model.kinematics == Kinematics::FiniteRotation && w.shape.sections.angle.is_empty() {
            for (one, cell) in system.attached.iter().filter_map(|one| Some((one, one.turns_at()?))) {
                attached.resize(system.attached.len(), 0.0);
                let beam = system.mesh.beam_of_node(cell);
                attached[one.number] = first_angle(system, now, w, beam) - rotation(system, w, cell);
            }
        }
        Self {
            root,
            further,
            attached,
        }
    }
}

/// Returns `angle` plus the number of full turns for which it is nearest to `to` [rad].
#[inline]
pub fn nearest<T: Scalar>(angle: T, to: f64) -> T {
    angle.lift(|angle| (angle + TAU * ((to - angle) / TAU).round(), 1.0))
}

/// Angle `φ` of the first cell of a beam, or θ if sections shear. Unwrapped near the given slope of the root, otherwise near the last angle.
pub fn first_angle(system: &System, now: &TimeData, w: &Workspace<f64>, beam: usize) -> f64 {
    let first = system.mesh.beams[beam].cells.start;
    if let Some(angle) = w.shape.sections.angle.get(first) {
        return *angle;
    }
    let direction = w.shape.tangent[first];
    match system.model.kinematics {
        Kinematics::Bar => direction.x.atan2(direction.z),
        Kinematics::FiniteRotation => {
            let turned = match beam.checked_sub(1) {
                None => now.turns.root,
                Some(further) => now.turns.further.get(further).copied().unwrap_or(0.0),
            };
            let near = now.ends[2 * beam].slope.map_or(turned, |slope| slope.value);
            nearest(direction.x.atan2(direction.z), near)
        }
        Kinematics::Linear | Kinematics::SmallRotation => w.shape.d3[first].x,
    }
}

/// Angle `φ` of the tip of a beam, unwrapped along the beam.
pub fn tip_angle(system: &System, now: &TimeData, w: &Workspace<f64>, beam: usize) -> f64 {
    let tip = system.mesh.beams[beam].ends()[1];
    let beyond = system.mesh.node_lengths[tip.node] * w.shape.kappa[tip.node];
    first_angle(system, now, w, beam) - (rotation(system, w, tip.cell) + beyond)
}

/// Rotation from the first cell of its beam to another, `Σ h_i κ_i` over the nodes between them.
pub fn rotation(system: &System, w: &Workspace<f64>, cell: usize) -> f64 {
    let between = system.mesh.beams[system.mesh.beam_of_node(cell)].cells.start + 1..cell + 1;
    let lengths = &system.mesh.node_lengths[between.clone()];
    lengths
        .iter()
        .zip(&w.shape.kappa[between])
        .map(|(h, kappa)| h * kappa)
        .sum()
}
