//! Kinematics, resultants and section forces of the beam.

use crate::case::schema::Effect;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::Kinematics;
use crate::numerics::Scalar;

/// `[E11]` Directors, stretch, tangent and curvature (A.1, A.2, A.19, A.20), curvature positive with the +x fibre in
/// tension:
///
/// ```text
/// d3 = (x', z')    λ = |d3|    e_t = d3/λ = (sin φ, cos φ)    κ = -φ'
/// κ_i = -(φ_{i+1/2} - φ_{i-1/2})/h    κ_0 = -(φ_{1/2} - φ_0)/(h/2)    κ_n = -(φ_n - φ_{n-1/2})/(h/2)
/// ```
///
/// Angles enter as differences only, from cross and dot products, so that any number of turns is fine.
pub fn kinematics<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    for c in 0..system.mesh.cells {
        let dx = (w.u1[c + 1] - w.u1[c]) * inverse;
        let e = (w.u3[c + 1] - w.u3[c]) * inverse;
        let dz = e + 1.0;
        let stretch = (dx.squared() + dz.squared()).sqrt();
        w.d3x[c] = dx;
        w.d3z[c] = dz;
        w.stretch[c] = stretch;
        w.strain[c] = (dx.squared() + e * (e + 2.0)) / (stretch + 1.0);
        let reciprocal = T::constant(1.0) / stretch;
        w.tx[c] = dx * reciprocal;
        w.tz[c] = dz * reciprocal;
    }
    let last = system.mesh.nodes - 1;
    for i in 1..last {
        let turn = turn((w.tx[i - 1], w.tz[i - 1]), (w.tx[i], w.tz[i]));
        w.kappa[i] = -turn * inverse;
    }
    if let Some(slope) = now.ends[0].slope {
        let given = direction(slope.value);
        w.kappa[0] = -turn(given, (w.tx[0], w.tz[0])) * (2.0 * inverse);
    }
    if let Some(slope) = now.ends[1].slope {
        let given = direction(slope.value);
        w.kappa[last] = -turn((w.tx[last - 1], w.tz[last - 1]), given) * (2.0 * inverse);
    }
}

/// Angle from one unit tangent to another.
#[inline]
fn turn<T: Scalar>(from: (T, T), to: (T, T)) -> T {
    (to.0 * from.1 - to.1 * from.0).atan2(to.1 * from.1 + to.0 * from.0)
}

fn direction<T: Scalar>(angle: f64) -> (T, T) {
    let (sine, cosine) = angle.sin_cos();
    (T::constant(sine), T::constant(cosine))
}

/// Rates of stretch, angle and curvature, where something depends on them: `λ_t = e_t·d3_t`, `φ_t = d1·d3_t/λ²`.
pub fn rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let turned = system.model.effects.has(Effect::RotaryInertia) && system.layout.waves[1];
    if !(turned || system.damped) {
        return;
    }
    strain_rates(system, now, w);
}

/// Rates of stretch, angle and curvature, always.
pub fn strain_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    for c in 0..system.mesh.cells {
        let dx_t = (w.v1[c + 1] - w.v1[c]) * inverse;
        let dz_t = (w.v3[c + 1] - w.v3[c]) * inverse;
        w.stretch_rate[c] = w.tx[c] * dx_t + w.tz[c] * dz_t;
        w.angle_rate[c] = (w.tz[c] * dx_t - w.tx[c] * dz_t) / w.stretch[c];
    }
    curvature_rates(system, now, w);
}

/// `κ_t` at nodes from the turning of cells and prescribed slopes.
pub fn curvature_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    let last = system.mesh.nodes - 1;
    for i in 1..last {
        w.kappa_rate[i] = (w.angle_rate[i - 1] - w.angle_rate[i]) * inverse;
    }
    if let Some(slope) = now.ends[0].slope {
        w.kappa_rate[0] = (-w.angle_rate[0] + slope.rate) * (2.0 * inverse);
    }
    if let Some(slope) = now.ends[1].slope {
        w.kappa_rate[last] = (w.angle_rate[last - 1] - slope.rate) * (2.0 * inverse);
    }
}

/// `[E12]` Normal force, moment and shear (A.31-A.33), elastic and viscous parts:
///
/// ```text
/// N = EA (λ - 1 - λ_p)      M = EI (α - α_p)      α = κ (conservative), λ κ (published)
/// V = -(M_total)'/λ         N_total = N + EA τ_a λ_t      M_total = M + EI τ_b κ_t
/// ```
///
/// At an end with given moment M is the value and the curvature follows.
pub fn normal_forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let ea = section.axial_stiffness;
    let pressed = system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch);
    let k = system.mesh.cells_per_segment;
    for c in 0..system.mesh.cells {
        let elastic = if pressed {
            w.strain[c] - w.pressure_stretch[c / k]
        } else {
            w.strain[c]
        };
        w.force[c] = elastic * ea;
    }
    if section.axial_damping_time > 0.0 {
        for c in 0..system.mesh.cells {
            w.viscous_force[c] = w.stretch_rate[c] * (ea * section.axial_damping_time);
        }
    }
}

/// Moments and the shear that follows from them, `[E12]`.
pub fn moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let ei = section.bending_stiffness;
    let published = system.model.published();
    let last = system.mesh.nodes - 1;
    for i in 0..=last {
        let pressure_curvature = pressure_curvature(system, w, i);
        let given = match i {
            0 if now.ends[0].slope.is_none() => Some(now.ends[0].moment.value),
            _ if i == last && now.ends[1].slope.is_none() => Some(now.ends[1].moment.value),
            _ => None,
        };
        let stretch = if published {
            node_stretch(w, i, last)
        } else {
            T::constant(1.0)
        };
        match given {
            Some(moment) => {
                w.moment[i] = T::constant(moment);
                let alpha = pressure_curvature + moment / ei;
                w.kappa[i] = if published { alpha / stretch } else { alpha };
            }
            None => {
                let alpha = if published { w.kappa[i] * stretch } else { w.kappa[i] };
                w.moment[i] = (alpha - pressure_curvature) * ei;
            }
        }
    }
    if section.bending_damping_time > 0.0 {
        let first = usize::from(now.ends[0].slope.is_none());
        let end = last + usize::from(now.ends[1].slope.is_some());
        for i in first..end {
            w.viscous_moment[i] = w.kappa_rate[i] * (ei * section.bending_damping_time);
        }
    }
}

/// Shear, `[E12]`.
pub fn shears<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    for c in 0..system.mesh.cells {
        w.shear[c] = total_moment_drop(system, w, c) * inverse / w.stretch[c];
    }
}

/// By how much the moment, viscous part included, falls over a cell [N m].
#[inline]
pub fn total_moment_drop<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    let drop = w.moment[c] - w.moment[c + 1];
    if system.model.section.bending_damping_time > 0.0 {
        drop + (w.viscous_moment[c] - w.viscous_moment[c + 1])
    } else {
        drop
    }
}

/// `N_total` of a cell [N].
#[inline]
pub fn normal_force<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    if system.model.section.axial_damping_time > 0.0 {
        w.force[c] + w.viscous_force[c]
    } else {
        w.force[c]
    }
}

/// Couple per length of distributed moments: `d3·m b1`, for small rotations `m b1_z + g φ m b1_x`, `[E26]`.
#[inline]
pub fn couple<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, c: usize) -> T {
    match system.model.kinematics {
        Kinematics::Bar => T::zero(),
        Kinematics::Linear => T::constant(now.moment_z[c]),
        Kinematics::SmallRotation => w.d3x[c] * now.moment_x[c] + now.moment_z[c],
        Kinematics::FiniteRotation => w.d3x[c] * now.moment_x[c] + w.d3z[c] * now.moment_z[c],
    }
}

/// `alpha_p` at a node: the mean of the segments on its two sides (the transpose of the mean moment's weights).
#[inline]
pub fn pressure_curvature<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> T {
    if system.fluid.is_none() || !system.model.effects.has(Effect::PressureToCurvature) {
        return T::zero();
    }
    let (left, right) = system.mesh.segments_of_node(node);
    if left == right {
        w.pressure_curvature[left]
    } else {
        (w.pressure_curvature[left] + w.pressure_curvature[right]) * 0.5
    }
}

/// `λ` at a node: mean of the neighbouring cells.
#[inline]
pub fn node_stretch<T: Scalar>(w: &Workspace<T>, node: usize, last: usize) -> T {
    if node == 0 {
        w.stretch[0]
    } else if node == last {
        w.stretch[last - 1]
    } else {
        (w.stretch[node - 1] + w.stretch[node]) * 0.5
    }
}

/// `[E13]` Section force in lab axes, rotary part included:
///
/// ```text
/// n = N_total e_t + V e_n + r d1         e_n = (-cos φ, sin φ),  d1 = λ (cos φ, -sin φ)
/// conservative   r = (d3·m b1 + m y11 φ_tt)/λ²
/// published      r = d3·m b1/λ² + m y11 (φ_tt + 2 λ_t φ_t/λ)     (A.5)
/// φ_tt = (d1·d3_tt/λ - 2 λ_t φ_t)/λ
/// ```
pub fn section_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    for c in 0..system.mesh.cells {
        let (tx, tz) = (w.tx[c], w.tz[c]);
        let normal = normal_force(system, w, c);
        w.sx[c] = normal * tx - w.shear[c] * tz;
        w.sz[c] = normal * tz + w.shear[c] * tx;
    }
    if system.has_moments {
        for c in 0..system.mesh.cells {
            let couple = couple(system, now, w, c);
            add_couple(couple, c, w);
        }
    }
    if system.model.effects.has(Effect::RotaryInertia) {
        let inertia = section.mass_per_length * section.gyration_radius_squared;
        let inverse = 1.0 / system.mesh.h;
        let published = system.model.published();
        if !system.layout.waves[1] {
            for c in 0..system.mesh.cells {
                let turned = (w.a1[c + 1] - w.a1[c]) * (inverse * inertia);
                w.sx[c] += turned;
            }
            return;
        }
        for c in 0..system.mesh.cells {
            let dx_tt = (w.a1[c + 1] - w.a1[c]) * inverse;
            let dz_tt = (w.a3[c + 1] - w.a3[c]) * inverse;
            let across = w.tz[c] * dx_tt - w.tx[c] * dz_tt;
            // λ φ_tt + 2 λ_t φ_t; the published term has it whole and without 1/λ².
            let couple = if published {
                across * w.stretch[c]
            } else {
                (across - w.stretch_rate[c] * w.angle_rate[c] * 2.0) / w.stretch[c]
            };
            let couple = couple * inertia;
            add_couple(couple, c, w);
        }
    }
}

/// Adds `r d1` with `r = couple/λ²` to the section force.
#[inline]
fn add_couple<T: Scalar>(couple: T, c: usize, w: &mut Workspace<T>) {
    let r = couple / w.stretch[c];
    w.sx[c] += r * w.tz[c];
    w.sz[c] -= r * w.tx[c];
}
