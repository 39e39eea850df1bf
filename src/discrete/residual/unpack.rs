//! From the vector of unknowns to displacements, velocities, means and areas; driven ends filled in.

use std::ops::Range;

use crate::discrete::time_data::Frame;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::PoolKind;
use crate::numerics::Scalar;

/// Copies the state into the workspace; what an end prescribes comes from its signal, with exact rates.
///
/// `[E22]` Displacements are unknown relative to the straight line through the motions that the ends prescribe:
///
/// ```text
/// u_i = U_i + y_i     v_i = U'_i + y'_i     U_i = u(0) + (u(l_s) - u(0)) θ_i/l_s, or that of the one driven end
/// ```
///
/// So the integrator's error in a motion as a whole cannot stretch the beam between a node that is driven exactly and
/// its neighbour that is integrated.
pub fn unpack<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    let l = &system.layout;
    let last = system.mesh.nodes - 1;
    let lines = [
        (
            now.frame_1(),
            &l.free_u1,
            l.u1,
            l.v1,
            l.waves[0],
            &mut w.u1,
            &mut w.v1,
            &mut w.a1,
        ),
        (
            now.frame_3(),
            &l.free_u3,
            l.u3,
            l.v3,
            l.waves[1],
            &mut w.u3,
            &mut w.v3,
            &mut w.a3,
        ),
    ];
    for (frame, free, u, v, waves, displacement, velocity, acceleration) in lines {
        copy(&mut displacement[free.clone()], y, u);
        if waves {
            copy(&mut velocity[free.clone()], y, v);
            copy(&mut acceleration[free.clone()], yp, v);
        } else {
            acceleration[free.clone()].fill(T::zero());
            for (k, rate) in velocity[free.clone()].iter_mut().enumerate() {
                *rate = if l.differential[u + k] || !l.inertia {
                    yp[u + k]
                } else {
                    T::zero()
                };
            }
        }
        if let Some(frame) = frame {
            carry(&frame, l.inertia, free, last, [displacement, velocity, acceleration]);
        }
    }
    if let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) {
        if wet.takes_moments {
            copy(&mut w.mean_moment, y, l.mean_moment);
        }
        if wet.takes_forces {
            copy(&mut w.mean_force, y, l.mean_force);
        }
        for (mean, &given) in w.mean_force.iter_mut().zip(&now.statics.mean) {
            *mean = T::constant(given);
        }
        let mut first = l.area;
        for run in &fluid.runs {
            copy(&mut w.area[run.clone()], y, first);
            copy(&mut w.area_rate[run.clone()], yp, first);
            first += run.len();
        }
        copy(&mut w.junction, y, l.junction);
        copy(&mut w.bridge, y, l.bridge);
        for (k, pool) in wet.pools.iter().enumerate() {
            w.pool[k] = match (&pool.kind, l.pool_pressure[k]) {
                (PoolKind::Port(port), _) => T::constant(now.port_pressure[*port]),
                (_, Some(unknown)) => y[unknown],
                _ => T::zero(),
            };
        }
    }
}

/// Axial velocities that no equation takes, because nothing but waves depends on them; for balances and samples.
pub fn complete_velocities<T: Scalar>(system: &System, now: &TimeData, yp: &[T], w: &mut Workspace<T>) {
    let l = &system.layout;
    if l.waves[1] || !l.inertia {
        return;
    }
    let last = (system.mesh.nodes - 1) as f64;
    for (k, node) in l.free_u3.clone().enumerate() {
        let frame = now.frame_3().map_or(0.0, |frame| frame.at(node as f64 / last).rate);
        w.v3[node] = yp[l.u3 + k] + frame;
    }
}

fn copy<T: Scalar>(target: &mut [T], source: &[T], first: usize) {
    let len = target.len();
    target.copy_from_slice(&source[first..first + len]);
}

/// Adds the frame's motion to the free nodes and gives it to the driven ones.
fn carry<T: Scalar>(frame: &Frame, inertia: bool, free: &Range<usize>, last: usize, [u, v, a]: [&mut Vec<T>; 3]) {
    for node in 0..=last {
        let jet = frame.at(node as f64 / last as f64);
        let acceleration = if inertia { jet.acceleration } else { 0.0 };
        if free.contains(&node) {
            u[node] += T::constant(jet.value);
            v[node] += T::constant(jet.rate);
            a[node] += T::constant(acceleration);
        } else {
            u[node] = T::constant(jet.value);
            v[node] = T::constant(jet.rate);
            a[node] = T::constant(acceleration);
        }
    }
}
