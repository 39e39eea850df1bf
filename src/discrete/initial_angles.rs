//! Initial angles of sections that shear: their moments balance in the given shape of the beam.

use super::angle_unwrapping::nearest;
use super::residual::bending::relative_stiffness;
use super::{System, TimeData, Workspace, residual};
use crate::case::Rotation;
use crate::model::Kinematics;

/// Maximum number of corrections; the contraction rate is the ratio of normal forces to kGA.
const CORRECTIONS: usize = 40;
/// Growth of the corrections that ends the iteration.
const GROWN: f64 = 10.0;
/// Convergence limit of the corrections [rad].
const NOTHING: f64 = 1e-15;

/// Sets the unknowns `y` (SI) to sections perpendicular to the beam's line: unwrapped angles, starting at the slope of the root, and
/// their rates.
pub fn across(system: &System, now: &TimeData, y: &mut [f64], w: &mut Workspace<f64>) {
    let own = &system.layout.turning;
    if own.angle.is_empty() {
        return;
    }
    residual::evaluate(system, now, y, &vec![0.0; y.len()], w);
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    let mut before = now.ends[0].slope.map_or(0.0, |slope| slope.value);
    for (c, (angle, rate)) in own.unknowns().enumerate() {
        let d3 = w.shape.d3[c];
        let d3_t = (w.motion.v[c + 1] - w.motion.v[c]) * system.mesh.per_length[c];
        let (line, turning) = if finite {
            (nearest(d3.x.atan2(d3.z), before), d3.cross(d3_t) / d3.squared())
        } else {
            (d3.x, d3_t.x)
        };
        before = line;
        y[angle] = line;
        if let Some(rate) = rate {
            y[rate] = turning;
        }
    }
}

/// Rotates sections until their moments balance at rest, so that the start does not excite vibrations of sections alone. Where the
/// corrections grow, because normal forces exceed kGA, sections remain perpendicular to the beam's line.
pub fn balance(system: &System, now: &TimeData, y: &mut [f64], w: &mut Workspace<f64>) {
    let own = &system.layout.turning;
    if own.angle.is_empty() {
        return;
    }
    let mut at_rest = y.to_vec();
    for velocity in system.layout.velocities() {
        at_rest[velocity] = 0.0;
    }
    let rates = vec![0.0; y.len()];
    let mut least = f64::INFINITY;
    for _ in 0..CORRECTIONS {
        residual::evaluate(system, now, &at_rest, &rates, w);
        let corrections = corrections(system, now, w);
        let largest = corrections.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
        for (unknown, correction) in own.angle.clone().zip(corrections) {
            at_rest[unknown] += correction;
        }
        if largest.is_nan() || largest > GROWN * least {
            return;
        }
        if largest < NOTHING {
            break;
        }
        least = least.min(largest);
    }
    y[own.angle.clone()].copy_from_slice(&at_rest[own.angle.clone()]);
}

/// Angles by which moments [N m] rotate the sections of a fixed beam line, for small strains: solves
/// `h kGA δ_c + EI/h (2 δ_c - δ_{c-1} - δ_{c+1})` by Thomas' algorithm. On a fourth-order mesh, whose short waves are up to 5/3 as stiff,
/// stiffnesses are increased by 4/3.
fn corrections(system: &System, now: &TimeData, w: &Workspace<f64>) -> Vec<f64> {
    let moments = &w.forces.turning;
    let (sections, mesh) = (&system.sections, &system.mesh);
    let stiffer = if system.mesh.fourth { 4.0 / 3.0 } else { 1.0 };
    let bends = |node: usize| {
        let bending = relative_stiffness(system, now, w, node) * sections.bending[node];
        stiffer * bending * mesh.per_node_length[node]
    };
    let mut above = Vec::with_capacity(moments.len());
    let mut values: Vec<f64> = Vec::with_capacity(moments.len());
    for (c, moment) in moments.iter().enumerate() {
        let last = c + 1 == moments.len();
        // a given slope constrains the end's half cell, a given moment does not
        let beside = |end: usize, node: usize| match system.model.ends[end].rotation {
            Rotation::Slope(_) => bends(node),
            Rotation::Moment(_) => 0.0,
        };
        let left = if c == 0 { beside(0, 0) } else { bends(c) };
        let right = if last { beside(1, c + 1) } else { bends(c + 1) };
        let (before, coupled) = match (values.last(), above.last()) {
            (Some(value), Some(above)) => (left * value, left * above),
            _ => (0.0, 0.0),
        };
        let pivot = stiffer * mesh.lengths[c] * sections.shear[c] + left + right - coupled;
        values.push((moment + before) / pivot);
        above.push(if last { 0.0 } else { right / pivot });
    }
    for c in (0..moments.len().saturating_sub(1)).rev() {
        values[c] += above[c] * values[c + 1];
    }
    values
}
