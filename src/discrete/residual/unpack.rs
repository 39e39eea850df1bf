//! Conversion of the unknowns to displacements, velocities, means and areas, including driven ends.

use std::ops::Range;

use crate::discrete::injected_volume::{self, InjectedShare, Store};
use crate::discrete::layout::LineLayout;
use crate::discrete::time_data::Frame;
use crate::discrete::workspace::Motion;
use crate::discrete::{System, TimeData, Workspace};
use crate::functions::signals::Jet;
use crate::model::LumpedKind;
use crate::numerics::{Planar, Scalar, wide};

/// Copies the state to the workspace. Prescribed values of ends come from their signals, with exact rates.
///
/// `[E22]` Unknown displacements are relative to the straight line through the prescribed motions of the ends:
///
/// ```text
/// u_i = U_i + y_i     v_i = U'_i + y'_i     U_i = u(0) + (u(l_s) - u(0)) θ_i/l_s, or that of the one driven end
/// ```
///
/// The integrator's error of a common motion thus cannot stretch the beam between an exactly driven node and its integrated neighbor.
///
/// Unknown contents of cells and accumulators are relative to their shares, by compliance C, of the volume V injected by ports of
/// prescribed volume:
///
/// ```text
/// Δs c_k = V C_k/ΣC + Δs y_k     Δs c'_k = V' C_k/ΣC + Δs y'_k
/// ```
///
/// The injected volume is thus exactly the signal, not an integral of its rate: without other flow in or out, `Σ Δs y` is constant. The
/// pressure of a lumped network, [E25], is relative to V/C in the same way.
pub fn unpack<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], w: &mut Workspace<T>) {
    let l = &system.layout;
    move_nodes(system, now, y, yp, &mut w.motion);
    copy(&mut w.shape.joints.angle, y, &l.joints.angle);
    copy(&mut w.shape.joints.rate, yp, &l.joints.angle);
    for (number, rate) in l.joints.rate.iter().enumerate() {
        if let Some(rate) = *rate {
            (w.shape.joints.rate[number], w.shape.joints.acceleration[number]) = (y[rate], yp[rate]);
        }
    }
    let joints = &mut w.shape.joints;
    system.joints.add_first(&mut joints.angle);
    system.joints.add_first(&mut joints.rate);
    system.joints.move_nodes(now, w);
    let sections = &mut w.shape.sections;
    copy(&mut sections.angle, y, &l.turning.angle);
    match &l.turning.rate {
        Some(rate) => {
            copy(&mut w.shape.angle_rate, y, rate);
            copy(&mut sections.acceleration, yp, rate);
        }
        None => copy(&mut w.shape.angle_rate, yp, &l.turning.angle),
    }
    copy(&mut w.relaxed.curvature, y, &l.relaxation.curvature);
    copy(&mut w.relaxed.curvature_rate, yp, &l.relaxation.curvature);
    copy(&mut w.relaxed.stretch, y, &l.relaxation.stretch);
    copy(&mut w.relaxed.stretch_rate, yp, &l.relaxation.stretch);
    copy(&mut w.relaxed.shear, y, &l.relaxation.shear);
    copy(&mut w.relaxed.shear_rate, yp, &l.relaxation.shear);
    if let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) {
        copy(&mut w.coupling.mean_moment, y, &l.coupling.mean_moment);
        copy(&mut w.coupling.mean_force, y, &l.coupling.mean_force);
        for (bladder, unknown) in l.coupling.excess() {
            w.coupling.excess_area[bladder] = y[unknown];
        }
        for (mean, &given) in w.coupling.mean_force.iter_mut().zip(&now.statics.mean) {
            *mean = T::constant(given);
        }
        let mut first = l.network.area.start;
        for run in &fluid.runs {
            let unknowns = first..first + run.len();
            w.fluid.area[run.clone()].copy_from_slice(&y[unknowns.clone()]);
            w.fluid.area_rate[run.clone()].copy_from_slice(&yp[unknowns.clone()]);
            first = unknowns.end;
        }
        for (k, one) in fluid.accumulators.iter().enumerate() {
            let unknown = l.network.junction.start + one.junction;
            (w.fluid.accumulated[k], w.fluid.accumulated_rate[k]) = (y[unknown], yp[unknown]);
        }
        for &InjectedShare { source, store, share } in &fluid.shares {
            let own = &mut w.fluid;
            let (held, rate) = match store {
                Store::Cell(c) => (&mut own.area[c], &mut own.area_rate[c]),
                Store::Vessel(k) => (&mut own.accumulated[k], &mut own.accumulated_rate[k]),
            };
            *held += T::constant(share * now.source_volume[source]);
            *rate += T::constant(share * now.source_flow[source]);
        }
        copy(&mut w.fluid.junction, y, &l.network.junction);
        if let Some(compression) = &wet.compression {
            for pressure in &mut w.fluid.junction {
                *pressure = compression.at_potential(*pressure);
            }
        }
        for (k, one) in fluid.accumulators.iter().enumerate() {
            w.fluid.junction[one.junction] = wet.vessel_pressure(&one.law, w.fluid.accumulated[k]);
        }
        copy(&mut w.fluid.bridge, y, &l.network.bridge);
        copy(&mut w.fluid.moving, y, &l.network.flow);
        copy(&mut w.fluid.moving_rate, yp, &l.network.flow);
        copy(&mut w.fluid.branch, y, &l.network.branch);
        copy(&mut w.fluid.branch_rate, yp, &l.network.branch);
        for (k, lumped) in wet.lumped.iter().enumerate() {
            w.fluid.lumped[k] = match (&lumped.kind, l.network.lumped_pressure[k]) {
                (LumpedKind::Port(port), _) => T::constant(now.port_pressure[*port]),
                (_, Some(unknown)) => y[unknown] + T::constant(injected_volume::pressing(wet, lumped, now)[0]),
                _ => T::zero(),
            };
        }
    }
}

/// Completes axial velocities that appear in no equation, because only waves depend on them, for balances and samples.
pub fn complete_velocities<T: Scalar>(system: &System, now: &TimeData, yp: &[T], w: &mut Workspace<T>) {
    let along = &system.layout.lines[1];
    if along.v.is_some() || !system.layout.inertia {
        return;
    }
    for (node, u, _) in along.unknowns() {
        w.motion.v[node].z = yp[u] + now.carried(1, system.mesh.share(node)).rate;
    }
}

/// Copies the values of a block; without unknowns the target remains unchanged.
fn copy<T: Scalar>(target: &mut [T], source: &[T], block: &Range<usize>) {
    if !block.is_empty() {
        target.copy_from_slice(&source[block.clone()]);
    }
}

/// Sets the motion of nodes from the unknowns and the frames.
fn move_nodes<T: Scalar>(system: &System, now: &TimeData, y: &[T], yp: &[T], motion: &mut Motion<T>) {
    let l = &system.layout;
    let moves = |line: &LineLayout| !l.inertia || line.u.clone().next().is_some_and(|u| l.differential[u]);
    let at_rate = |line: &LineLayout| (line.v.is_none() && moves(line)).then(|| &yp[line.u.clone()]);
    let lines = l.lines.each_ref();
    let fields = [
        (&mut motion.u, lines.map(|line| Some(&y[line.u.clone()]))),
        (
            &mut motion.v,
            lines.map(|line| line.v.clone().map(|v| &y[v]).or_else(|| at_rate(line))),
        ),
        (&mut motion.a, lines.map(|line| line.v.clone().map(|v| &yp[v]))),
    ];
    let frames = [now.frame(0), now.frame(1)];
    let given: [fn(Jet) -> f64; 3] = [|jet| jet.value, |jet| jet.rate, |jet| jet.acceleration];
    for (k, ((own, from), given)) in fields.into_iter().zip(given).enumerate() {
        let carried = k < 2 || l.inertia;
        let frames = frames.map(|frame| frame.filter(|_| carried));
        let alike = |frame: Frame| if frame.leans() { 0.0 } else { given(frame.at(0.0)) };
        let shifts = frames.map(|frame| frame.map(alike));
        wide!(lay(own, &l.lines, from, shifts));
        for (axis, frame) in frames.into_iter().enumerate() {
            if let Some(frame) = frame.filter(Frame::leans) {
                for (node, own) in own.iter_mut().enumerate() {
                    own[axis] = own[axis] + given(frame.at(system.mesh.share(node)));
                }
            }
        }
    }
}

/// Assembles vectors from their transverse and axial components, zero where there is none, and adds the motion of the frame to all nodes,
/// including driven ones.
#[inline(always)]
fn lay<T: Scalar>(own: &mut [Planar<T>], lines: &[LineLayout; 2], from: [Option<&[T]>; 2], given: [Option<f64>; 2]) {
    let [across, along] = lines.each_ref().map(|line| &line.free);
    let shift = given.map(Option::unwrap_or_default);
    let mut both = across.start.max(along.start)..across.end.min(along.end);
    if let (Some(x), Some(z), false) = (from[0], from[1], both.is_empty()) {
        let x = &x[both.start - across.start..][..both.len()];
        let z = &z[both.start - along.start..][..both.len()];
        for ((own, x), z) in own[both.clone()].iter_mut().zip(x).zip(z) {
            *own = Planar::new(*x + shift[0], *z + shift[1]);
        }
    } else {
        both = 0..0;
    }
    let nodes = own.len();
    for (axis, line) in lines.iter().enumerate() {
        let free = &line.free;
        let done = if both.is_empty() {
            free.start..free.start
        } else {
            both.clone()
        };
        for node in (free.start..done.start).chain(done.end..free.end) {
            own[node][axis] = from[axis].map_or(T::zero(), |from| from[node - free.start]) + shift[axis];
        }
        if let Some(given) = given[axis] {
            for node in (0..free.start).chain(free.end..nodes) {
                own[node][axis] = T::constant(given);
            }
        }
    }
}
