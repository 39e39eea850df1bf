//! Kinematics, resultants and section forces of the beam.

use super::{eccentric, fourth_order, timoshenko};
use crate::case::schema::Effect;
use crate::discrete::time_data::EndData;
use crate::discrete::workspace::{BeamShape, Sections};
use crate::discrete::{BeamMesh, System, TimeData, Workspace, attached, bodies};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar, wide};

/// `[E11]` Directors, stretch, tangent and curvature (A.1, A.2, A.19, A.20), curvature positive with the +x fibre in
/// tension:
///
/// ```text
/// d3 = (x', z')    λ = |d3|    e_t = d3/λ = (sin φ, cos φ)    κ = -φ'
/// κ_i = -(φ_{i+1/2} - φ_{i-1/2})/h    κ_0 = -(φ_{1/2} - φ_0)/(h/2)    κ_n = -(φ_n - φ_{n-1/2})/(h/2)
/// ```
///
/// Only differences of angles appear, from cross and dot products, so that any number of full turns is admissible.
pub fn kinematics<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = &system.mesh.per_node_length;
    let last = system.mesh.cells;
    let shape = &mut w.shape;
    let strain = |_, _: &mut Sections<T>, e: Planar<T>, line: &CellLine<T>| {
        (e.x.squared() + e.z * (e.z + 2.0)) / (line.stretch + 1.0)
    };
    wide!(lines(system, &w.motion.u, shape, strain));
    let (tangent, kappa) = (&shape.tangent[..last], &mut shape.kappa);
    wide!(curvatures(tangent, &inverse[1..last], &mut kappa[1..last]));
    let joint_angle = &shape.joints.angle;
    for (k, end) in system.mesh.ends() {
        let Some([angle, _]) = angle_of_end(&now.ends[k], joint_angle, &[]) else {
            continue;
        };
        let angle = Planar::tangent(angle);
        shape.kappa[end.node] = tangent[end.cell].angle_to(angle) * (-end.outward * inverse[end.node]);
    }
}

/// Angle of an end and its rate, if they are given or those of a joint; without rates of joints, 0.
#[inline]
pub fn angle_of_end<T: Scalar>(end: &EndData, angle: &[T], rate: &[T]) -> Option<[T; 2]> {
    if let Some(joint) = end.joint {
        return Some([angle[joint], rate.get(joint).copied().unwrap_or(T::zero())]);
    }
    end.slope
        .map(|slope| [T::constant(slope.value), T::constant(slope.rate)])
}

/// Curvature `κ` between cells.
#[inline(always)]
fn curvatures<T: Scalar>(tangent: &[Planar<T>], inverse: &[f64], kappa: &mut [T]) {
    for ((kappa, pair), inverse) in kappa.iter_mut().zip(tangent.windows(2)).zip(inverse) {
        *kappa = -pair[0].angle_to(pair[1]) * *inverse;
    }
}

/// Directors, lengths and tangents of the lines of cells. `strain` computes the strain of each cell from the change `u'` of its director,
/// and sets its section.
#[inline(always)]
pub fn lines<T: Scalar>(
    system: &System,
    u: &[Planar<T>],
    shape: &mut BeamShape<T>,
    mut strain: impl FnMut(usize, &mut Sections<T>, Planar<T>, &CellLine<T>) -> T,
) {
    let cells = system.mesh.cells;
    let (u, inverse) = (&u[..=cells], &system.mesh.per_length[..cells]);
    let (d3, tangent) = (&mut shape.d3[..cells], &mut shape.tangent[..cells]);
    let (stretch, per_stretch) = (&mut shape.stretch[..cells], &mut shape.per_stretch[..cells]);
    let strains = &mut shape.strain[..cells];
    for c in 0..cells {
        let e = (u[c + 1] - u[c]) * inverse[c];
        let line = CellLine::new(Planar::new(e.x, e.z + 1.0));
        d3[c] = line.d3;
        stretch[c] = line.stretch;
        per_stretch[c] = line.per_stretch;
        tangent[c] = line.tangent;
        strains[c] = strain(c, &mut shape.sections, e, &line);
    }
}

/// Line of a cell.
#[derive(Clone, Copy, Debug)]
pub struct CellLine<T> {
    /// Director `d3`.
    pub d3: Planar<T>,
    /// Stretch `λ`.
    pub stretch: T,
    /// Inverse stretch `1/λ`.
    pub per_stretch: T,
    /// Unit tangent `e_t`.
    pub tangent: Planar<T>,
}

impl<T: Scalar> CellLine<T> {
    #[inline(always)]
    fn new(d3: Planar<T>) -> Self {
        let stretch = d3.squared().sqrt();
        let per_stretch = T::constant(1.0) / stretch;
        Self {
            d3,
            stretch,
            per_stretch,
            tangent: d3.times(per_stretch),
        }
    }
}

/// Rates of stretch, angle and curvature, if any force depends on them: `λ_t = e_t·d3_t`, `φ_t = d1·d3_t/λ²`.
pub fn rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let turned = system.turns_with_its_line() && system.layout.lines[1].v.is_some();
    if turned || system.damped {
        line_rates(system, w);
    }
    if system.damped {
        curvature_rates(system, now, w);
    }
}

/// Rates of stretch, angle and curvature in any case.
pub fn strain_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    line_rates(system, w);
    curvature_rates(system, now, w);
}

/// Rates of stretch and angle.
fn line_rates<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    if system.model.effects.has(Effect::Shear) {
        timoshenko::strain_rates(system, w);
        return;
    }
    let cells = system.mesh.cells;
    let inverse = &system.mesh.per_length[..cells];
    let (v, shape) = (&w.motion.v[..=cells], &mut w.shape);
    let (tangent, per_stretch) = (&shape.tangent[..cells], &shape.per_stretch[..cells]);
    let (stretch_rate, angle_rate) = (&mut shape.stretch_rate[..cells], &mut shape.angle_rate[..cells]);
    for c in 0..cells {
        let d3_t = (v[c + 1] - v[c]) * inverse[c];
        stretch_rate[c] = tangent[c].dot(d3_t);
        angle_rate[c] = tangent[c].cross(d3_t) * per_stretch[c];
    }
}

/// Rotation rate `φ_t` of a cell's line [1/s].
#[inline]
pub fn angle_rate<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    let d3_t = (w.motion.v[c + 1] - w.motion.v[c]) * system.mesh.per_length[c];
    w.shape.tangent[c].cross(d3_t) * w.shape.per_stretch[c]
}

/// Curvature rate `κ_t` at nodes, from the rotation rates of cells and prescribed slopes.
pub fn curvature_rates<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = &system.mesh.per_node_length;
    let last = system.mesh.nodes - 1;
    let turning = w.shape.angle_rate[..last].windows(2);
    for ((rate, pair), inverse) in w.shape.kappa_rate[1..last].iter_mut().zip(turning).zip(&inverse[1..]) {
        *rate = (pair[0] - pair[1]) * *inverse;
    }
    let shape = &mut w.shape;
    for (k, end) in system.mesh.ends() {
        if let Some([_, rate]) = angle_of_end(&now.ends[k], &shape.joints.angle, &shape.joints.rate) {
            let turning = rate - shape.angle_rate[end.cell];
            shape.kappa_rate[end.node] = turning * (-end.outward * inverse[end.node]);
        }
    }
}

/// `[E12]` Normal force, moment and shear force (A.31-A.33), elastic and viscous parts:
///
/// ```text
/// N = EA (λ - 1 - λ_p)      M = EI (α - α_p)      α = κ (conservative), λ κ (published)
/// V = -(M_total)'/λ         N_total = N + EA τ_a λ_t      M_total = M + EI τ_b κ_t
/// ```
///
/// At an end with given moment, M is this moment and determines the curvature.
pub fn normal_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let ea = &system.sections.axial;
    let pressed = system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch);
    let strains = w.shape.strain.iter();
    for ((force, strain), ea) in w.forces.normal.iter_mut().zip(strains).zip(ea) {
        *force = *strain * *ea;
    }
    if pressed {
        let k = system.mesh.cells_per_segment;
        for beam in &system.mesh.beams {
            let forces = w.forces.normal[beam.cells.clone()].chunks_exact_mut(k);
            let segments = forces.zip(ea[beam.cells.clone()].chunks_exact(k));
            for ((forces, ea), stretch) in segments.zip(&w.coupling.pressure_stretch[beam.segments.clone()]) {
                forces
                    .iter_mut()
                    .zip(ea)
                    .for_each(|(force, ea)| *force -= *stretch * *ea);
            }
        }
    }
    if section.axial_damping_time > 0.0 {
        let viscous = w.forces.viscous_normal.iter_mut();
        for ((force, rate), viscosity) in viscous.zip(&w.shape.stretch_rate).zip(&system.sections.axial_viscosity) {
            *force = *rate * *viscosity;
        }
    }
    eccentric::normal_forces(system, now, w);
    if system.mesh.fourth {
        fourth_order::of_cells(system, ea, &mut w.forces.normal);
        if section.axial_damping_time > 0.0 {
            fourth_order::of_cells(system, ea, &mut w.forces.viscous_normal);
        }
    }
}

/// Total normal force `N_total` of a cell [N].
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

/// Couple per length of distributed moments: `d3·m b1`, for small rotations `m b1_z + g φ m b1_x`, `[E26]`; and of a rotating frame,
/// `m y11 W'`.
#[inline]
pub fn couple<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, c: usize) -> T {
    let given = match system.model.kinematics {
        Kinematics::Bar => T::zero(),
        Kinematics::Linear => T::constant(now.moment[c].z),
        Kinematics::SmallRotation => w.shape.d3[c].x * now.moment[c].x + now.moment[c].z,
        Kinematics::FiniteRotation => w.shape.d3[c].x * now.moment[c].x + w.shape.d3[c].z * now.moment[c].z,
    };
    match system.model.frame.is_some() && system.model.effects.has(Effect::RotaryInertia) {
        true => given + system.sections.rotary[c] * now.frame_rotation.rate,
        false => given,
    }
}

/// Stretch `λ` at a node: mean of the adjacent cells.
#[inline]
pub fn node_stretch<T: Scalar>(mesh: &BeamMesh, w: &Workspace<T>, node: usize) -> T {
    let [before, behind] = mesh.cells_beside(node);
    (w.shape.stretch[before] + w.shape.stretch[behind]) * 0.5
}

/// `[E13]` Section force in lab axes, including the rotary part:
///
/// ```text
/// n = N_total e_t + V e_n + r d1         e_n = (-cos φ, sin φ),  d1 = λ (cos φ, -sin φ)
/// conservative   r = (d3·m b1 + m y11 φ_tt)/λ²
/// published      r = d3·m b1/λ² + m y11 (φ_tt + 2 λ_t φ_t/λ)     (A.5)
/// φ_tt = (d1·d3_tt/λ - 2 λ_t φ_t)/λ
/// ```
pub fn section_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let cells = system.mesh.cells;
    let (forces, shape) = (&mut w.forces, &w.shape);
    let (tangent, section_force) = (&shape.tangent[..cells], &mut forces.section[..cells]);
    let (normal, shear) = (&forces.normal[..cells], &forces.shear[..cells]);
    wide!(turned(tangent, [normal, shear], section_force));
    if fourth_order::bends_its_cells(system) {
        for c in 0..cells {
            let share = fourth_order::arc(system, now, &shape.kappa, c);
            section_force[c] += tangent[c].times(normal[c] * share);
        }
    }
    let mut parts = [&forces.nonlinear_normal[..], &forces.relaxing_normal, &[]];
    if section.axial_damping_time > 0.0 {
        parts[2] = &forces.viscous_normal;
    }
    for part in parts {
        for ((force, tangent), normal) in section_force.iter_mut().zip(tangent).zip(part) {
            *force += tangent.times(*normal);
        }
    }
    if system.has_moments {
        for c in 0..cells {
            let couple = couple(system, now, w, c);
            add_couple(couple, c, w);
        }
    }
    attached::turning(system, now, w, add_couple);
    bodies::turning(system, now, w, add_couple);
    if system.model.effects.has(Effect::RotaryInertia) {
        rotary_inertia(system, w);
    }
}

/// Section force `N e_t + V e_n` of each cell.
#[inline(always)]
fn turned<T: Scalar>(tangent: &[Planar<T>], [normal, shear]: [&[T]; 2], force: &mut [Planar<T>]) {
    for (((force, tangent), normal), shear) in force.iter_mut().zip(tangent).zip(normal).zip(shear) {
        *force = tangent.times(*normal) + tangent.normal().times(*shear);
    }
}

/// Adds the rotary inertia of sections in [`section_forces`].
fn rotary_inertia<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let inverse = &system.mesh.per_length;
    let cells = system.mesh.cells;
    let rotary = &system.sections.rotary[..cells];
    let (a, shape) = (&w.motion.a[..=cells], &w.shape);
    let (tangent, section) = (&shape.tangent[..cells], &mut w.forces.section[..cells]);
    if system.layout.lines[1].v.is_none() {
        for c in 0..cells {
            section[c].x += (a[c + 1].x - a[c].x) * (inverse[c] * rotary[c]);
        }
        return;
    }
    // `across` is λ φ_tt + 2 λ_t φ_t: the published form uses all of it, the conservative form only φ_tt, divided by λ
    let across = |c: usize| tangent[c].cross((a[c + 1] - a[c]) * inverse[c]);
    if system.model.published() {
        for c in 0..cells {
            section[c] -= tangent[c].normal().times(across(c) * rotary[c]);
        }
        return;
    }
    let (stretch_rate, angle_rate) = (&shape.stretch_rate[..cells], &shape.angle_rate[..cells]);
    let per_stretch = &shape.per_stretch[..cells];
    for c in 0..cells {
        let turning = (across(c) - stretch_rate[c] * angle_rate[c] * 2.0) * per_stretch[c].squared();
        section[c] -= tangent[c].normal().times(turning * rotary[c]);
    }
}

/// Adds `r d1` with `r = couple/λ²` to the section force.
#[inline]
fn add_couple<T: Scalar>(couple: T, c: usize, w: &mut Workspace<T>) {
    let r = couple * w.shape.per_stretch[c];
    w.forces.section[c] -= w.shape.tangent[c].normal().times(r);
}
