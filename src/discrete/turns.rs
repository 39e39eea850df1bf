//! How far a beam has turned: directions tell angles but for full turns, which are counted along the beam, and at its root from step to step.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::{System, TimeData, Workspace};
use crate::model::Kinematics;
use crate::numerics::Scalar;

/// Angles of the last state that was kept [rad], full turns counted: those of a state that follows are within half a turn of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Turns {
    /// Of the first cell.
    pub root: f64,
    /// Of the cell before each rotational spring, by the number of its attachment; empty where there is none, or sections have angles of their own.
    pub attached: Vec<f64>,
}

impl Turns {
    /// Of a state that is evaluated.
    pub fn of(system: &System, now: &TimeData, w: &Workspace<f64>) -> Self {
        let root = first_angle(system, now, w);
        let mut attached = vec![];
        if system.model.kinematics == Kinematics::FiniteRotation && w.shape.sections.angle.is_empty() {
            for (one, cell) in system.attached.iter().filter_map(|one| Some((one, one.turns_at()?))) {
                attached.resize(system.attached.len(), 0.0);
                attached[one.number] = root - system.mesh.h * w.shape.kappa[1..=cell].iter().sum::<f64>();
            }
        }
        Self { root, attached }
    }
}

/// That of the angles which differ from one by full turns that is nearest to another [rad].
#[inline]
pub fn nearest<T: Scalar>(angle: T, to: f64) -> T {
    angle.lift(|angle| (angle + TAU * ((to - angle) / TAU).round(), 1.0))
}

/// `φ` of the first cell, of sections that shear θ: near the slope of the root where that is given, else near what it was.
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

/// `φ` of the tip, followed along the beam.
pub fn tip_angle(system: &System, now: &TimeData, w: &Workspace<f64>) -> f64 {
    let last = system.mesh.nodes - 1;
    let interior: f64 = w.shape.kappa[1..last].iter().sum();
    first_angle(system, now, w) - system.mesh.h * (interior + 0.5 * w.shape.kappa[last])
}
