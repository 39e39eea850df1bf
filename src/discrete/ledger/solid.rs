//! Contributions of the beam to the balances.

use std::ops::Range;

use super::solid_state::{arms, carried, turned_across, turning_rate};
use super::{EnergyRate, Rates, add, add_all, beams};
use crate::case::schema::Effect;
use crate::discrete::residual::bending::relative_stiffness;
use crate::discrete::residual::momentum::outer_forces;
use crate::discrete::residual::solid::{couple, node_stretch};
use crate::discrete::residual::{eccentric, fourth_order, relaxation};
use crate::discrete::{System, TimeData, Workspace, attached, bodies};
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Adds powers and impulses of loads, ends, damping, and of the published form; in a structure also the ledger of each beam.
pub fn flows(
    system: &System,
    now: &TimeData,
    pressure_rate: impl Fn(&Workspace<f64>, usize) -> [f64; 2],
    w: &Workspace<f64>,
    out: &mut [f64],
) {
    for (number, beam) in system.mesh.beams.iter().enumerate() {
        let mut rates = Rates::default();
        let held = nodes(system, now, &pressure_rate, w, beam.nodes.clone(), &mut rates);
        turning_bodies(system, now, w, &beam.nodes, &mut rates);
        let lost = relaxation::energy_and_loss(system, now, w, beam)[1];
        add(&mut rates, EnergyRate::Damping, lost);
        cells(system, now, w, beam.cells.clone(), &mut rates);
        if system.model.structure.is_some() {
            beams::put((system, now, w), number, &rates, held, out);
        }
        add_all(out, rates);
    }
    add(out, EnergyRate::Damping, system.joints.loss(w));
    add(out, EnergyRate::AngularImpulse, attached::torque(system, now, w));
}

/// Contributions of nodes; returns the power of springs and contacts on them [W].
fn nodes(
    system: &System,
    now: &TimeData,
    pressure_rate: &impl Fn(&Workspace<f64>, usize) -> [f64; 2],
    w: &Workspace<f64>,
    range: Range<usize>,
    out: &mut Rates,
) -> f64 {
    let l = &system.layout;
    let mut stored = 0.0;
    for i in range {
        let (v, a) = (w.motion.v[i], w.motion.a[i]);
        let mut f = Planar::default();
        outer_forces(system, now, w, i, |flow, force| {
            match flow {
                Some(flow) => add(out, flow, flow.energy_sign() * force.dot(v)),
                None => stored += force.dot(v),
            }
            f += force;
        });
        if system.model.structure.is_some() {
            // forces of the inertia of bodies, whose energy is the beam's
            bodies::forces(system, now, w, i, &mut |flow, force: Planar<f64>| {
                if flow.is_none() {
                    stored -= force.dot(v);
                }
            });
        }
        let inertia = system.masses[i];
        if l.inertia && l.lines[1].v.is_none() {
            add(
                out,
                EnergyRate::Ends,
                -inertia * a.z * (v.z - carried(system, now, w, i)),
            );
        }
        let held = held(system, now, i);
        if held != [false; 2] {
            let missing = missing(system, w, i, f);
            for axis in (0..2).filter(|&axis| held[axis]) {
                add(out, EnergyRate::Ends, missing[axis] * v[axis]);
                f[axis] += missing[axis];
            }
        }
        let (arm, arm_rate) = arms(system, w, i);
        let f = system.in_axes_of_case(i, f);
        add(out, EnergyRate::ImpulseX, f.x);
        add(out, EnergyRate::ImpulseZ, f.z);
        let turning = if l.inertia && system.model.structure.is_none() {
            inertia * (arm_rate.z * v.x - arm_rate.x * carried(system, now, w, i))
        } else {
            0.0
        };
        add(out, EnergyRate::AngularImpulse, arm.cross(f) + turning);
        if system.model.kinematics != Kinematics::Bar {
            bending(system, now, pressure_rate, w, i, out);
        }
    }
    stored
}

/// Work and torque of bodies that rotate with the beam of these nodes; their own momentum is not an external force.
fn turning_bodies(system: &System, now: &TimeData, w: &Workspace<f64>, nodes: &Range<usize>, out: &mut Rates) {
    for body in system.bodies.iter().filter(|body| nodes.contains(&body.node)) {
        add(out, EnergyRate::Loads, body.power_of_couple(system, now, w));
        let (force, torque) = body.outside(system, now, w);
        let arm = body.at_place(|i| arms(system, w, i).0);
        let arm_rate = body.at_place(|i| arms(system, w, i).1);
        let (momentum, _) = body.momenta(system, w);
        let [force, momentum] = [force, momentum].map(|one| system.in_axes_of_case(body.node, one));
        add(out, EnergyRate::ImpulseX, -force.x);
        add(out, EnergyRate::ImpulseZ, -force.z);
        let turned = if system.layout.inertia {
            arm_rate.cross(momentum) - arm.cross(force)
        } else {
            0.0
        };
        add(out, EnergyRate::AngularImpulse, torque + turned);
    }
}

/// Directions in which the motion of a node is given.
fn held(system: &System, now: &TimeData, node: usize) -> [bool; 2] {
    let given = |axis: usize| now.end(node).is_some_and(|end| end.u[axis].is_some());
    let lines = &system.layout.lines;
    [0, 1].map(|axis| !lines[axis].free.contains(&node) || given(axis))
}

/// Reaction of a driven end: residual of a node's momentum balance with its section forces and the external force `force`.
fn missing(system: &System, w: &Workspace<f64>, i: usize, force: Planar<f64>) -> Planar<f64> {
    let none = Planar::default();
    let right = w.forces.section.get(i).copied().unwrap_or(none);
    let left = if i > 0 { w.forces.section[i - 1] } else { none };
    let inertia = if system.layout.inertia { system.masses[i] } else { 0.0 };
    w.motion.a[i] * inertia - force - right + left
}

/// Force of the support or drive on an end with given motion [N].
pub fn reaction(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> Planar<f64> {
    let mut f = Planar::default();
    outer_forces(system, now, w, node, |_, force| f += force);
    missing(system, w, node, f)
}

/// Contributions of one node: end moments, viscous moments, and the published curvature measure.
fn bending(
    system: &System,
    now: &TimeData,
    pressure_rate: &impl Fn(&Workspace<f64>, usize) -> [f64; 2],
    w: &Workspace<f64>,
    i: usize,
    out: &mut Rates,
) {
    let mesh = &system.mesh;
    let curvature_rate = |w: &Workspace<f64>, node: usize| pressure_rate(w, node)[1];
    let length = mesh.node_lengths[i];
    let published = system.model.published();
    let end = now.end(i);
    let stretches = |i: usize| {
        if published {
            let [a, b] = mesh.cells_beside(i);
            (
                node_stretch(mesh, w, i),
                0.5 * (w.shape.stretch_rate[a] + w.shape.stretch_rate[b]),
            )
        } else {
            (1.0, 0.0)
        }
    };
    let (stretch, stretch_rate) = stretches(i);
    // With a given moment, the curvature follows from it.
    let kappa_rate = match end {
        Some(e) if !e.turns() && !system.sections.offset.is_empty() => {
            eccentric::end_rate(system, now, w, i, pressure_rate(w, i)).unwrap_or(0.0)
        }
        Some(e) if !e.turns() => {
            let bent = relative_stiffness(system, now, w, i);
            let free_rate = bent * (curvature_rate(w, i) + now.rest_curvature_rate(i));
            let mut elastic_rate = e.moment.rate / system.sections.bending[i];
            if mesh.fourth {
                let beside = fourth_order::neighbour(system, i);
                let (left, right) = mesh.segments_of_node(beside);
                // curvatures by pressure on the left of nodes
                let by_pressure = 0.5 * (curvature_rate(w, beside) + curvature_rate(w, beside + right - left));
                let (stretch, stretch_rate) = stretches(beside);
                let alpha_rate = stretch * w.shape.kappa_rate[beside] + stretch_rate * w.shape.kappa[beside];
                let free_rate = by_pressure + now.rest_curvature_rate(beside);
                let [own, other] = system.sections.smooth.end_weights[usize::from(i > 0)];
                elastic_rate = own * elastic_rate + other * (alpha_rate - free_rate);
            }
            let alpha_rate = elastic_rate + free_rate - w.shape.kappa[i] * stretch_rate;
            relaxation::curvature_rate(system, now, w, i, alpha_rate, bent * stretch)
        }
        _ => w.shape.kappa_rate[i],
    };
    let part = |moments: &[f64]| moments.get(i).copied().unwrap_or(0.0);
    let forces = &w.forces;
    let elastic =
        forces.moment[i] + part(&forces.nonlinear_moment) + part(&forces.relaxing_moment) + part(&forces.offset_moment);
    let moment = elastic + forces.viscous_moment[i];
    // moments of a joint are internal
    if let Some((e, (_, place))) = end.filter(|end| end.joint.is_none()).zip(mesh.end_at(i)) {
        let (sign, cell) = (-place.outward, place.cell);
        let angle_rate = match e.slope {
            Some(slope) => slope.rate,
            None => w.shape.angle_rate[cell] + sign * 0.5 * mesh.lengths[cell] * kappa_rate,
        };
        let whole = moment + part(&forces.arc_moment);
        add(out, EnergyRate::Ends, sign * whole * angle_rate);
        add(out, EnergyRate::AngularImpulse, sign * whole);
    }
    let rest_rate = now.rest_curvature_rate(i);
    add(
        out,
        EnergyRate::Damping,
        length * forces.viscous_moment[i] * (kappa_rate - rest_rate),
    );
    add(out, EnergyRate::Loads, -length * moment * rest_rate);
    if published {
        // d/dt (λ κ - κ)
        let excess_rate = (stretch - 1.0) * kappa_rate + w.shape.kappa[i] * stretch_rate;
        add(out, EnergyRate::Formulation, length * w.forces.moment[i] * excess_rate);
    }
}

/// Contributions of the cells: distributed moments, viscous forces, and the published rotary term.
fn cells(system: &System, now: &TimeData, w: &Workspace<f64>, range: Range<usize>, out: &mut Rates) {
    let published = system.model.published();
    for c in range {
        let h = system.mesh.lengths[c];
        let rotary = system.sections.rotary[c];
        if system.has_moments {
            let couple = couple(system, now, w, c);
            add(out, EnergyRate::Loads, -h * couple * w.shape.angle_rate[c]);
            add(out, EnergyRate::AngularImpulse, -h * couple);
        }
        add(
            out,
            EnergyRate::Damping,
            h * w.forces.viscous_normal[c] * w.shape.stretch_rate[c],
        );
        if let Some(rate) = w.shape.sections.shear_rate.get(c) {
            let viscous = system.sections.shear_viscosity[c];
            let loss = match w.forces.viscous_shear.get(c) {
                Some(force) => h * force * rate,
                None => h * viscous * rate * rate,
            };
            add(out, EnergyRate::Damping, loss);
        }
        if turned_across(system) {
            let turning = (w.motion.v[c + 1].z - w.motion.v[c].z) * turning_rate(system, w, c);
            add(out, EnergyRate::AngularImpulse, rotary * turning);
        } else if published && system.model.effects.has(Effect::RotaryInertia) {
            let spurious = rotary * w.shape.stretch[c] * w.shape.stretch_rate[c] * w.shape.angle_rate[c].powi(2);
            add(out, EnergyRate::Formulation, -h * spurious);
        }
    }
}
