//! Beam with shear: sections rotate by their own angles.

use super::bending::total_moment_drop;
use super::solid::{angle_of_end, couple, lines, normal_force};
use super::{arcs, fourth_order, relaxation};
use crate::case::schema::Effect;
use crate::discrete::workspace::Sections;
use crate::discrete::{System, TimeData, Workspace, attached, bodies};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar};

/// `[E63]` The section of each cell has its own angle θ, which determines moments; γ is the rotation of the beam's line relative to the
/// section (Reissner, ZAMP 23, 795-804, 1972; signs of V and γ as in [E12]):
///
/// ```text
/// e_t = (sin θ, cos θ)    e_n = (-cos θ, sin θ)    λ - 1 -> ε = d3·e_t - 1    γ = d3·e_n    κ = -θ'
/// N = EA (ε - λ_p)    M = EI (κ - α_p)    V = kGA γ    n = N e_t + V e_n
/// m y11 θ_tt = -M' - V (1 + ε) + N γ - d3·m b1
/// κ_i = -(θ_{i+1/2} - θ_{i-1/2})/h, at ends from their slopes as in [E11], which are angles of sections
/// E gains Σ h kGA γ²/2, and has Σ h m y11 θ_t²/2        V gains kGA τ_b γ_t with the damping of bending
/// ```
///
/// The potential is `∫ (N²/2EA + V²/2kGA + M²/2EI)`: `N δε + V δγ + M δκ` with `δε = δd3·e_t - γ δθ`, `δγ = δd3·e_n + (1 + ε) δθ`. For
/// kGA → ∞, γ → 0 and V equals that of [E12] up to the order of `EI/(kGA l²)`. For small rotations, with g as in [E26],
///
/// ```text
/// ε = u3' + g u1'²/2    γ = θ - u1'    n_x = g N u1' - V    n_z = N    m y11 θ_tt = -M' - V - (m b1_z + g u1' m b1_x)
/// ```
pub fn kinematics<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    let (u, shape) = (&w.motion.u, &mut w.shape);
    if finite {
        lines(system, u, shape, |c, sections, e, line| {
            let (s, c_half) = (sections.angle[c] * 0.5).sin_cos();
            // cos θ - 1, without cancellation
            let less = s * s * -2.0;
            let normal = Planar::new(s * c_half * 2.0, less + 1.0);
            sections.normal[c] = normal;
            sections.shear[c] = line.d3.dot(normal.normal());
            e.x * normal.x + e.z * normal.z + less
        });
    } else {
        let sections = &mut shape.sections;
        for ((shear, angle), d3) in sections.shear.iter_mut().zip(&sections.angle).zip(&shape.d3) {
            *shear = *angle - d3.x;
        }
    }
    curvatures(system, now, w);
}

fn curvatures<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let inverse = &system.mesh.per_node_length;
    let last = system.mesh.nodes - 1;
    let angle = &w.shape.sections.angle;
    for i in 1..last {
        w.shape.kappa[i] = (angle[i - 1] - angle[i]) * inverse[i];
    }
    for (k, end) in system.mesh.ends() {
        if let Some([given, _]) = angle_of_end(&now.ends[k], &w.shape.joints.angle, &[]) {
            w.shape.kappa[end.node] = (given - angle[end.cell]) * (-end.outward * inverse[end.node]);
        }
    }
}

/// Rates of stretch and shear: `ε_t = d3_t·e_t - γ θ_t`, `γ_t = d3_t·e_n + (1 + ε) θ_t`. Rates of angles are unknowns.
pub fn strain_rates<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    for (c, &inverse) in system.mesh.per_length.iter().enumerate() {
        let d3_t = (w.motion.v[c + 1] - w.motion.v[c]) * inverse;
        let turning = w.shape.angle_rate[c];
        let sections = &mut w.shape.sections;
        if finite {
            let normal = sections.normal[c];
            let line = sections.of_ends(c, w.shape.strain[c]);
            w.shape.stretch_rate[c] = d3_t.dot(normal) - line.x * turning;
            sections.shear_rate[c] = d3_t.dot(normal.normal()) + line.z * turning;
        } else {
            sections.shear_rate[c] = turning - d3_t.x;
        }
    }
}

/// Shear forces, section forces, and moments that rotate sections.
pub fn forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    shears(system, now, w);
    section_forces(system, now, w);
}

/// Shear forces with their viscous and relaxing parts.
fn shears<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let time = system.model.section.bending_damping_time;
    let sections = &w.shape.sections;
    let (stiffness, viscosity) = (&system.sections.shear, &system.sections.shear_viscosity);
    for ((force, shear), kga) in w.forces.shear.iter_mut().zip(&sections.shear).zip(stiffness) {
        *force = *shear * *kga;
    }
    if system.mesh.fourth {
        fourth_order::of_cells(system, stiffness, &mut w.forces.shear);
        arcs::forces(system, now, w);
        if time > 0.0 {
            let rates = w.shape.sections.shear_rate.iter().zip(viscosity);
            for (force, (rate, viscosity)) in w.forces.viscous_shear.iter_mut().zip(rates) {
                *force = *rate * *viscosity;
            }
            fourth_order::of_cells(system, stiffness, &mut w.forces.viscous_shear);
            for (force, viscous) in w.forces.shear.iter_mut().zip(&w.forces.viscous_shear) {
                *force += *viscous;
            }
        }
    } else if time > 0.0 {
        let rates = w.shape.sections.shear_rate.iter().zip(viscosity);
        for (force, (rate, viscosity)) in w.forces.shear.iter_mut().zip(rates) {
            *force += *rate * *viscosity;
        }
    }
    relaxation::shears(system, w);
    for (force, relaxing) in w.forces.shear.iter_mut().zip(&w.forces.relaxing_shear) {
        *force += *relaxing;
    }
}

/// Section forces in lab axes, and moments that rotate sections, [E63].
fn section_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let tension = system.model.kinematics == Kinematics::SmallRotation;
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    for c in 0..system.mesh.cells {
        let (mut normal, mut shear) = (normal_force(system, w, c), w.forces.shear[c]);
        let more = w.forces.arc_section.get(c).copied();
        if let Some(more) = more.filter(|_| finite) {
            normal += more.z;
            shear += more.x;
        }
        let mut turning = shear;
        if finite {
            let e_t = w.shape.sections.normal[c];
            w.forces.section[c] = e_t.times(normal) + e_t.normal().times(shear);
            let line = w.shape.sections.of_ends(c, w.shape.strain[c]);
            turning = shear * line.z - normal * line.x;
        } else {
            let mut across = if tension {
                normal * w.shape.d3[c].x - shear
            } else {
                -shear
            };
            if let Some(more) = more {
                across += more.x;
            }
            w.forces.section[c] = Planar::new(across, normal);
        }
        if system.has_moments {
            turning += couple(system, now, w, c);
        }
        w.forces.turning[c] = total_moment_drop(system, w, c) - turning * system.mesh.lengths[c];
    }
    attached::turning(system, now, w, |couple, c, w| {
        w.forces.turning[c] += couple * -system.mesh.lengths[c];
    });
    bodies::turning(system, now, w, |couple, c, w| {
        w.forces.turning[c] += couple * -system.mesh.lengths[c];
    });
}

impl<T: Scalar> Sections<T> {
    /// `(γ, 1 + ε)` from the end points of a cell with the strain ε.
    #[inline]
    pub fn of_ends(&self, cell: usize, strain: T) -> Planar<T> {
        match self.line.get(cell) {
            Some(line) => *line,
            None => Planar::new(self.shear[cell], strain + 1.0),
        }
    }
}

/// Balance of moments of each section.
pub fn rows<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let turning = system.layout.turning.moments();
    for (row, moment) in turning.clone().zip(&w.forces.turning) {
        r[row] = -*moment;
    }
    if turning.is_empty() || !system.model.effects.has(Effect::RotaryInertia) {
        for (c, row) in turning.enumerate().filter(|(c, _)| system.mesh.is_gap(*c)) {
            r[row] = w.shape.sections.angle[c];
        }
        return;
    }
    let rotary = &system.sections.rotary;
    let momentum = |c: usize| w.shape.sections.acceleration[c] * (rotary[c] * system.mesh.lengths[c]);
    for (c, row) in turning.clone().enumerate() {
        r[row] += momentum(c);
    }
    if system.mesh.fourth {
        fourth_order::each_step(system, rotary, momentum, |c, step| r[turning.start + c] += step);
    }
    let angles = system.layout.turning.angle.start;
    for c in (0..system.mesh.cells).filter(|c| system.mesh.is_gap(*c)) {
        (r[angles + c], r[turning.start + c]) = (w.shape.sections.angle[c], w.shape.angle_rate[c]);
    }
}
