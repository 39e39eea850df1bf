//! Beam with small rotations: von Karman's and the linear one.

use super::bending::total_moment_drop;
use super::solid::{self, couple, curvature_rates, normal_force};
use super::{fourth_order, timoshenko};
use crate::case::Translation;
use crate::case::schema::Effect;
use crate::discrete::{System, TimeData, Workspace, attached, bodies};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar};

/// `[E26]` Small rotations, g = 1; without axial force on bending (the linear beam) g = 0:
///
/// ```text
/// e = u3' + g u1'²/2    φ = u1'    κ = -φ'    N = EA (e - λ_p)    M = EI (κ - α_p)    V = -M'
/// n_x = g N φ - V + r    n_z = N    r = m b1_z + g φ m b1_x + m y11 φ_tt
/// ```
///
/// from the potential ∫ (N²/2EA + M²/2EI): `N δe + M δκ = (g N φ - V) δu1' + N δu3' - (M δφ)'`. Compared with finite
/// rotations it omits terms of order φ².
pub fn kinematics<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let tension = system.model.kinematics == Kinematics::SmallRotation;
    let stretches = system.model.effects.has(Effect::AxialStretch);
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        let angle = (w.motion.u[c + 1].x - w.motion.u[c].x) * inverse;
        w.shape.d3[c].x = angle;
        if !stretches {
            continue;
        }
        let mut e = (w.motion.u[c + 1].z - w.motion.u[c].z) * inverse;
        if tension {
            e += angle.squared() * 0.5;
        }
        w.shape.strain[c] = e;
        w.shape.stretch[c] = e + 1.0;
    }
    if system.layout.turning.angle.is_empty() {
        curvatures(system, now, w);
    }
}

/// Curvature `κ` at nodes, from the angles of cells and prescribed slopes.
fn curvatures<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = &system.mesh.per_node_length;
    let last = system.mesh.nodes - 1;
    let turning = w.shape.d3.windows(2).zip(&inverse[1..]);
    for (kappa, (pair, inverse)) in w.shape.kappa[1..last].iter_mut().zip(turning) {
        *kappa = (pair[0].x - pair[1].x) * *inverse;
    }
    if let Some(slope) = now.ends[0].slope {
        w.shape.kappa[0] = (-w.shape.d3[0].x + slope.value) * inverse[0];
    }
    if let Some(slope) = now.ends[1].slope {
        w.shape.kappa[last] = (w.shape.d3[last - 1].x + -slope.value) * inverse[last];
    }
}

/// Rates of strain, if damping depends on them.
pub fn rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if system.damped {
        strain_rates(system, now, w);
    }
}

/// Rates of strain in any case: `e_t = u3'_t + g φ φ_t`, `φ_t = u1'_t`.
pub fn strain_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let tension = system.model.kinematics == Kinematics::SmallRotation;
    let sheared = system.model.effects.has(Effect::Shear);
    if sheared {
        timoshenko::strain_rates(system, w);
    }
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        let turning = (w.motion.v[c + 1].x - w.motion.v[c].x) * inverse;
        if !sheared {
            w.shape.angle_rate[c] = turning;
        }
        w.shape.stretch_rate[c] = (w.motion.v[c + 1].z - w.motion.v[c].z) * inverse;
        if tension {
            w.shape.stretch_rate[c] += w.shape.d3[c].x * turning;
        }
    }
    curvature_rates(system, now, w);
}

/// Normal forces: elastic, or for an inextensible beam those of statics, `[E28]`.
pub fn normal_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if system.model.effects.has(Effect::AxialStretch) {
        solid::normal_forces(system, now, w);
        return;
    }
    for (force, &given) in w.forces.normal.iter_mut().zip(&now.statics.force) {
        *force = T::constant(given);
    }
}

/// Axial displacement and velocity of an inextensible beam, from the held end, `[E28]`, with the rates of stretch by pressure of each
/// segment.
pub fn foreshorten(
    system: &System,
    now: &TimeData,
    stretch_rate: impl Fn(&Workspace<f64>, usize) -> f64,
    w: &mut Workspace<f64>,
) {
    let (k, last) = (system.mesh.cells_per_segment, system.mesh.cells);
    let tension = system.model.kinematics == Kinematics::SmallRotation;
    let root_held = matches!(system.model.ends[0].axial, Translation::Displacement(_));
    let pressed = system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch);
    let held = if root_held { 0 } else { last };
    let (mut u, mut v) = (w.motion.u[held].z, w.motion.v[held].z);
    for step in 0..last {
        let (cell, node, outward) = if root_held {
            (step, step + 1, 1.0)
        } else {
            (last - 1 - step, last - 1 - step, -1.0)
        };
        let h = system.mesh.lengths[cell];
        if pressed {
            u += outward * h * w.coupling.pressure_stretch[cell / k];
            v += outward * h * stretch_rate(w, cell / k);
        }
        if tension {
            u -= outward * h * 0.5 * w.shape.d3[cell].x * w.shape.d3[cell].x;
            v -= outward * w.shape.d3[cell].x * (w.motion.v[cell + 1].x - w.motion.v[cell].x);
        }
        if fourth_order::bends_its_cells(system) {
            let [longer, rate] = fourth_order::small_arc(system, now, w, cell);
            u -= outward * h * longer;
            v -= outward * h * rate;
        }
        (w.motion.u[node].z, w.motion.v[node].z) = (u, v);
    }
}

/// Section forces in lab axes.
pub fn section_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let tension = system.model.kinematics == Kinematics::SmallRotation;
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        let normal = normal_force(system, w, c);
        w.forces.shear[c] = total_moment_drop(system, w, c) * inverse;
        let across = if tension {
            normal * w.shape.d3[c].x - w.forces.shear[c]
        } else {
            -w.forces.shear[c]
        };
        w.forces.section[c] = Planar::new(across, normal);
        if system.has_moments {
            let turning = couple(system, now, w, c);
            w.forces.section[c].x += turning;
        }
        if system.model.effects.has(Effect::RotaryInertia) {
            w.forces.section[c].x += (w.motion.a[c + 1].x - w.motion.a[c].x) * (inverse * system.sections.rotary[c]);
        }
    }
    attached::turning(system, now, w, |couple, c, w| w.forces.section[c].x += couple);
    bodies::turning(system, now, w, |couple, c, w| w.forces.section[c].x += couple);
}
