//! Sections whose neutral axis is beside the beam's line.

use super::bending::{pressure_curvature, relative_stiffness, segment_curvature};
use crate::case::schema::Effect;
use crate::discrete::time_data::EndData;
use crate::discrete::{System, TimeData, Workspace};
use crate::numerics::Scalar;

/// `[E89]` Neutral axis at the height `d = z_n - z_r` above the beam's line. Stiffness and areas are those about the neutral axis; N, M and
/// loads are those of the line. A force on the line bends the section, and a moment stretches the line:
///
/// ```text
/// N = EA (λ - 1 - λ_p + d (κ - κ_0))      M_n = EI (κ - α_p - κ_0)      M = M_n + d N      areas and strains by pressure: those by N and M_n
/// N_c = EA [λ_c - 1 - λ_p + d (κ̄_c - κ̄_0)]      κ̄_c = (κ_c + κ_{c+1})/2      M_i = M_n,i + Σ_c h d_c N_c/(2 h_i)      c the cells beside node i
/// N_total = N + EA τ_a (λ_t + d (κ - κ_0)_t)      M_total likewise
/// ```
///
/// They are the derivatives of `Σ h N²/2EA + Σ h_i M_n²/2EI`: the energy balance is exact. At an end with a given moment M,
///
/// ```text
/// κ_n = [M + EI (α_p + κ_0) - EA d (λ_c - 1 - λ_p + d (κ_{n-1}/2 - κ̄_0))]/(EI + EA d²/2)
/// ```
///
/// and the viscous part of the force has the curvature rate of the neighboring node.
///
/// At a node where d or EI jumps, the curvatures of both sides differ, `κ_i = s_l κ_l + s_r κ_r`. Each side is such an end, with the
/// same moment M: `κ_s = (M + B_s)/A_s`, with `A = EI + EA d²/2` and `M + B` the numerator above.
pub fn end_curvatures<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    if system.sections.offset.is_empty() {
        return;
    }
    for (k, node) in system.sections.offset_borders.iter().enumerate() {
        w.shape.side_curvature[k] = side_curvatures(system, now, w, *node);
    }
    for end in ends(system, now) {
        let [bending, axial] = end.stiffness(system);
        let force = force_by_neighbor(system, now, w, end.cell, end.beside, [axial, end.offset]);
        let free = pressure_curvature(system, w, end.node) + T::constant(now.rest_curvature(end.node));
        if let Some(law) = system.sections.laws.get(end.node) {
            let parallel = 0.5 * axial * end.offset * end.offset;
            let moment = T::constant(end.moment) - force * end.offset - free * parallel;
            w.shape.kappa[end.node] = law.inverse(moment, parallel) + free;
            continue;
        }
        let mut moment = free * bending + T::constant(end.moment) - force * end.offset;
        if let Some(nonlinear) = w.forces.nonlinear_moment.get(end.node) {
            moment -= *nonlinear;
        }
        w.shape.kappa[end.node] = moment * (1.0 / end.compliant(bending, axial));
    }
}

/// Normal force of a cell without the curvature of one of its nodes; `beside` is the other node, `[axial, offset]` are EA and d.
#[inline]
fn force_by_neighbor<T: Scalar>(
    system: &System,
    now: &TimeData,
    w: &Workspace<T>,
    cell: usize,
    beside: usize,
    [axial, offset]: [f64; 2],
) -> T {
    let bent = w.shape.kappa[beside] * 0.5 - T::constant(mean_rest(now, 0, cell));
    (w.shape.strain[cell] - pressure_stretch(system, w, cell)) * axial + bent * (axial * offset)
}

/// Curvature without moment of both sides of a node between two segments.
fn free_curvatures<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> [T; 2] {
    let rest = T::constant(now.rest_curvature(node));
    let (segments, _) = system.mesh.sides_of_node(node);
    segments.map(|segment| segment_curvature(system, w, segment) + rest)
}

/// Curvatures of both sides of a node where d or EI jumps.
fn side_curvatures<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> [T; 2] {
    let free = free_curvatures(system, now, w, node);
    let (bending, (_, shares)) = (system.sections.bending_beside[node], system.mesh.sides_of_node(node));
    let without_moment = |side: usize, cell: usize, beside: usize| {
        let (axial, offset) = (system.sections.axial[cell], system.sections.offset[cell]);
        let force = force_by_neighbor(system, now, w, cell, beside, [axial, offset]);
        let compliance = 1.0 / (bending[side] + 0.5 * axial * offset * offset);
        ((free[side] * bending[side] - force * offset) * compliance, compliance)
    };
    let [left, right] = [without_moment(0, node - 1, node - 1), without_moment(1, node, node + 1)];
    let compliance = shares[0] * left.1 + shares[1] * right.1;
    let moment = (w.shape.kappa[node] - left.0 * shares[0] - right.0 * shares[1]) * (1.0 / compliance);
    [left, right].map(|(curvature, compliance)| curvature + moment * compliance)
}

/// Sets the moments about both neutral axes at nodes where they jump, and their mean.
pub fn side_moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    for (k, &node) in system.sections.offset_borders.iter().enumerate() {
        let (free, curvature) = (free_curvatures(system, now, w, node), w.shape.side_curvature[k]);
        let (bending, (_, shares)) = (system.sections.bending_beside[node], system.mesh.sides_of_node(node));
        let [left, right] = [0, 1].map(|side| (curvature[side] - free[side]) * bending[side]);
        w.forces.side_moment[k] = [left, right];
        w.forces.moment[node] = left * shares[0] + right * shares[1];
    }
}

/// Elastic energy of bending at a node where neutral axes jump [J].
pub fn side_energy(system: &System, w: &Workspace<f64>, node: usize) -> Option<f64> {
    let k = system.sections.offset_border(node)?;
    let bending = system.sections.bending_beside[node];
    let (shares, moments) = (system.mesh.sides_of_node(node).1, w.forces.side_moment[k]);
    let of = |side: usize| shares[side] * moments[side] * moments[side] / bending[side];
    Some(0.5 * system.mesh.node_lengths[node] * (of(0) + of(1)))
}

/// Adds the part of curvature to normal forces, and to viscous ones.
pub fn normal_forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let time = system.model.section.axial_damping_time;
    let viscosity = &system.sections.axial_viscosity;
    for (c, (d, ea)) in system.sections.offset.iter().zip(&system.sections.axial).enumerate() {
        let bent = (w.shape.kappa[c] + w.shape.kappa[c + 1]) * 0.5 - T::constant(mean_rest(now, 0, c));
        w.forces.normal[c] += bent * (d * ea);
        if time > 0.0 {
            let mut rate = T::constant(-mean_rest(now, 1, c));
            for (node, weight) in viscous_weights(system, now, c) {
                rate += w.shape.kappa_rate[node] * weight;
            }
            w.forces.viscous_normal[c] += rate * (d * viscosity[c]);
        }
    }
    for (&node, curvature) in system.sections.offset_borders.iter().zip(&w.shape.side_curvature) {
        for (cell, curvature) in [node - 1, node].into_iter().zip(curvature) {
            let (d, ea) = (system.sections.offset[cell], system.sections.axial[cell]);
            w.forces.normal[cell] += (*curvature - w.shape.kappa[node]) * (0.5 * d * ea);
        }
    }
}

/// Moments of the normal forces about the neutral axis.
pub fn moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let mesh = &system.mesh;
    w.forces.offset_moment.fill(T::zero());
    for (c, d) in system.sections.offset.iter().enumerate() {
        for node in [c, c + 1] {
            w.forces.offset_moment[node] += w.forces.normal[c] * (0.5 * mesh.lengths[c] * d / mesh.node_lengths[node]);
        }
        if system.model.section.axial_damping_time > 0.0 {
            for (node, weight) in viscous_weights(system, now, c) {
                w.forces.viscous_moment[node] +=
                    w.forces.viscous_normal[c] * (weight * mesh.lengths[c] * d / mesh.node_lengths[node]);
            }
        }
    }
}

/// Rate of the curvature of an end with a given moment; `by_pressure` are the rates of stretch and curvature by pressure.
pub fn end_rate(
    system: &System,
    now: &TimeData,
    w: &Workspace<f64>,
    node: usize,
    by_pressure: [f64; 2],
) -> Option<f64> {
    let end = ends(system, now).find(|end| end.node == node && !system.sections.offset.is_empty())?;
    let [bending, axial] = end.stiffness(system);
    let bending = bending * relative_stiffness(system, now, w, node);
    let force = axial * (w.shape.stretch_rate[end.cell] - by_pressure[0])
        + axial * end.offset * (0.5 * w.shape.kappa_rate[end.beside] - mean_rest(now, 1, end.cell));
    let moment = end.moment_rate + bending * (by_pressure[1] + now.rest_curvature_rate(node)) - end.offset * force;
    Some(moment / end.compliant(bending, axial))
}

/// An end with a given moment.
struct GivenMoment {
    node: usize,
    /// Node beside it.
    beside: usize,
    /// Cell between both.
    cell: usize,
    moment: f64,
    moment_rate: f64,
    /// `d` [m].
    offset: f64,
}

impl GivenMoment {
    /// `EI` and `EA`.
    fn stiffness(&self, system: &System) -> [f64; 2] {
        [system.sections.bending[self.node], system.sections.axial[self.cell]]
    }

    /// `EI + EA d²/2`.
    fn compliant(&self, bending: f64, axial: f64) -> f64 {
        bending + 0.5 * axial * self.offset * self.offset
    }
}

/// Ends with given moments.
fn ends<'a>(system: &'a System, now: &'a TimeData) -> impl Iterator<Item = GivenMoment> + 'a {
    let all = system.mesh.ends().zip(&now.ends);
    all.filter(|(_, given)| !given.turns())
        .map(|((_, end), given)| GivenMoment {
            node: end.node,
            beside: if end.outward < 0.0 { end.cell + 1 } else { end.cell },
            cell: end.cell,
            moment: given.moment.value,
            moment_rate: given.moment.rate,
            offset: system.sections.offset.get(end.cell).copied().unwrap_or(0.0),
        })
}

/// Nodes of a cell with their weights in the mean rate of curvature; an end with a given moment has none, nor has a node where neutral axes jump.
fn viscous_weights(system: &System, now: &TimeData, cell: usize) -> [(usize, f64); 2] {
    let moves = |node: usize| now.end(node).is_none_or(EndData::turns);
    let jumps = |node: usize| system.sections.offset_border(node).is_some();
    let [left, right] = [cell, cell + 1].map(|node| moves(node) && !jumps(node));
    match (left, right) {
        (true, false) => [(cell, 1.0), (cell + 1, 0.0)],
        (false, true) => [(cell, 0.0), (cell + 1, 1.0)],
        (false, false) => [(cell, 0.0), (cell + 1, 0.0)],
        (true, true) => [(cell, 0.5), (cell + 1, 0.5)],
    }
}

/// Mean of `κ_0` of a cell, or of its rate.
fn mean_rest(now: &TimeData, order: usize, cell: usize) -> f64 {
    let both = now.rest_curvature[order].get(cell..cell + 2);
    both.map_or(0.0, |both| 0.5 * (both[0] + both[1]))
}

/// `λ_p` of a cell.
fn pressure_stretch<T: Scalar>(system: &System, w: &Workspace<T>, cell: usize) -> T {
    match system.fluid.is_some() && system.model.effects.has(Effect::PressureToStretch) {
        true => w.coupling.pressure_stretch[system.mesh.segment_of(cell)],
        false => T::zero(),
    }
}
