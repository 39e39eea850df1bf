//! Equations other than momentum, block by block.

use super::fluid::{driving, over_bridge};
use crate::discrete::fluid_mesh::{LinkEnd, MeshBridge, MeshFlow, MeshLink};
use crate::discrete::{System, TimeData, Workspace, injected_volume};
use crate::model::LumpedKind;
use crate::model::network::Feed;
use crate::numerics::Scalar;

/// `u' = v`, for velocities that are unknowns.
pub fn motion<T: Scalar>(system: &System, y: &[T], yp: &[T], r: &mut [T]) {
    for (u, v) in system.layout.moved_blocks() {
        for ((r, rate), velocity) in r[u.clone()].iter_mut().zip(&yp[u]).zip(&y[v]) {
            *r = *rate - *velocity;
        }
    }
}

/// `[E16]` Means over each segment; the transpose of the weights distributes the strains by pressure:
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

/// Mean moment `Mbar` of a segment, about its own neutral axis.
pub fn mean_moment<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    let mut mean = mean_of_nodes(system, &w.forces.moment, segment);
    let own = system.mesh.cells_of(segment);
    // the segment is on the right of its beginning, and on the left of its end
    for (node, side) in [(own.start, 1), (own.end, 0)] {
        if let Some(border) = system.sections.offset_border(node) {
            let own = w.forces.side_moment[border][side];
            mean += (own - w.forces.moment[node]) * system.mesh.moment_weight(0);
        }
    }
    mean
}

/// Mean of nodal values over a segment, with the weights of [`means`].
pub fn mean_of_nodes<T: Scalar>(system: &System, values: &[T], segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let [at_edge, inside] = [0, 1].map(|i| system.mesh.moment_weight(i));
    let cells = system.mesh.cells_of(segment);
    let own = &values[cells.start..=cells.end];
    let mut mean = own[0] * at_edge;
    for value in &own[1..k] {
        mean += *value * inside;
    }
    mean + own[k] * at_edge
}

/// Mean normal force `Nbar` of a segment.
pub fn mean_force<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    let k = system.mesh.cells_per_segment;
    let mut force = T::zero();
    for c in system.mesh.cells_of(segment) {
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

/// Volume of each lumped network with unknown pressure, `[E25]`. The volume of a fed network is an unknown relative to the volume
/// injected by ports of prescribed volume. Also the integrals of these ports' flow rates, on which nothing else depends.
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
                volume - y[unknown] - T::constant(injected_volume::into_lumped(wet, lumped, now)[0])
            }
            _ => volume - T::constant(fluid.volume_at_start[k]),
        };
    }
}

/// Flows into a junction sum to zero, into an accumulator to the rate of its volume. In a group of junctions from which only tubes with
/// inertia lead, accelerations determine the pressure level. The equation of the first junction is then `Σ q + Σ q'/ω = 0` over the
/// group, with the characteristic frequency ω; it keeps the sum at zero.
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
    for &k in &fluid.sorted.others {
        let link = &fluid.links[k];
        let Some(flow) = link.flow else { continue };
        for (place, sign) in [(link.from, -delay), (link.to, delay)] {
            if let LinkEnd::Junction(j) = place
                && let Some(first) = fluid.adrift[j]
            {
                r[rows.start + first] += w.fluid.moving_rate[flow.number] * sign;
            }
        }
    }
}

/// `[E66]` Flow of each tube with non-creeping flow, [E51]. For a compressible fluid the unknowns are `y = q/√r̄` and `k_i = j_i/√r̄`,
/// with r̄ and D of [E64], viscosity and losses at the mean density:
///
/// ```text
/// √r̄ I dy/dt + Σ_i r_i (y - k_i)/√r̄ + Δp_loss(q)/r̄ + (R_half + R/o) Q = D      Q = y/√r̄      dk_i/dt = n_i (ν/r²) (y - k_i)/r̄
/// ```
///
/// so that the stored energy, `I y²/2 + Σ r_i r² k_i²/(2 n_i ν)`, changes by `Q D` less the losses for any density. With a check valve
/// the flow is that of [E7], `Q = q_v(R, Δ)`, written as `Q = q_v(R + κ, Δ + κ Q)`. κ is the resistance of inertia and friction memory
/// along an implicit step. Then the right-hand side does not depend on Q, and Newton's iteration is insensitive to the switching of the
/// valve.
pub fn tubes<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let Some(fluid) = &system.fluid else { return };
    let own = &system.layout.network;
    for &k in &fluid.sorted.others {
        let link = &fluid.links[k];
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
            None => {
                let opened = (volume * (link.half_cells + link.of_pump) - driven) * link.opening(now, w, k);
                opened + volume * link.resistance
            }
            Some(valve) => {
                let along = law.resistance_along_a_step(now.cj);
                let resistance = 1.0 / now.conductance[k] + along;
                volume - now.tangents.behind(k, valve, resistance, driven + volume * along)
            }
        };
    }
}

/// Remaining driving pressure of a tube with non-creeping flow, for its check valve and all linear resistances [Pa].
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

/// `[E18]` The flow through the valves of a bridge equals that through its turbine:
/// `q_v((d - w)/2) + q_v((-d - w)/2) = G w`.
pub fn bridges<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return;
    };
    for (k, &MeshBridge { number, .. }) in fluid.bridges.iter().enumerate() {
        let bridge = &wet.network.bridges[number];
        let (forward, backward) = now
            .tangents
            .through(k, &bridge.valve, over_bridge(wet, fluid, k, now, w).0);
        let through = w.fluid.bridge[k] * wet.network.turbines[bridge.turbine].conductance;
        r[system.layout.network.bridge.start + k] = forward + backward - through;
    }
}
