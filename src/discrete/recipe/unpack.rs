//! From the vector of unknowns to displacements, velocities, means and areas; driven ends filled in.

use crate::case::signals::Jet;
use crate::discrete::{Instant, System, Workspace};
use crate::model::Scalar;

/// Copies the state into the workspace; what an end prescribes comes from its signal, with exact rates.
pub fn unpack<T: Scalar>(system: &System, now: &Instant, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    let l = &system.layout;
    let copy = |target: &mut [T], source: &[T], first: usize| {
        let len = target.len();
        target.copy_from_slice(&source[first..first + len]);
    };
    let (free_1, free_3) = (l.free_u1.clone(), l.free_u3.clone());
    copy(&mut w.u1[free_1.clone()], y, l.u1);
    copy(&mut w.u3[free_3.clone()], y, l.u3);
    if l.inertia {
        copy(&mut w.v1[free_1.clone()], y, l.v1);
        copy(&mut w.v3[free_3.clone()], y, l.v3);
        copy(&mut w.a1[free_1], yp, l.v1);
        copy(&mut w.a3[free_3], yp, l.v3);
    } else {
        copy(&mut w.v1[free_1], yp, l.u1);
        copy(&mut w.v3[free_3], yp, l.u3);
    }
    let last = system.mesh.nodes - 1;
    for (node, end) in [(0, &now.ends[0]), (last, &now.ends[1])] {
        if let Some(jet) = end.u1 {
            drive(jet, l.inertia, node, &mut w.u1, &mut w.v1, &mut w.a1);
        }
        if let Some(jet) = end.u3 {
            drive(jet, l.inertia, node, &mut w.u3, &mut w.v3, &mut w.a3);
        }
    }
    if system.fluid.is_some() {
        copy(&mut w.mean_moment, y, l.mean_moment);
        copy(&mut w.mean_force, y, l.mean_force);
        copy(&mut w.area, y, l.area);
        copy(&mut w.area_rate, yp, l.area);
        copy(&mut w.junction, y, l.junction);
        copy(&mut w.bridge, y, l.bridge);
    }
}

fn drive<T: Scalar>(jet: Jet, inertia: bool, node: usize, u: &mut [T], v: &mut [T], a: &mut [T]) {
    u[node] = T::constant(jet.value);
    v[node] = T::constant(jet.rate);
    a[node] = T::constant(if inertia { jet.acceleration } else { 0.0 });
}
