//! Momentum balance of nodes, and the forces on them.

use super::bending::elastic_curvature;
use super::solid::angle_of_end;
use super::{ambient_fluid, rotating_frame};
use crate::discrete::attached::at_node;
use crate::discrete::ledger::EnergyRate;
use crate::discrete::mesh::BeamEnd;
use crate::discrete::{System, TimeData, Workspace, beam_contacts, bodies, contact_points};
use crate::model::Kinematics;
use crate::numerics::{Planar, Scalar, wide};

/// `[E14]` Momentum of each node (A.5); the conservative form telescopes:
///
/// ```text
/// m h_i a_i = h_i (b_i - c v_i) + n_{i+1/2} - n_{i-1/2} (+ end force) (+ c_i, published)
/// ```
///
/// `[E27]` Without axial inertia the beam moves axially with its frame, [E22], without axial waves. The rotary inertia of sections is
/// then that of `m y11 |d3_t|²/2`, whose parts in x and z are independent:
///
/// ```text
/// m h_i U_i'' = h_i (b_z,i - c v3_i) + n_z,i+1/2 - n_z,i-1/2        n_x gains m y11 x'_tt, n_z nothing
/// ```
///
/// The force `-m U''` does work on displacements relative to the frame: `P_ends` gains `-Σ h_i m U_i'' (v3_i - U_i')`. The kinetic energy
/// of axial motion is that of the frame, `Σ h_i m U_i'²/2`.
pub fn momentum<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    if system.stands_alone && system.layout.inertia {
        wide!(inner_momentum::<T, 0>(system, now, w, r));
        wide!(inner_momentum::<T, 1>(system, now, w, r));
        for (_, end) in system.mesh.ends() {
            node_momentum(system, now, w, end.node, r);
        }
    } else {
        for node in 0..system.mesh.nodes {
            node_momentum(system, now, w, node, r);
        }
    }
}

/// Momentum balance of one node.
fn node_momentum<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, i: usize, r: &mut [T]) {
    let (l, mesh) = (&system.layout, &system.mesh);
    let mut f = Planar::zero();
    outer_forces(system, now, w, i, |_, force| f += force);
    if i + 1 < mesh.nodes {
        f += w.forces.section[i];
    }
    if i > 0 {
        f -= w.forces.section[i - 1];
    }
    let mass = system.masses[i];
    for (axis, line) in l.lines.iter().enumerate() {
        if let Some(row) = line.momentum(i) {
            r[row] = if l.inertia {
                w.motion.a[i][axis] * mass - f[axis]
            } else {
                -f[axis]
            };
        }
    }
}

/// Momentum balance of all inner nodes in one direction, for a beam with inertia on which only loads, ends and sections
/// act.
#[inline(always)]
fn inner_momentum<T: Scalar, const AXIS: usize>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let (mesh, line) = (&system.mesh, &system.layout.lines[AXIS]);
    let nodes = line.free.start.max(1)..line.free.end.min(mesh.nodes - 1);
    let Some(row) = line.momentum(nodes.start).filter(|_| !nodes.is_empty()) else {
        return;
    };
    let count = nodes.len();
    let r = &mut r[row..][..count];
    let (given, mass) = (&now.force[nodes.clone()], &system.masses[nodes.clone()]);
    let lengths = &mesh.node_lengths[nodes.clone()];
    let (a, after) = (&w.motion.a[nodes.clone()], &w.forces.section[nodes.clone()]);
    let before = &w.forces.section[nodes.start - 1..][..count];
    let added = w.forces.formulation.get(nodes);
    for k in 0..count {
        let mut f = T::constant(given[k][AXIS] * lengths[k]);
        if let Some(added) = added {
            f += added[k][AXIS];
        }
        f += after[k][AXIS];
        f -= before[k][AXIS];
        r[k] = a[k][AXIS] * mass[k] - f;
    }
}

/// Forces on a node other than section forces, each with the entry of the energy balance that contains its work, [E19]; none for stored
/// energy, [E49].
#[inline(always)]
pub fn outer_forces<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
    mut each: impl FnMut(Option<EnergyRate>, Planar<T>),
) {
    let length = system.mesh.node_lengths[node];
    let mut given = Planar::constant(now.force[node] * length);
    if let Some((end, _)) = system.mesh.end_at(node) {
        given += end_force(system, now, w, end, node);
    }
    each(Some(EnergyRate::Loads), given);
    if let Some(added) = w.forces.formulation.get(node) {
        each(Some(EnergyRate::Formulation), *added);
    }
    if system.stands_alone {
        return;
    }
    ambient_fluid::forces(system, now, w, node, system.lengths[node], &mut each);
    if let Some(size) = now.follower.get(node) {
        let force = follower(
            system,
            [size.z * length, size.x * length],
            || ambient_fluid::node_tangent(system, w, node),
            || node_angle(w, node),
        );
        each(Some(EnergyRate::Loads), force);
    }
    if let Some(force) = rotating_frame::force(system, now, w, node) {
        each(Some(EnergyRate::Loads), force);
    }
    if let Some(&[across, along]) = system.foundation.get(node) {
        let u = w.motion.u[node];
        each(None, Planar::new(u.x * -across, u.z * -along));
    }
    for (attached, weight) in at_node(&system.attached, node) {
        let given = attached.given(system, now, w);
        each(Some(EnergyRate::Loads), given * weight);
        each(None, attached.spring(w) * weight);
        each(Some(EnergyRate::Damping), attached.dashpot(w) * weight);
    }
    if !system.bodies.is_empty() {
        bodies::forces(system, now, w, node, &mut each);
    }
    beam_contacts::on_node(w, node, &mut each);
    if !system.touching.is_empty() {
        contact_points::forces(system, w, node, &mut each);
    }
}

/// Given force at an end node: the dead force plus follower section forces `N e_t + V e_n` at the end's angle (A.53,
/// A.54), which act on the body with the sign of the outward section.
pub fn end_force<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, end: usize, node: usize) -> Planar<T> {
    let at_tip = end % 2 == 1;
    let end = &now.ends[end];
    let dead = Planar::constant(end.force);
    let Some((normal, shear)) = end.follower else {
        return dead;
    };
    let outward = if at_tip { 1.0 } else { -1.0 };
    let (normal, shear) = (outward * normal, outward * shear);
    let own = follower(
        system,
        [normal, shear],
        || end_tangent(system, now, w, node),
        || end_angle(system, now, w, node),
    );
    dead + own
}

/// Force `N e_t + V e_n` at a place with this tangent, or, for small rotations, this angle.
#[inline]
pub fn follower<T: Scalar>(
    system: &System,
    [normal, shear]: [f64; 2],
    tangent: impl FnOnce() -> Planar<T>,
    angle: impl FnOnce() -> T,
) -> Planar<T> {
    match system.model.kinematics {
        Kinematics::FiniteRotation => {
            let tangent = tangent();
            tangent * normal + tangent.normal() * shear
        }
        // n_x = g N φ - V, n_z = N, as in every section by [E26].
        Kinematics::SmallRotation => Planar::new(angle() * normal - shear, T::constant(normal)),
        Kinematics::Linear | Kinematics::Bar => Planar::constant(Planar { x: -shear, z: normal }),
    }
}

/// The end at a node.
fn end_of(system: &System, node: usize) -> (usize, BeamEnd) {
    let first = (0, system.mesh.beams[0].ends()[0]);
    system.mesh.end_at(node).unwrap_or(first)
}

/// Unit tangent at an end: prescribed, or `φ_0 = φ_{1/2} + (h/2) κ_0`, `φ_n = φ_{n-1/2} - (h/2) κ_n`.
pub fn end_tangent<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let (k, end) = end_of(system, node);
    if let Some([angle, _]) = angle_of_end(&now.ends[k], &w.shape.joints.angle, &[]) {
        return Planar::tangent(angle);
    }
    let half = 0.5 * end.outward * system.mesh.lengths[end.cell];
    tangent_beyond(w, end.cell, node, half)
}

/// Angle of a node for small rotations: mean of its cells.
#[inline]
fn node_angle<T: Scalar>(w: &Workspace<T>, node: usize) -> T {
    let cells = [node.saturating_sub(1), node.min(w.shape.d3.len() - 1)];
    let [a, b] = cells.map(|cell| w.shape.d3[cell].x);
    (a + b) * 0.5
}

/// Unit tangent at a distance `by` from the midpoint of a cell, towards or away from a node at one of its ends: `φ = φ_c - by κ_node`.
#[inline]
pub fn tangent_beyond<T: Scalar>(w: &Workspace<T>, cell: usize, node: usize, by: f64) -> Planar<T> {
    if let Some(angle) = w.shape.sections.angle.get(cell) {
        return Planar::tangent(*angle - w.shape.kappa[node] * by);
    }
    let (sine, cosine) = (w.shape.kappa[node] * -by).sin_cos();
    let tangent = w.shape.tangent[cell];
    tangent.times(cosine) - tangent.normal().times(sine)
}

/// Angle at the same place for small rotations.
#[inline]
pub fn angle_beyond<T: Scalar>(w: &Workspace<T>, cell: usize, node: usize, by: f64) -> T {
    let angle = w.shape.sections.angle.get(cell).copied();
    angle.unwrap_or(w.shape.d3[cell].x) - w.shape.kappa[node] * by
}

/// Angle at an end for small rotations, corresponding to [`end_tangent`].
fn end_angle<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> T {
    let (k, end) = end_of(system, node);
    if let Some([angle, _]) = angle_of_end(&now.ends[k], &w.shape.joints.angle, &[]) {
        return angle;
    }
    angle_beyond(w, end.cell, node, 0.5 * end.outward * system.mesh.lengths[end.cell])
}

/// `[E15]` Forces of the published form in addition to the conservative one, at nodes:
///
/// ```text
/// c_i = h_i (κ_i - M_i/EI) (V^ e_t(φ^) - N^ e_n(φ^))        ^ mean of the neighbouring cells
/// ```
pub fn published_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if !system.model.published() {
        return;
    }
    let mut added = std::mem::take(&mut w.forces.formulation);
    added.fill(Planar::zero());
    // starts with normal and shear forces at nodes
    let forces = &w.forces;
    let mut normal = [&forces.normal[..], &[], &forces.relaxing_normal];
    if system.damped {
        normal[1] = &forces.viscous_normal;
    }
    for part in normal {
        add_means(part, &mut added, |at_node| &mut at_node.x);
    }
    add_means(&forces.shear, &mut added, |at_node| &mut at_node.z);
    if system.mesh.fourth {
        let excess = |i: usize| w.shape.kappa[i] - elastic_curvature(system, now, w, i);
        wide!(turn_excess(system, &w.shape.tangent, excess, &mut added));
    } else {
        let ei = &system.sections.bending[..added.len()];
        let (kappa, moment) = (&w.shape.kappa[..added.len()], &forces.moment[..added.len()]);
        let excess = |i: usize| kappa[i] - moment[i] * (1.0 / ei[i]);
        wide!(turn_excess(system, &w.shape.tangent, excess, &mut added));
    }
    w.forces.formulation = added;
}

/// Adds to nodes the means of the adjacent cells' values, if there are any.
#[inline(always)]
fn add_means<T: Scalar>(cells: &[T], nodes: &mut [Planar<T>], into: impl Fn(&mut Planar<T>) -> &mut T) {
    let (Some((first, last)), [root, inner @ .., tip]) = (cells.first().zip(cells.last()), nodes) else {
        return;
    };
    *into(root) += *first;
    *into(tip) += *last;
    for (node, pair) in inner.iter_mut().zip(cells.windows(2)) {
        *into(node) += (pair[0] + pair[1]) * 0.5;
    }
}

/// Converts `(N^, V^)` to the force of [`published_forces`], with the factor `κ_i - M_i/EI`.
#[inline(always)]
fn turn_excess<T: Scalar>(
    system: &System,
    tangent: &[Planar<T>],
    excess: impl Fn(usize) -> T,
    added: &mut [Planar<T>],
) {
    let last = added.len() - 1;
    let (tangent, lengths) = (&tangent[..last], &system.lengths[..=last]);
    for i in 1..last {
        let tangents = [tangent[i - 1], tangent[i]];
        added[i] = across_and_along(added[i], tangents).times(excess(i) * lengths[i]);
    }
    for (end, cell) in [(0, 0), (last, last - 1)] {
        added[end] = across_and_along(added[end], [tangent[cell]; 2]).times(excess(end) * lengths[end]);
    }
}

/// `V^ e_t(φ^) - N^ e_n(φ^)` from `(N^, V^)`.
#[inline(always)]
fn across_and_along<T: Scalar>(both: Planar<T>, tangents: [Planar<T>; 2]) -> Planar<T> {
    let tangent = ambient_fluid::mean_direction(tangents);
    tangent.times(both.z) - tangent.normal().times(both.x)
}
