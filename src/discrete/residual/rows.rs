//! The equations, one block after the other.

use super::fluid::{bridge_drops, pressure_at};
use crate::discrete::fluid_mesh::MeshBridge;
use crate::discrete::{System, TimeData, Workspace};
use crate::model::{Kinematics, PoolKind};
use crate::numerics::Scalar;

/// `[E14]` Momentum of each node (A.5), in the conservative form telescoping:
///
/// ```text
/// m h_i a_i = h_i (b_i - c v_i) + n_{i+1/2} - n_{i-1/2} (+ end force) (+ c_i, published)
/// ```
///
/// `[E27]` Without axial inertia the beam is carried along by its frame, [E22], and its waves are left out; inertia of the
/// sections' rotation is then that of `m y11 |d3_t|²/2`, whose parts along x and z are apart:
///
/// ```text
/// m h_i U_i'' = h_i (b_z,i - c v3_i) + n_z,i+1/2 - n_z,i-1/2        n_x gains m y11 x'_tt, n_z nothing
/// ```
///
/// The force `-m U''` does work on displacements relative to the frame: `P_ends` gains `-Σ h_i m U_i'' (v3_i - U_i')`, and the
/// kinetic energy along is that of the frame, `Σ h_i m U_i'²/2`.
pub fn momentum<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let (l, mesh) = (&system.layout, &system.mesh);
    let section = &system.model.section;
    let last = mesh.nodes - 1;
    let published = system.model.published();
    let across = system.model.kinematics != Kinematics::Bar;
    let row_1 = if l.waves[0] { l.v1 } else { l.u1 };
    let row_3 = if l.waves[1] { l.v3 } else { l.u3 };
    for i in 0..=last {
        let length = mesh.node_length(i);
        let (mut fx, mut fz) = (T::zero(), T::constant(length * now.force_z[i]));
        if i < last {
            fz += w.sz[i];
        }
        if i > 0 {
            fz -= w.sz[i - 1];
        }
        if across {
            fx = T::constant(length * now.force_x[i]);
            if i < last {
                fx += w.sx[i];
            }
            if i > 0 {
                fx -= w.sx[i - 1];
            }
        }
        if i == 0 || i == last {
            let (ex, ez) = end_force(system, now, w, i);
            fx += ex;
            fz += ez;
        }
        if published {
            let (cx, cz) = published_force(system, w, i);
            fx += cx;
            fz += cz;
        }
        if section.drag > 0.0 {
            fx -= w.v1[i] * (length * section.drag);
            fz -= w.v3[i] * (length * section.drag);
        }
        let mass = section.mass_per_length * length;
        if l.free_u1.contains(&i) {
            let index = row_1 + i - l.free_u1.start;
            r[index] = if l.inertia { w.a1[i] * mass - fx } else { -fx };
        }
        if l.free_u3.contains(&i) {
            let index = row_3 + i - l.free_u3.start;
            r[index] = if l.inertia { w.a3[i] * mass - fz } else { -fz };
        }
    }
}

/// Force given at an end node: dead, plus follower section forces `N e_t + V e_n` at the end's angle (A.53, A.54),
/// which act on the body with the sign of the outward section.
pub fn end_force<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> (T, T) {
    let last = system.mesh.nodes - 1;
    let end = &now.ends[usize::from(node == last)];
    let (mut fx, mut fz) = (T::constant(end.force_x), T::constant(end.force_z));
    if let Some((normal, shear)) = end.follower {
        let outward = if node == last { 1.0 } else { -1.0 };
        let (tx, tz) = match system.model.kinematics {
            Kinematics::FiniteRotation => end_tangent(system, now, w, node),
            // n_x = g N φ - V, n_z = N, as [E26] has it in every section.
            kinematics => {
                let turned = kinematics == Kinematics::SmallRotation;
                let angle = if turned {
                    end_angle(system, now, w, node)
                } else {
                    T::zero()
                };
                fx += angle * (outward * normal) + -outward * shear;
                fz += T::constant(outward * normal);
                return (fx, fz);
            }
        };
        fx += tx * (outward * normal) - tz * (outward * shear);
        fz += tz * (outward * normal) + tx * (outward * shear);
    }
    (fx, fz)
}

/// Unit tangent at an end: prescribed, or `φ_0 = φ_{1/2} + (h/2) κ_0`, `φ_n = φ_{n-1/2} - (h/2) κ_n`.
pub fn end_tangent<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> (T, T) {
    let last = system.mesh.nodes - 1;
    let at_tip = node == last;
    if let Some(slope) = now.ends[usize::from(at_tip)].slope {
        let (sine, cosine) = slope.value.sin_cos();
        return (T::constant(sine), T::constant(cosine));
    }
    let cell = if at_tip { last - 1 } else { 0 };
    let half = if at_tip { -0.5 } else { 0.5 } * system.mesh.h;
    let (sine, cosine) = (w.kappa[node] * half).sin_cos();
    (
        w.tx[cell] * cosine + w.tz[cell] * sine,
        w.tz[cell] * cosine - w.tx[cell] * sine,
    )
}

/// Angle at an end of a beam that turns little, as [`end_tangent`] has it.
fn end_angle<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> T {
    let at_tip = node + 1 == system.mesh.nodes;
    if let Some(slope) = now.ends[usize::from(at_tip)].slope {
        return T::constant(slope.value);
    }
    let half = 0.5 * system.mesh.h;
    if at_tip {
        w.d3x[node - 1] - w.kappa[node] * half
    } else {
        w.d3x[0] + w.kappa[0] * half
    }
}

/// `[E15]` What the published form adds to the conservative one at a node:
///
/// ```text
/// c_i = h_i (κ_i - M_i/EI) (V^ e_t(φ^) - N^ e_n(φ^))        ^ mean of the neighbouring cells
/// ```
pub fn published_force<T: Scalar>(system: &System, w: &Workspace<T>, i: usize) -> (T, T) {
    let last = system.mesh.nodes - 1;
    let (a, b) = if i == 0 {
        (0, 0)
    } else if i == last {
        (last - 1, last - 1)
    } else {
        (i - 1, i)
    };
    let (mut tx, mut tz) = (w.tx[a] + w.tx[b], w.tz[a] + w.tz[b]);
    let scale = T::constant(1.0) / (tx.squared() + tz.squared()).sqrt();
    tx = tx * scale;
    tz = tz * scale;
    let mut normal = (w.force[a] + w.force[b]) * 0.5;
    if system.damped {
        normal += (w.viscous_force[a] + w.viscous_force[b]) * 0.5;
    }
    let shear = (w.shear[a] + w.shear[b]) * 0.5;
    let excess =
        (w.kappa[i] - w.moment[i] * (1.0 / system.model.section.bending_stiffness)) * system.mesh.node_length(i);
    (excess * (shear * tx + normal * tz), excess * (shear * tz - normal * tx))
}

/// `u' = v`, where velocities are unknowns.
pub fn motion<T: Scalar>(system: &System, y: &[T], yp: &[T], r: &mut [T]) {
    let l = &system.layout;
    let lines = [
        (l.u1, l.v1, &l.free_u1, l.waves[0]),
        (l.u3, l.v3, &l.free_u3, l.waves[1]),
    ];
    for (u, v, nodes, _) in lines.into_iter().filter(|(.., waves)| *waves) {
        for k in 0..nodes.len() {
            r[u + k] = yp[u + k] - y[v + k];
        }
    }
}

/// `[E16]` Means over each segment, with the weights whose transpose spreads the pressure strains:
///
/// ```text
/// Mbar_j = Σ w_ji M_i    w = (1/2, 1, .., 1, 1/2)/K        Nbar_j = mean of N over the cells
/// ```
pub fn means<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let Some(wet) = &system.model.wet else { return };
    let (l, mesh) = (&system.layout, &system.mesh);
    for j in 0..mesh.segments {
        if wet.takes_moments {
            r[l.mean_moment + j] = w.mean_moment[j] - mean_moment(system, w, j);
        }
        if wet.takes_forces {
            r[l.mean_force + j] = w.mean_force[j] - mean_force(system, w, j);
        }
    }
}

/// `Mbar` of a segment.
pub fn mean_moment<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let mut moment = T::zero();
    for i in 0..=k {
        moment += w.moment[segment * k + i] * system.mesh.moment_weight(i);
    }
    moment
}

/// `Nbar` of a segment.
pub fn mean_force<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let mut force = T::zero();
    for c in segment * k..(segment + 1) * k {
        force += w.force[c];
    }
    force * (1.0 / k as f64)
}

/// `[E17]` Storage of each cell, `ds da/dt = inflow` (A.13).
pub fn storage<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let Some(fluid) = &system.fluid else { return };
    let mut row = system.layout.area;
    for run in &fluid.runs {
        for cell in run.clone() {
            r[row] = w.area_rate[cell] * fluid.ds - w.inflow[cell];
            row += 1;
        }
    }
}

/// Volume of each pool whose pressure is unknown, `[E25]`.
pub fn pools<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &Workspace<T>, r: &mut [T]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let l = &system.layout;
    for (k, pool) in wet.pools.iter().enumerate() {
        let Some(row) = l.pool_pressure[k] else { continue };
        let mut areas = T::zero();
        for &bladder in &pool.bladders {
            areas += w.area[fluid.cells_of(bladder).start];
        }
        let volume = areas * wet.bladder_length;
        r[row] = match (&pool.kind, l.pool_volume[k]) {
            (PoolKind::Fed(sources), Some(unknown)) => {
                let inflow: f64 = sources.iter().map(|&s| now.source_flow[s]).sum();
                r[unknown] = yp[unknown] - T::constant(inflow);
                volume - y[unknown]
            }
            _ => volume - T::constant(fluid.volume_at_start[k]),
        };
    }
}

/// Flows into a junction sum to zero.
pub fn junctions<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    for (k, &inflow) in w.junction_inflow.iter().enumerate() {
        r[system.layout.junction + k] = inflow;
    }
}

/// `[E18]` What flows through the valves of a bridge flows through its turbine:
/// `q_v((d - w)/2) + q_v((-d - w)/2) = G w`.
pub fn bridges<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    for (k, &MeshBridge { number, from, to }) in fluid.bridges.iter().enumerate() {
        let bridge = &wet.network.bridges[number];
        let (forward, backward) = bridge_drops(pressure_at(from, now, w) - pressure_at(to, now, w), w.bridge[k]);
        let through = w.bridge[k] * wet.network.turbines[bridge.turbine].conductance;
        r[system.layout.bridge + k] = bridge.valve.flow(forward) + bridge.valve.flow(backward) - through;
    }
}
