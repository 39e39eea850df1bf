//! Contributions of the beam to the balances.

use std::ops::Range;

use super::{EnergyRate, Rates, StoredEnergies, add};
use crate::case::schema::Effect;
use crate::discrete::residual::bending::{elastic_curvature, relative_stiffness};
use crate::discrete::residual::momentum::outer_forces;
use crate::discrete::residual::solid::{couple, node_stretch};
use crate::discrete::residual::{eccentric, fourth_order, relaxation};
use crate::discrete::{System, TimeData, Workspace, attached};
use crate::model::Kinematics;
use crate::numerics::Planar;

/// Powers and impulses of loads, ends, damping, and of the published form.
pub fn flows(
    system: &System,
    now: &TimeData,
    pressure_rate: impl Fn(&Workspace<f64>, usize) -> [f64; 2],
    w: &Workspace<f64>,
) -> Rates {
    let (mesh, l) = (&system.mesh, &system.layout);
    let mut rates = Rates::default();
    let out = &mut rates;
    let last = mesh.nodes - 1;
    let published = system.model.published();
    for i in 0..=last {
        let (v, a) = (w.motion.v[i], w.motion.a[i]);
        let mut f = Planar::default();
        outer_forces(system, now, w, i, |flow, force| {
            if let Some(flow) = flow {
                add(out, flow, flow.energy_sign() * force.dot(v));
            }
            f += force;
        });
        let inertia = system.masses[i];
        if l.inertia && l.lines[1].v.is_none() {
            add(
                out,
                EnergyRate::Ends,
                -inertia * a.z * (v.z - carried(system, now, w, i)),
            );
        }
        let held = held(system, i);
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
            bending(system, now, &pressure_rate, w, i, out);
        }
    }
    add(out, EnergyRate::Damping, system.joints.loss(w));
    add(out, EnergyRate::AngularImpulse, attached::torque(system, now, w));
    bodies(system, now, w, out);
    add(out, EnergyRate::Damping, relaxation::energy_and_loss(system, now, w)[1]);
    cells(system, now, w, published, out);
    rates
}

/// Work and torque of bodies that rotate with the beam; their own momentum is not an external force.
fn bodies(system: &System, now: &TimeData, w: &Workspace<f64>, out: &mut Rates) {
    for body in &system.bodies {
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
fn held(system: &System, node: usize) -> [bool; 2] {
    let given = |axis: usize| system.joints.driven.iter().any(|&(_, n, a)| (n, a) == (node, axis));
    let lines = &system.layout.lines;
    [0, 1].map(|axis| !lines[axis].free.contains(&node) || given(axis))
}

/// Reaction of a driven end: residual of a node's momentum balance with its section forces and the external force `force`.
fn missing(system: &System, w: &Workspace<f64>, i: usize, force: Planar<f64>) -> Planar<f64> {
    let none = Planar::default();
    let right = w.forces.section.get(i).copied().unwrap_or(none);
    let left = if i > 0 { w.forces.section[i - 1] } else { none };
    w.motion.a[i] * system.masses[i] - force - right + left
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
    let last = mesh.nodes - 1;
    let length = mesh.node_lengths[i];
    let published = system.model.published();
    let end = now.end(i);
    let stretches = |i: usize| {
        if published {
            let (a, b) = (i.saturating_sub(1), i.min(last - 1));
            (
                node_stretch(w, i, last),
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
fn cells(system: &System, now: &TimeData, w: &Workspace<f64>, published: bool, out: &mut Rates) {
    for (c, &h) in system.mesh.lengths.iter().enumerate() {
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

/// Axial velocity of a node's mass: its own, or without axial inertia that of the frame, `[E27]`.
fn carried(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    if system.layout.lines[1].v.is_some() {
        return w.motion.v[node].z;
    }
    now.carried(1, system.mesh.share(node)).rate
}

/// True if sections rotate finitely but have the rotary inertia of `[E27]`.
fn turned_across(system: &System) -> bool {
    let finite = system.model.kinematics == Kinematics::FiniteRotation;
    finite && system.turns_with_its_line() && system.layout.lines[1].v.is_none()
}

/// Rate of rotation for rotary inertia: `φ_t`, without axial inertia `x'_t`.
fn turning_rate(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    if turned_across(system) {
        (w.motion.v[c + 1].x - w.motion.v[c].x) / system.mesh.lengths[c]
    } else {
        w.shape.angle_rate[c]
    }
}

/// Kinetic and elastic energies; the energy of shear is included in that of bending.
pub fn energies(system: &System, now: &TimeData, w: &Workspace<f64>) -> StoredEnergies {
    let mesh = &system.mesh;
    let sheared = system.model.effects.has(Effect::Shear);
    let mut e = energies_between(system, now, w, 0..mesh.nodes, 0..mesh.cells);
    if system.layout.inertia {
        for body in &system.bodies {
            let [kinetic, rotary] = body.energies(system, w);
            e.kinetic += kinetic;
            e.rotary += rotary;
        }
        e.rotary += system.joints.energies(now, w)[1];
    }
    if mesh.fourth && sheared {
        let (sections, shape) = (&system.sections, &w.shape);
        e.bending += fourth_order::energy_of_cells(system, &sections.shear, &shape.sections.shear);
        if system.model.effects.has(Effect::RotaryInertia) {
            e.rotary += fourth_order::energy_of_cells(system, &sections.rotary, &shape.angle_rate);
        }
    }
    e
}

/// Kinetic and elastic energies of some nodes and cells, without bodies that turn and, on a mesh of fourth order, without those of sections
/// that shear.
pub fn energies_between(
    system: &System,
    now: &TimeData,
    w: &Workspace<f64>,
    nodes: Range<usize>,
    cells: Range<usize>,
) -> StoredEnergies {
    let mesh = &system.mesh;
    let sheared = system.model.effects.has(Effect::Shear);
    let mut e = StoredEnergies::default();
    for i in nodes {
        let length = mesh.node_lengths[i];
        if system.layout.inertia {
            let along = carried(system, now, w, i);
            e.kinetic += 0.5 * system.masses[i] * (w.motion.v[i].x * w.motion.v[i].x + along * along);
        }
        e.bending += if mesh.fourth {
            fourth_order::of_bending(system, now, w, i)
        } else if let Some(energy) = eccentric::side_energy(system, w, i) {
            energy
        } else if let Some(law) = system.sections.laws.get(i) {
            length * law.at(elastic_curvature(system, now, w, i)).energy
        } else {
            0.5 * length * w.forces.moment[i] * w.forces.moment[i] / system.sections.bending[i]
        };
    }
    for c in cells {
        let h = mesh.lengths[c];
        if system.model.effects.has(Effect::AxialStretch) {
            e.axial += if mesh.is_gap(c) {
                0.0
            } else if mesh.fourth {
                fourth_order::of_stretch(system, w, c)
            } else {
                0.5 * h * w.forces.normal[c] * w.forces.normal[c] / system.sections.axial[c]
            };
        }
        if mesh.fourth && sheared {
            continue;
        }
        if let Some(shear) = w.shape.sections.shear.get(c) {
            e.bending += 0.5 * h * system.sections.shear[c] * shear * shear;
        }
        if system.model.effects.has(Effect::RotaryInertia) {
            e.rotary += 0.5 * h * spin(system, w, c) * turning_rate(system, w, c);
        }
    }
    e
}

/// Angular momentum of a cell's rotation per length: `m y11 φ_t`, published `m y11 λ² φ_t`.
fn spin(system: &System, w: &Workspace<f64>, c: usize) -> f64 {
    let factor = if system.model.published() && system.layout.lines[1].v.is_some() {
        w.shape.stretch[c] * w.shape.stretch[c]
    } else {
        1.0
    };
    system.sections.rotary[c] * factor * turning_rate(system, w, c)
}

/// Moment arms (x, z) of a node's momentum and force about the origin, i.e. its position, and their rates. A small
/// rotation ε moves a node by (ε θ, -ε g u1), whatever u3 is; the potential of `[E26]` is invariant under this motion.
pub fn arms(system: &System, w: &Workspace<f64>, i: usize) -> (Planar<f64>, Planar<f64>) {
    let at = Planar {
        x: 0.0,
        z: system.mesh.node_coordinate(i),
    };
    let (u, v) = (w.motion.u[i], w.motion.v[i]);
    if system.model.structure.is_some() {
        return (system.position(w, i), system.in_axes_of_case(i, v));
    }
    match system.model.kinematics {
        Kinematics::Bar | Kinematics::FiniteRotation => (at + u, v),
        Kinematics::SmallRotation => (Planar { x: u.x, ..at }, Planar { x: v.x, z: 0.0 }),
        Kinematics::Linear => (at, Planar::default()),
    }
}

/// Momentum and angular momentum about the origin.
pub fn momenta(system: &System, now: &TimeData, w: &Workspace<f64>) -> (Planar<f64>, f64) {
    let mesh = &system.mesh;
    let (mut momentum, mut angular) = (Planar::default(), 0.0);
    if !system.layout.inertia {
        return (momentum, angular);
    }
    for i in 0..mesh.nodes {
        let along = carried(system, now, w, i);
        let mass = system.masses[i];
        let own = Planar {
            z: along,
            ..w.motion.v[i]
        } * mass;
        let own = system.in_axes_of_case(i, own);
        momentum += own;
        angular += arms(system, w, i).0.cross(own);
    }
    for body in &system.bodies {
        let (own, about) = body.momenta(system, w);
        let own = system.in_axes_of_case(body.node, own);
        momentum += own;
        angular += body.at_place(|i| arms(system, w, i).0).cross(own) + about;
    }
    let joints = system.joints.angles.iter().zip(&w.shape.joints.rate);
    angular += joints.map(|(joint, rate)| joint.inertia * rate).sum::<f64>();
    if system.model.effects.has(Effect::RotaryInertia) {
        let arm = |c: usize| if turned_across(system) { w.shape.d3[c].z } else { 1.0 };
        let cells = (0..mesh.cells).map(|c| mesh.lengths[c] * arm(c) * spin(system, w, c));
        angular += cells.sum::<f64>();
    }
    (momentum, angular)
}
