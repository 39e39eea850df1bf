//! Moments, and the shear forces of sections that remain perpendicular to the beam.

use super::solid::node_stretch;
use super::{eccentric, fourth_order, relaxation};
use crate::case::schema::Effect;
use crate::discrete::{System, TimeData, Workspace};
use crate::numerics::Scalar;

/// Moments, `[E12]`.
///
/// `[E59]` Rest curvature κ_0 of the beam (loads of the kind `rest_curvature_1_m`), with the weights of forces, [E46]:
///
/// ```text
/// M = EI (α - α_p - κ_0)      EI τ_b (κ - κ_0)_t      P_loads gains -Σ h_i M_total κ_0,t
/// ```
pub fn moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let section = &system.model.section;
    let ei = &system.sections.bending;
    let last = system.mesh.nodes - 1;
    let published = system.model.published();
    let forces = &mut w.forces;
    let (kappa, moment) = (&w.shape.kappa[..=last], &mut forces.moment[..=last]);
    if published {
        let stretch = w.shape.stretch.windows(2);
        for ((moment, kappa), pair) in moment[1..last].iter_mut().zip(&kappa[1..last]).zip(stretch) {
            *moment = *kappa * ((pair[0] + pair[1]) * 0.5);
        }
        moment[0] = kappa[0] * w.shape.stretch[0];
        moment[last] = kappa[last] * w.shape.stretch[last - 1];
    } else {
        moment.copy_from_slice(kappa);
    }
    if presses(system) {
        let k = system.mesh.cells_per_segment;
        for beam in &system.mesh.beams {
            let moment = &mut moment[beam.nodes.clone()];
            let curvature = &w.coupling.pressure_curvature[beam.segments.clone()];
            for (moments, free) in moment.chunks_mut(k).zip(curvature) {
                moments[1..].iter_mut().for_each(|moment| *moment -= *free);
            }
            let last = moment.len() - 1;
            moment[0] -= curvature[0];
            moment[last] -= curvature[curvature.len() - 1];
            let borders = system.mesh.borders[beam.segments.start..].iter();
            for (j, (pair, [left, right])) in curvature.windows(2).zip(borders).enumerate() {
                moment[(j + 1) * k] -= pair[0] * *left + pair[1] * *right;
            }
        }
    }
    for (moment, rest) in moment.iter_mut().zip(&now.rest_curvature[0]) {
        *moment -= T::constant(*rest);
    }
    if system.sections.laws.is_empty() {
        for (moment, ei) in moment.iter_mut().zip(ei) {
            *moment = *moment * *ei;
        }
    } else {
        for (moment, law) in moment.iter_mut().zip(&system.sections.laws) {
            *moment = law.moment(*moment);
        }
    }
    if system.sections.offset.is_empty() {
        for (_, end) in system.mesh.ends() {
            given_moment(system, now, end.node, w);
        }
    }
    eccentric::side_moments(system, now, w);
    if system.mesh.fourth {
        fourth_order::moments(system, now, &mut w.forces.moment);
    }
    relaxation::moments(system, now, w);
    if section.bends_viscously() {
        for (i, viscosity) in system.sections.bending_viscosity.iter().enumerate() {
            let mut rate = w.shape.kappa_rate[i];
            if let Some(rest) = now.rest_curvature[1].get(i) {
                rate -= T::constant(*rest);
            }
            w.forces.viscous_moment[i] = rate * *viscosity;
        }
        for (_, end) in system.mesh.ends().filter(|(k, _)| !now.ends[*k].turns()) {
            w.forces.viscous_moment[end.node] = T::zero();
        }
        if system.mesh.fourth {
            fourth_order::moments(system, now, &mut w.forces.viscous_moment);
        }
    }
}

/// Moment and curvature of an end with given moment.
fn given_moment<T: Scalar>(system: &System, now: &TimeData, node: usize, w: &mut Workspace<T>) {
    let Some(end) = now.end(node).filter(|end| !end.turns()) else {
        return;
    };
    let ei = system.sections.bending[node];
    let mut free_curvature = pressure_curvature(system, w, node);
    if let Some(rest) = now.rest_curvature[0].get(node) {
        free_curvature += T::constant(*rest);
    }
    let published = system.model.published();
    let stretch = if published {
        node_stretch(&system.mesh, w, node)
    } else {
        T::constant(1.0)
    };
    let mut elastic = T::constant(end.moment.value);
    if let Some(nonlinear) = w.forces.nonlinear_moment.get(node) {
        elastic -= *nonlinear;
    }
    w.forces.moment[node] = elastic;
    if let Some(law) = system.sections.laws.get(node) {
        let (more, parallel) = relaxation::at_bent_end(system, now, w, node, free_curvature);
        let bent = law.inverse(elastic + more, parallel);
        w.shape.kappa[node] = free_curvature + bent;
        if parallel > 0.0 {
            w.forces.moment[node] = law.moment(bent);
        }
        return;
    }
    let mut alpha = free_curvature + elastic / T::constant(ei);
    if system.mesh.fourth {
        alpha = free_curvature + fourth_order::of_end(system, w, node, elastic);
    }
    if w.relaxed.curvature.is_empty() {
        w.shape.kappa[node] = if published { alpha / stretch } else { alpha };
    } else {
        w.shape.kappa[node] = relaxation::curvature(system, now, w, node, alpha, stretch);
        w.forces.moment[node] = (w.shape.kappa[node] * stretch - free_curvature) * ei;
    }
}

/// Elastic curvature `e_i = α_i - α_p - κ_0` of a node.
#[inline]
pub fn elastic_curvature<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize) -> T {
    let mut alpha = w.shape.kappa[node];
    if system.model.published() {
        alpha = alpha * node_stretch(&system.mesh, w, node);
    }
    alpha - pressure_curvature(system, w, node) - T::constant(now.rest_curvature(node))
}

/// Slope of the moment over curvature of a node, over its EI: 1 for a linear law.
#[inline]
pub fn relative_stiffness(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize) -> f64 {
    let law = system.sections.laws.get(node);
    law.map_or(1.0, |law| {
        law.at(elastic_curvature(system, now, w, node)).stiffness / system.sections.bending[node]
    })
}

/// Shear forces, `[E12]`.
pub fn shears<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let forces = &mut w.forces;
    let drops = forces.shear.iter_mut();
    for (drop, pair) in drops.zip(forces.moment.windows(2)) {
        *drop = pair[0] - pair[1];
    }
    let mut parts = [
        &forces.nonlinear_moment[..],
        &forces.relaxing_moment,
        &forces.arc_moment,
        &forces.offset_moment,
        &[],
    ];
    if system.model.section.bends_viscously() {
        parts[4] = &forces.viscous_moment;
    }
    for part in parts {
        for (drop, pair) in forces.shear.iter_mut().zip(part.windows(2)) {
            *drop += pair[0] - pair[1];
        }
    }
    let inverse = &system.mesh.per_length;
    for ((shear, per_stretch), inverse) in forces.shear.iter_mut().zip(&w.shape.per_stretch).zip(inverse) {
        *shear = *shear * (*per_stretch * *inverse);
    }
}

/// Decrease of the moment over a cell, including its viscous part [N m].
#[inline]
pub fn total_moment_drop<T: Scalar>(system: &System, w: &Workspace<T>, c: usize) -> T {
    let mut drop = w.forces.moment[c] - w.forces.moment[c + 1];
    if let [left, right, ..] = w.forces.nonlinear_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if let [left, right, ..] = w.forces.relaxing_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if let [left, right, ..] = w.forces.arc_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if let [left, right, ..] = w.forces.offset_moment.get(c..).unwrap_or_default() {
        drop += *left - *right;
    }
    if system.model.section.bends_viscously() {
        drop + (w.forces.viscous_moment[c] - w.forces.viscous_moment[c + 1])
    } else {
        drop
    }
}

impl System {
    /// Moment at a node, all parts [N m].
    #[inline]
    pub fn total_moment<T: Scalar>(&self, w: &Workspace<T>, node: usize) -> T {
        let forces = &w.forces;
        let mut moment = forces.moment[node];
        for part in [
            &forces.nonlinear_moment,
            &forces.relaxing_moment,
            &forces.arc_moment,
            &forces.offset_moment,
        ] {
            if let Some(more) = part.get(node) {
                moment += *more;
            }
        }
        match self.model.section.bends_viscously() {
            true => moment + forces.viscous_moment[node],
            false => moment,
        }
    }
}

/// `alpha_p` at a node: mean of the segments on both sides (the transpose of the mean moment's weights).
#[inline]
pub fn pressure_curvature<T: Scalar>(system: &System, w: &Workspace<T>, node: usize) -> T {
    if !presses(system) {
        return T::zero();
    }
    let (left, right) = system.mesh.segments_of_node(node);
    if left == right {
        w.coupling.pressure_curvature[left]
    } else {
        let shares = system.mesh.borders[left];
        w.coupling.pressure_curvature[left] * shares[0] + w.coupling.pressure_curvature[right] * shares[1]
    }
}

/// `alpha_p` of a segment.
#[inline]
pub fn segment_curvature<T: Scalar>(system: &System, w: &Workspace<T>, segment: usize) -> T {
    match presses(system) {
        true => w.coupling.pressure_curvature[segment],
        false => T::zero(),
    }
}

/// True if pressure bends the beam.
#[inline]
fn presses(system: &System) -> bool {
    system.fluid.is_some() && system.model.effects.has(Effect::PressureToCurvature)
}
