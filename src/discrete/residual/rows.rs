//! The equations, one block after the other.

use super::around::{self, node_tangent};
use super::fluid::{driving, over_bridge};
use super::fourth;
use crate::discrete::attached::at_node;
use crate::discrete::fluid_mesh::{MeshBridge, MeshFlow, MeshLink, Place};
use crate::discrete::ledger::EnergyRate;
use crate::discrete::{System, TimeData, Workspace, bodies, let_in, touching};
use crate::model::network::Feed;
use crate::model::{Kinematics, LumpedKind};
use crate::numerics::{Planar, Scalar};

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
    let last = mesh.nodes - 1;
    for i in 0..=last {
        let mut f = Planar::zero();
        outer_forces(system, now, w, i, |_, force| f += force);
        if i < last {
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
}

/// What acts on a node besides its sections, each force with the account of the balance of energy that its work goes to, [E19]; none
/// where it is stored, [E49].
#[inline(always)]
pub fn outer_forces<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    node: usize,
    mut each: impl FnMut(Option<EnergyRate>, Planar<T>),
) {
    let length = system.mesh.node_length(node);
    let mut given = Planar::constant(now.force[node] * length);
    if node == 0 || node == system.mesh.nodes - 1 {
        given += end_force(system, now, w, node);
    }
    each(Some(EnergyRate::Loads), given);
    if system.model.published() {
        each(Some(EnergyRate::Formulation), published_force(system, now, w, node));
    }
    if system.stands_alone {
        return;
    }
    around::forces(system, now, w, node, system.lengths[node], &mut each);
    for (attached, weight) in at_node(&system.attached, node) {
        let given = attached.given(system, now, w);
        each(Some(EnergyRate::Loads), given * weight);
        each(None, attached.spring(w) * weight);
        each(Some(EnergyRate::Damping), attached.dashpot(w) * weight);
    }
    if !system.bodies.is_empty() {
        bodies::forces(system, w, node, |force| each(None, force));
    }
    if !system.touching.is_empty() {
        touching::forces(system, w, node, &mut each);
    }
}

/// Force given at an end node: dead, plus follower section forces `N e_t + V e_n` at the end's angle (A.53, A.54),
/// which act on the body with the sign of the outward section.
pub fn end_force<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let last = system.mesh.nodes - 1;
    let end = &now.ends[usize::from(node == last)];
    let dead = Planar::constant(end.force);
    let Some((normal, shear)) = end.follower else {
        return dead;
    };
    let outward = if node == last { 1.0 } else { -1.0 };
    let (normal, shear) = (outward * normal, outward * shear);
    let own = follower(
        system,
        [normal, shear],
        || end_tangent(system, now, w, node),
        || end_angle(system, now, w, node),
    );
    dead + own
}

/// `N e_t + V e_n` at a place with this tangent, or this angle of a beam that turns little.
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
        // n_x = g N φ - V, n_z = N, as [E26] has it in every section.
        Kinematics::SmallRotation => Planar::new(angle() * normal - shear, T::constant(normal)),
        Kinematics::Linear | Kinematics::Bar => Planar::constant(Planar { x: -shear, z: normal }),
    }
}

/// Unit tangent at an end: prescribed, or `φ_0 = φ_{1/2} + (h/2) κ_0`, `φ_n = φ_{n-1/2} - (h/2) κ_n`.
pub fn end_tangent<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> Planar<T> {
    let last = system.mesh.nodes - 1;
    let at_tip = node == last;
    if let Some(slope) = now.ends[usize::from(at_tip)].slope {
        return Planar::constant(Planar::tangent(slope.value));
    }
    let cell = if at_tip { last - 1 } else { 0 };
    let half = if at_tip { 0.5 } else { -0.5 } * system.mesh.h;
    tangent_beyond(w, cell, node, half)
}

/// Unit tangent `by` beyond the midpoint of a cell, towards or away from a node at one of its ends: `φ = φ_c - by κ_node`.
#[inline]
pub fn tangent_beyond<T: Scalar>(w: &Workspace<T>, cell: usize, node: usize, by: f64) -> Planar<T> {
    if let Some(angle) = w.shape.sections.angle.get(cell) {
        return Planar::tangent(*angle - w.shape.kappa[node] * by);
    }
    let (sine, cosine) = (w.shape.kappa[node] * -by).sin_cos();
    let tangent = w.shape.tangent[cell];
    tangent.times(cosine) - tangent.normal().times(sine)
}

/// The same angle of a beam that turns little.
#[inline]
pub fn angle_beyond<T: Scalar>(w: &Workspace<T>, cell: usize, node: usize, by: f64) -> T {
    let angle = w.shape.sections.angle.get(cell).copied();
    angle.unwrap_or(w.shape.d3[cell].x) - w.shape.kappa[node] * by
}

/// Angle at an end of a beam that turns little, as [`end_tangent`] has it.
fn end_angle<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> T {
    let at_tip = node + 1 == system.mesh.nodes;
    if let Some(slope) = now.ends[usize::from(at_tip)].slope {
        return T::constant(slope.value);
    }
    let (cell, half) = if at_tip { (node - 1, 0.5) } else { (0, -0.5) };
    angle_beyond(w, cell, node, half * system.mesh.h)
}

/// `[E15]` What the published form adds to the conservative one at a node:
///
/// ```text
/// c_i = h_i (κ_i - M_i/EI) (V^ e_t(φ^) - N^ e_n(φ^))        ^ mean of the neighbouring cells
/// ```
#[inline]
pub fn published_force<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, i: usize) -> Planar<T> {
    let last = system.mesh.nodes - 1;
    let (a, b) = (i.saturating_sub(1), i.min(last - 1));
    let (forces, tangent) = (&w.forces, node_tangent(system, w, i));
    let mut normal = (forces.normal[a] + forces.normal[b]) * 0.5;
    if system.damped {
        normal += (forces.viscous_normal[a] + forces.viscous_normal[b]) * 0.5;
    }
    if let (Some(left), Some(right)) = (forces.relaxing_normal.get(a), forces.relaxing_normal.get(b)) {
        normal += (*left + *right) * 0.5;
    }
    let shear = (forces.shear[a] + forces.shear[b]) * 0.5;
    let elastic = if system.mesh.fourth {
        fourth::elastic_curvature(system, now, w, i)
    } else {
        forces.moment[i] * (1.0 / system.model.section.bending_stiffness)
    };
    let excess = (w.shape.kappa[i] - elastic) * system.lengths[i];
    (tangent.times(shear) - tangent.normal().times(normal)).times(excess)
}

/// `u' = v`, where velocities are unknowns.
pub fn motion<T: Scalar>(system: &System, y: &[T], yp: &[T], r: &mut [T]) {
    for (u, v) in system.layout.moved_blocks() {
        for ((r, rate), velocity) in r[u.clone()].iter_mut().zip(&yp[u]).zip(&y[v]) {
            *r = *rate - *velocity;
        }
    }
}

/// `[E16]` Means over each segment, with the weights whose transpose spreads the pressure strains:
///
/// ```text
/// Mbar_j = Σ w_ji M_i    w = (1/2, 1, .., 1, 1/2)/K        Nbar_j = mean of N over the cells
/// ```
pub fn means<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let own = &system.layout.coupling;
    for (j, row) in own.mean_moment.clone().enumerate() {
        r[row] = w.coupling.mean_moment[j] - mean_moment(system, w, j);
    }
    for (j, row) in own.mean_force.clone().enumerate() {
        r[row] = w.coupling.mean_force[j] - mean_force(system, w, j);
    }
}

/// `Mbar` of a segment.
pub fn mean_moment<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    mean_of_nodes(system, &w.forces.moment, segment)
}

/// Mean over a segment of what stands at nodes, with the weights of [`means`].
pub fn mean_of_nodes<T: Scalar>(system: &System, values: &[T], segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let mut mean = T::zero();
    for i in 0..=k {
        mean += values[segment * k + i] * system.mesh.moment_weight(i);
    }
    mean
}

/// `Nbar` of a segment.
pub fn mean_force<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let mut force = T::zero();
    for c in segment * k..(segment + 1) * k {
        force += w.forces.normal[c];
    }
    force * (1.0 / k as f64)
}

/// `[E17]` Storage of each cell, `ds da/dt = inflow` (A.13).
pub fn storage<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let Some(fluid) = &system.fluid else { return };
    let mut row = system.layout.network.area.start;
    for run in &fluid.runs {
        for cell in run.clone() {
            r[row] = w.fluid.area_rate[cell] * fluid.ds - w.fluid.inflow[cell];
            row += 1;
        }
    }
}

/// Volume of each lumped network whose pressure is unknown, `[E25]`; that of a network that is fed is unknown but for what ports of
/// prescribed volume have let in. The integrals of their rates, which nothing follows from, go along.
pub fn lumped<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &Workspace<T>, r: &mut [T]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    let l = &system.layout.network;
    for &(unknown, source) in &l.let_in {
        r[unknown] = yp[unknown] - T::constant(now.source_flow[source]);
    }
    for (k, lumped) in wet.lumped.iter().enumerate() {
        let Some(row) = l.lumped_pressure[k] else { continue };
        let mut areas = T::zero();
        for &bladder in &lumped.bladders {
            areas += w.fluid.area[fluid.cells_of(bladder).start];
        }
        let volume = areas * wet.bladder_length;
        r[row] = match (&lumped.kind, l.lumped_volume[k]) {
            (LumpedKind::Fed(sources), Some(unknown)) => {
                let pumped = |&s: &usize| match wet.network.sources[s].feed {
                    Feed::Flow(_) => now.source_flow[s],
                    Feed::Volume(_) => 0.0,
                };
                r[unknown] = yp[unknown] - T::constant(sources.iter().map(pumped).sum());
                volume - y[unknown] - T::constant(let_in::into_lumped(wet, lumped, now)[0])
            }
            _ => volume - T::constant(fluid.volume_at_start[k]),
        };
    }
}

/// Flows into a junction sum to zero, into an accumulator to the rate of its volume. Where only tubes with inertia lead on from some junctions, the level of their
/// pressures follows from accelerations, and the sum over them keeps to zero by itself: `Σ q + Σ q'/ω = 0`, ω the characteristic frequency, in place of the first one's.
pub fn junctions<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let rows = system.layout.network.junction.clone();
    r[rows.clone()].copy_from_slice(&w.fluid.junction_inflow);
    let Some(fluid) = &system.fluid else { return };
    for (one, rate) in fluid.accumulators.iter().zip(&w.fluid.accumulated_rate) {
        let row = &mut r[rows.start + one.junction];
        *row = *rate - *row;
    }
    if fluid.flows == 0 {
        return;
    }
    let delay = 1.0 / system.model.scales.frequency;
    for (junction, first) in fluid.adrift.iter().enumerate() {
        if let Some(first) = first.filter(|&first| first != junction) {
            r[rows.start + first] += w.fluid.junction_inflow[junction];
        }
    }
    for link in &fluid.links {
        let Some(flow) = link.flow else { continue };
        for (place, sign) in [(link.from, -delay), (link.to, delay)] {
            if let Place::Junction(j) = place
                && let Some(first) = fluid.adrift[j]
            {
                r[rows.start + first] += w.fluid.moving_rate[flow.number] * sign;
            }
        }
    }
}

/// `[E66]` Flow of each tube in which it does not creep, [E51]. Where fluid is compressed it is written in `y = q/√r̄` and `k_i = j_i/√r̄`, r̄ and D of
/// [E64], viscosity and losses at the mean density:
///
/// ```text
/// √r̄ I dy/dt + Σ_i r_i (y - k_i)/√r̄ + Δp_loss(q)/r̄ + (R_half + R/o) Q = D      Q = y/√r̄      dk_i/dt = n_i (ν/r²) (y - k_i)/r̄
/// ```
///
/// so that what is stored, `I y²/2 + Σ r_i r² k_i²/(2 n_i ν)`, changes by `Q D` less what is lost, whatever the density does. Behind a check
/// valve it is the flow which [E7] lets through, `Q = q_v(R, Δ)`, written as `Q = q_v(R + κ, Δ + κ Q)`. With κ what inertia and the memory of
/// friction resist along an implicit step, the right-hand side does not depend on Q there, and Newton's iteration does not see the valve snap.
pub fn tubes<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let Some(fluid) = &system.fluid else { return };
    let own = &system.layout.network;
    for (k, link) in fluid.links.iter().enumerate() {
        let Some(MeshFlow { number, branch, law }) = link.flow else {
            continue;
        };
        let moving = w.fluid.moving[number];
        for (at, ladder) in law.ladders(branch).into_iter().flatten() {
            let own = own.branch.start + at.start..own.branch.start + at.end;
            let slips = w.fluid.branch_rate[at.clone()].iter().zip(&w.fluid.branch[at]);
            for ((row, (_, rate)), (&slips, &slipped)) in r[own].iter_mut().zip(ladder.branches()).zip(slips) {
                *row = slips - w.fluid.at_mean_density(k, (moving - slipped) * rate);
            }
        }
        let driven = driven(link, now, w, k);
        let volume = w.fluid.root_of_density(k).map_or(moving, |root| moving / root);
        r[own.flow.start + number] = match &link.check_valve {
            None => (volume * (link.half_cells + link.of_pump) - driven) * now.opening[k] + volume * link.resistance,
            Some(valve) => {
                let along = law.resistance_along_a_step(now.cj);
                volume - valve.flow_behind(1.0 / now.conductance[k] + along, driven + volume * along)
            }
        };
    }
}

/// What is left of what drives the flow of a tube that does not creep, for its check valve and all linear resistance [Pa].
#[inline]
pub fn driven<T: Scalar>(link: &MeshLink, now: &TimeData, w: &Workspace<T>, k: usize) -> T {
    let mut left = driving(link, now, w, k);
    let Some(MeshFlow { number, branch, law }) = link.flow else {
        return left;
    };
    left -= w.fluid.at_mean_density(k, law.loss(w.fluid.flow[k]));
    let root = w.fluid.root_of_density(k);
    if law.inertance > 0.0 {
        let accelerates = w.fluid.moving_rate[number] * law.inertance;
        left -= root.map_or(accelerates, |root| accelerates * root);
    }
    let mut lags = T::zero();
    for (at, ladder) in law.ladders(branch).into_iter().flatten() {
        for ((resistance, _), &slipped) in ladder.branches().zip(&w.fluid.branch[at]) {
            lags += (w.fluid.moving[number] - slipped) * resistance;
        }
    }
    left - root.map_or(lags, |root| lags / root)
}

/// `[E18]` What flows through the valves of a bridge flows through its turbine:
/// `q_v((d - w)/2) + q_v((-d - w)/2) = G w`.
pub fn bridges<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    for (k, &MeshBridge { number, .. }) in fluid.bridges.iter().enumerate() {
        let bridge = &wet.network.bridges[number];
        let ((forward, backward), _) = over_bridge(wet, fluid, k, now, w);
        let through = w.fluid.bridge[k] * wet.network.turbines[bridge.turbine].conductance;
        r[system.layout.network.bridge.start + k] = bridge.valve.flow(forward) + bridge.valve.flow(backward) - through;
    }
}
