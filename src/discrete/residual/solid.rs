//! Kinematics, resultants and section forces of the beam.

use super::{relaxation, sheared};
use crate::case::schema::Effect;
use crate::discrete::workspace::Shape;
use crate::discrete::{System, TimeData, Workspace, attached, bodies};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar};

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
    let (u, shape) = (&w.motion.u, &mut w.shape);
    for c in 0..system.mesh.cells {
        let e = line(u, c, inverse, shape);
        shape.strain[c] = (e.x.squared() + e.z * (e.z + 2.0)) / (shape.stretch[c] + 1.0);
    }
    let last = system.mesh.nodes - 1;
    let tangent = &shape.tangent;
    for i in 1..last {
        shape.kappa[i] = -tangent[i - 1].angle_to(tangent[i]) * inverse;
    }
    if let Some(slope) = now.ends[0].slope {
        let given = Planar::constant(Planar::tangent(slope.value));
        shape.kappa[0] = -given.angle_to(tangent[0]) * (2.0 * inverse);
    }
    if let Some(slope) = now.ends[1].slope {
        let given = Planar::constant(Planar::tangent(slope.value));
        shape.kappa[last] = -tangent[last - 1].angle_to(given) * (2.0 * inverse);
    }
}

/// Director, length and tangent of a cell's line; `u'`, by which the director differs from that at rest.
#[inline(always)]
pub fn line<T: Scalar>(u: &[Planar<T>], c: usize, inverse: f64, shape: &mut Shape<T>) -> Planar<T> {
    let e = (u[c + 1] - u[c]) * inverse;
    let d3 = Planar::new(e.x, e.z + 1.0);
    let stretch = d3.squared().sqrt();
    shape.d3[c] = d3;
    shape.stretch[c] = stretch;
    shape.tangent[c] = d3.times(T::constant(1.0) / stretch);
    e
}

/// Rates of stretch, angle and curvature, where something depends on them: `λ_t = e_t·d3_t`, `φ_t = d1·d3_t/λ²`.
pub fn rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let turned = system.turns_with_its_line() && system.layout.lines[1].v.is_some();
    if !(turned || system.damped) {
        return;
    }
    strain_rates(system, now, w);
}

/// Rates of stretch, angle and curvature, always.
pub fn strain_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if system.model.effects.has(Effect::Shear) {
        sheared::strain_rates(system, w);
    } else {
        for c in 0..system.mesh.cells {
            w.shape.stretch_rate[c] = w.shape.tangent[c].dot(director_rate(system, w, c));
            w.shape.angle_rate[c] = angle_rate(system, w, c);
        }
    }
    curvature_rates(system, now, w);
}

/// `d3_t` of a cell [1/s].
fn director_rate<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> Planar<T> {
    (w.motion.v[c + 1] - w.motion.v[c]) * (1.0 / system.mesh.h)
}

/// `φ_t` of a cell's line [1/s].
pub fn angle_rate<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    w.shape.tangent[c].cross(director_rate(system, w, c)) / w.shape.stretch[c]
}

/// `κ_t` at nodes from the turning of cells and prescribed slopes.
pub fn curvature_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    let last = system.mesh.nodes - 1;
    for i in 1..last {
        w.shape.kappa_rate[i] = (w.shape.angle_rate[i - 1] - w.shape.angle_rate[i]) * inverse;
    }
    if let Some(slope) = now.ends[0].slope {
        w.shape.kappa_rate[0] = (-w.shape.angle_rate[0] + slope.rate) * (2.0 * inverse);
    }
    if let Some(slope) = now.ends[1].slope {
        w.shape.kappa_rate[last] = (w.shape.angle_rate[last - 1] - slope.rate) * (2.0 * inverse);
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
            w.shape.strain[c] - w.coupling.pressure_stretch[c / k]
        } else {
            w.shape.strain[c]
        };
        w.forces.normal[c] = elastic * ea;
    }
    if section.axial_damping_time > 0.0 {
        for c in 0..system.mesh.cells {
            w.forces.viscous_normal[c] = w.shape.stretch_rate[c] * (ea * section.axial_damping_time);
        }
    }
}

/// Moments and the shear that follows from them, `[E12]`.
///
/// `[E59]` A beam that is curved at rest, by κ_0 (loads of the kind `rest_curvature_1_m`), with the weights of forces, [E46]:
///
/// ```text
/// M = EI (α - α_p - κ_0)      EI τ_b (κ - κ_0)_t      P_loads gains -Σ h_i M_total κ_0,t
/// ```
pub fn moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let ei = section.bending_stiffness;
    let published = system.model.published();
    let last = system.mesh.nodes - 1;
    for i in 0..=last {
        let mut free_curvature = pressure_curvature(system, w, i);
        if let Some(rest) = now.rest_curvature[0].get(i) {
            free_curvature += T::constant(*rest);
        }
        let turns = now.end(i).filter(|end| end.slope.is_none());
        let given = turns.map(|end| end.moment.value);
        let stretch = if published {
            node_stretch(w, i, last)
        } else {
            T::constant(1.0)
        };
        match given {
            Some(moment) => {
                let mut elastic = T::constant(moment);
                if let Some(nonlinear) = w.forces.nonlinear_moment.get(i) {
                    elastic -= *nonlinear;
                }
                w.forces.moment[i] = elastic;
                let alpha = free_curvature + elastic / T::constant(ei);
                if w.relaxed.curvature.is_empty() {
                    w.shape.kappa[i] = if published { alpha / stretch } else { alpha };
                } else {
                    w.shape.kappa[i] = relaxation::curvature(system, now, w, i, alpha, stretch);
                    w.forces.moment[i] = (w.shape.kappa[i] * stretch - free_curvature) * ei;
                }
            }
            None => {
                let alpha = if published {
                    w.shape.kappa[i] * stretch
                } else {
                    w.shape.kappa[i]
                };
                w.forces.moment[i] = (alpha - free_curvature) * ei;
            }
        }
    }
    relaxation::moments(system, now, w);
    if section.bending_damping_time > 0.0 {
        let first = usize::from(now.ends[0].slope.is_none());
        let end = last + usize::from(now.ends[1].slope.is_some());
        for i in first..end {
            let mut rate = w.shape.kappa_rate[i];
            if let Some(rest) = now.rest_curvature[1].get(i) {
                rate -= T::constant(*rest);
            }
            w.forces.viscous_moment[i] = rate * (ei * section.bending_damping_time);
        }
    }
}

/// Shear, `[E12]`.
pub fn shears<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let inverse = 1.0 / system.mesh.h;
    for c in 0..system.mesh.cells {
        w.forces.shear[c] = total_moment_drop(system, w, c) * inverse / w.shape.stretch[c];
    }
}

/// By how much the moment, viscous part included, falls over a cell [N m].
#[inline]
pub fn total_moment_drop<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    let mut drop = w.forces.moment[c] - w.forces.moment[c + 1];
    if let [left, right, ..] = w.forces.nonlinear_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if let [left, right, ..] = w.forces.relaxing_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if system.model.section.bending_damping_time > 0.0 {
        drop + (w.forces.viscous_moment[c] - w.forces.viscous_moment[c + 1])
    } else {
        drop
    }
}

/// `N_total` of a cell [N].
#[inline]
pub fn normal_force<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    let mut force = w.forces.normal[c];
    if let Some(nonlinear) = w.forces.nonlinear_normal.get(c) {
        force += *nonlinear;
    }
    if let Some(relaxing) = w.forces.relaxing_normal.get(c) {
        force += *relaxing;
    }
    if system.model.section.axial_damping_time > 0.0 {
        force += w.forces.viscous_normal[c];
    }
    force
}

/// Couple per length of distributed moments: `d3·m b1`, for small rotations `m b1_z + g φ m b1_x`, `[E26]`.
#[inline]
pub fn couple<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, c: usize) -> T {
    match system.model.kinematics {
        Kinematics::Bar => T::zero(),
        Kinematics::Linear => T::constant(now.moment[c].z),
        Kinematics::SmallRotation => w.shape.d3[c].x * now.moment[c].x + now.moment[c].z,
        Kinematics::FiniteRotation => w.shape.d3[c].x * now.moment[c].x + w.shape.d3[c].z * now.moment[c].z,
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
        w.coupling.pressure_curvature[left]
    } else {
        (w.coupling.pressure_curvature[left] + w.coupling.pressure_curvature[right]) * 0.5
    }
}

/// `λ` at a node: mean of the neighbouring cells.
#[inline]
pub fn node_stretch<T: Scalar>(w: &Workspace<T>, node: usize, last: usize) -> T {
    if node == 0 {
        w.shape.stretch[0]
    } else if node == last {
        w.shape.stretch[last - 1]
    } else {
        (w.shape.stretch[node - 1] + w.shape.stretch[node]) * 0.5
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
        let tangent = w.shape.tangent[c];
        let normal = normal_force(system, w, c);
        w.forces.section[c] = tangent.times(normal) + tangent.normal().times(w.forces.shear[c]);
    }
    if system.has_moments {
        for c in 0..system.mesh.cells {
            let couple = couple(system, now, w, c);
            add_couple(couple, c, w);
        }
    }
    attached::turning(system, w, add_couple);
    bodies::turning(system, now, w, add_couple);
    if system.model.effects.has(Effect::RotaryInertia) {
        let inertia = section.mass_per_length * section.gyration_radius_squared;
        let inverse = 1.0 / system.mesh.h;
        let published = system.model.published();
        let a = &w.motion.a;
        if system.layout.lines[1].v.is_none() {
            for c in 0..system.mesh.cells {
                w.forces.section[c].x += (a[c + 1].x - a[c].x) * (inverse * inertia);
            }
            return;
        }
        for c in 0..system.mesh.cells {
            let d3_tt = (w.motion.a[c + 1] - w.motion.a[c]) * inverse;
            let across = w.shape.tangent[c].cross(d3_tt);
            // λ φ_tt + 2 λ_t φ_t; the published term has it whole and without 1/λ².
            let couple = if published {
                across * w.shape.stretch[c]
            } else {
                (across - w.shape.stretch_rate[c] * w.shape.angle_rate[c] * 2.0) / w.shape.stretch[c]
            };
            add_couple(couple * inertia, c, w);
        }
    }
}

/// Adds `r d1` with `r = couple/λ²` to the section force.
#[inline]
fn add_couple<T: Scalar>(couple: T, c: usize, w: &mut Workspace<T>) {
    let r = couple / w.shape.stretch[c];
    w.forces.section[c] -= w.shape.tangent[c].normal().times(r);
}
