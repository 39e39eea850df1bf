//! Work in zero time at a switch: a solid without inertia jumps with its load, and ends with their moment.

use super::{EnergyRate, add, add_rates, beams, fluid, ports, solid, solid_state};
use crate::discrete::velocity_jump::{self, Nodal};
use crate::discrete::{System, TimeData, Workspace};
use crate::functions::signals::Jet;
use crate::model::Kinematics;

/// Sets the rates of the time data to the differences over a jump, which is treated as one unit of time.
pub fn travel(now: &mut TimeData, [before, after]: [&TimeData; 2]) {
    let step = |jet: &mut Jet, from: &Jet, to: &Jet| jet.rate = to.value - from.value;
    let option = |jet: &mut Option<Jet>, from: &Option<Jet>, to: &Option<Jet>| {
        if let (Some(jet), Some(from), Some(to)) = (jet, from, to) {
            step(jet, from, to);
        }
    };
    for ((end, from), to) in now.ends.iter_mut().zip(&before.ends).zip(&after.ends) {
        (0..2).for_each(|axis| option(&mut end.u[axis], &from.u[axis], &to.u[axis]));
        option(&mut end.slope, &from.slope, &to.slope);
        step(&mut end.moment, &from.moment, &to.moment);
    }
    let differences = |out: &mut [f64], from: &[f64], to: &[f64]| {
        for ((out, from), to) in out.iter_mut().zip(from).zip(to) {
            *out = to - from;
        }
    };
    let curved = [&before.rest_curvature[0], &after.rest_curvature[0]];
    differences(&mut now.rest_curvature[1], curved[0], curved[1]);
    differences(&mut now.port_pressure_rate, &before.port_pressure, &after.port_pressure);
    differences(&mut now.source_flow, &before.source_volume, &after.source_volume);
    differences(&mut now.statics.rate, &before.statics.force, &after.statics.force);
    differences(&mut now.statics.mean_rate, &before.statics.mean, &after.statics.mean);
}

/// Power of everything that does work during a jump, at one of its sides: loads, ends, ports of lumped networks with given pressure, and
/// terms of the published forms. Without duration there is no flow and no dissipation.
///
/// `now` and `yp` contain differences as rates; velocities in the workspace are displacements. The mean of both sides is the trapezoid
/// rule along a straight path, exact for linear response.
pub fn side(system: &System, now: &TimeData, yp: &[f64], w: &mut Workspace<f64>, out: &mut [f64]) {
    out.fill(0.0);
    add_rates(system, now, yp, w);
    let curvature_rate = fluid::rates(system, w, out);
    solid::flows(system, now, curvature_rate, w, out);
    fluid::lumped_jump(system, now, w, out);
    ports::lumped_jump(system, w, out);
    for flow in [
        EnergyRate::Damping,
        EnergyRate::ImpulseX,
        EnergyRate::ImpulseZ,
        EnergyRate::AngularImpulse,
    ] {
        out[flow as usize] = 0.0;
    }
    beams::lose_nothing(system, out);
}

/// Impulses and work of driven ends with a velocity jump. They move half a cell, or without axial waves the whole beam, and rotate the
/// adjacent sections. The workspace contains the state; `velocities` are those of nodes on both sides of the jump.
pub fn strokes(
    system: &System,
    [before, after]: [&TimeData; 2],
    [was, is]: &[Nodal; 2],
    w: &Workspace<f64>,
    out: &mut [f64],
) {
    let (mesh, l) = (&system.mesh, &system.layout);
    if !l.inertia {
        return;
    }
    let last = mesh.nodes - 1;
    let jumps: Nodal = was.iter().zip(is).map(|(a, b)| *b - *a).collect();
    let impulses = velocity_jump::impulses(system, &jumps, w);
    let around = velocity_jump::taken_around(system, &jumps, w);
    let streams = system.model.surroundings.as_ref().is_some_and(|s| s.stream.is_some());
    for node in 0..=last {
        let end = after.end(node);
        let mean = |k: usize| 0.5 * (was[node][k] + is[node][k]);
        let stroke = |k: usize| (impulses[node][k], (impulses[node][k] + around[node][k]) * mean(k));
        let across = system.model.kinematics != Kinematics::Bar && end.is_some_and(|end| end.u[0].is_some());
        // impulse that the surrounding fluid transfers to a free node
        let left = |k: usize| (-around[node][k], 0.0);
        let (px, work_x) = if across { stroke(0) } else { left(0) };
        let (pz, work_z) = if l.lines[1].v.is_some() {
            let driven = end.is_some_and(|end| end.u[1].is_some());
            if driven { stroke(1) } else { left(1) }
        } else {
            carried(system, [before, after], node)
        };
        add(out, EnergyRate::Ends, work_x + work_z);
        if streams {
            add(
                out,
                EnergyRate::Loads,
                -around[node].x * mean(0) - around[node].z * mean(1),
            );
        }
        add(out, EnergyRate::ImpulseX, px);
        add(out, EnergyRate::ImpulseZ, pz);
        let (arm, _) = solid_state::arms(system, w, node);
        add(out, EnergyRate::AngularImpulse, arm.z * px - arm.x * pz);
    }
}

/// Impulse and work of a node that moves with the frame.
fn carried(system: &System, sides: [&TimeData; 2], node: usize) -> (f64, f64) {
    let mass = system.masses[node];
    let share = system.mesh.share(node);
    let [from, to] = sides.map(|now| now.carried(1, share).rate);
    (mass * (to - from), 0.5 * mass * (to * to - from * from))
}
