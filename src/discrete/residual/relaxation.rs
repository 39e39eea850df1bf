//! Stress relaxation of the solid.

use std::ops::Range;

use super::solid::node_stretch;
use crate::discrete::mesh::BeamRanges;
use crate::discrete::{System, TimeData, Workspace};
use crate::numerics::Scalar;

/// `[E58]` Generalized Maxwell solid: the long-term spring in parallel with branches, each a spring with stiffness ratio g_k in series
/// with a dashpot. The branches act on the strains of the beam; the response of bladders to pressure keeps its long-term value:
///
/// ```text
/// M_total = M + EI Σ g_k (κ - κ_k)      dκ_k/dt = (κ - κ_k)/τ_k
/// N_total = N + EA Σ g_k (ε - ε_k)      dε_k/dt = (ε - ε_k)/τ_k        ε = λ - 1
/// V_total = V + kGA Σ g_k (γ - γ_k)     dγ_k/dt = (γ - γ_k)/τ_k        where sections shear, likewise in E and D
/// E gains Σ h_i EI g_k (κ - κ_k)²/2 + Σ h EA g_k (ε - ε_k)²/2        D = Σ h_i EI g_k (κ - κ_k) dκ_k/dt + Σ h EA g_k (ε - ε_k) dε_k/dt
/// ```
///
/// κ is relative to the rest curvature, [E59]. For g_k → ∞ at constant g_k τ_k this is the Kelvin-Voigt solid. At an end with given
/// moment, with the curvature measure α = s κ of [E12],
///
/// ```text
/// κ = (M/EI + α_p + Σ g_k κ_k)/(s + Σ g_k)
/// ```
pub fn rows<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, r: &mut [T]) {
    let own = &system.layout.relaxation;
    let curvatures = [&w.relaxed.curvature, &w.relaxed.curvature_rate];
    let stretches = [&w.relaxed.stretch, &w.relaxed.stretch_rate];
    let shears = [&w.relaxed.shear, &w.relaxed.shear_rate];
    for (rows, strain, rest, [kept, rate]) in [
        (&own.curvature, &w.shape.kappa, &now.rest_curvature[0][..], curvatures),
        (&own.stretch, &w.shape.strain, &[], stretches),
        (&own.shear, &w.shape.sections.shear, &[], shears),
    ] {
        let mut all = rows.clone().zip(kept).zip(rate);
        for branch in &system.model.relaxation {
            for (place, ((row, kept), rate)) in all.by_ref().take(strain.len()).enumerate() {
                r[row] = *rate - (beyond(strain, rest, place) - *kept) * (1.0 / branch.time_s);
            }
        }
    }
}

/// Relaxing parts of normal forces.
pub fn normal_forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let stiffness = &system.sections.axial;
    relaxing(
        system,
        stiffness,
        (&w.shape.strain, &[]),
        &w.relaxed.stretch,
        &mut w.forces.relaxing_normal,
    );
}

/// Relaxing parts of shear forces.
pub fn shears<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let stiffness = &system.sections.shear;
    relaxing(
        system,
        stiffness,
        (&w.shape.sections.shear, &[]),
        &w.relaxed.shear,
        &mut w.forces.relaxing_shear,
    );
}

/// Relaxing parts of moments.
pub fn moments<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let stiffness = &system.sections.bending;
    relaxing(
        system,
        stiffness,
        (&w.shape.kappa, &now.rest_curvature[0]),
        &w.relaxed.curvature,
        &mut w.forces.relaxing_moment,
    );
}

/// Strain at a place relative to that at rest.
#[inline]
fn beyond<T: Scalar>(strain: &[T], rest: &[f64], place: usize) -> T {
    match rest.get(place) {
        Some(rest) => strain[place] - T::constant(*rest),
        None => strain[place],
    }
}

fn relaxing<T: Scalar>(system: &System, stiffness: &[f64], (strain, rest): (&[T], &[f64]), kept: &[T], out: &mut [T]) {
    out.fill(T::zero());
    for (branch, kept) in system.model.relaxation.iter().zip(kept.chunks_exact(out.len().max(1))) {
        for (place, ((out, kept), stiffness)) in out.iter_mut().zip(kept).zip(stiffness).enumerate() {
            *out += (beyond(strain, rest, place) - *kept) * (*stiffness * branch.modulus_ratio);
        }
    }
}

/// Curvature of a node with given moment; `α = M/EI + α_p` in the long term.
pub fn curvature<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize, alpha: T, stretch: T) -> T {
    let (remembered, ratios) = remembered(system, &w.relaxed.curvature, now.rest_curvature(node), node);
    (alpha + remembered) / (stretch + ratios)
}

/// Sum to which a given moment belongs at an end with a moment-curvature law, `f(e) + EI Σ g_k e = M + EI Σ g_k (κ_k + κ_0 - α_free)`:
/// what its right side adds to M, and `EI Σ g_k`.
pub fn at_bent_end<T: Scalar>(system: &System, now: &TimeData, w: &Workspace<T>, node: usize, free: T) -> (T, f64) {
    if w.relaxed.curvature.is_empty() {
        return (T::zero(), 0.0);
    }
    let ei = system.sections.bending[node];
    let (remembered, ratios) = remembered(system, &w.relaxed.curvature, now.rest_curvature(node), node);
    ((remembered - free * ratios) * ei, ei * ratios)
}

/// Rate of this curvature.
pub fn curvature_rate(
    system: &System,
    now: &TimeData,
    w: &Workspace<f64>,
    node: usize,
    alpha_rate: f64,
    stretch: f64,
) -> f64 {
    let rest = now.rest_curvature_rate(node);
    let (remembered, ratios) = remembered(system, &w.relaxed.curvature_rate, rest, node);
    (alpha_rate + remembered) / (stretch + ratios)
}

/// `Σ g_k (κ_k + κ_0)` of a node, and `Σ g_k`.
fn remembered<T: Scalar>(system: &System, kept: &[T], rest: f64, node: usize) -> (T, f64) {
    let mut sum = T::zero();
    let mut ratios = 0.0;
    for (branch, kept) in system.model.relaxation.iter().zip(kept.chunks_exact(system.mesh.nodes)) {
        sum += (kept[node] + T::constant(rest)) * branch.modulus_ratio;
        ratios += branch.modulus_ratio;
    }
    (sum, ratios)
}

/// Energy stored in the branches of a beam [J], and their dissipation [W].
pub fn energy_and_loss(system: &System, now: &TimeData, w: &Workspace<f64>, beam: &BeamRanges) -> [f64; 2] {
    let (mesh, sections, relaxed) = (&system.mesh, &system.sections, &w.relaxed);
    let mut sums = [0.0; 2];
    let mut add = |places: &Range<usize>,
                   strain: &[f64],
                   rest: &[f64],
                   [kept, rate]: [&[f64]; 2],
                   stiffness: &dyn Fn(usize) -> f64| {
        let count = strain.len().max(1);
        let branches = kept.chunks_exact(count).zip(rate.chunks_exact(count));
        for (branch, (kept, rate)) in system.model.relaxation.iter().zip(branches) {
            for place in places.clone() {
                let stiffness = stiffness(place) * branch.modulus_ratio;
                let slip = beyond(strain, rest, place) - kept[place];
                sums[0] += 0.5 * stiffness * slip * slip;
                sums[1] += stiffness * slip * rate[place];
            }
        }
    };
    let of_curvature = |node: usize| mesh.node_lengths[node] * sections.bending[node];
    let curvatures = [&relaxed.curvature[..], &relaxed.curvature_rate];
    add(
        &beam.nodes,
        &w.shape.kappa,
        &now.rest_curvature[0],
        curvatures,
        &of_curvature,
    );
    let of_stretch = |cell: usize| mesh.lengths[cell] * sections.axial[cell];
    add(
        &beam.cells,
        &w.shape.strain,
        &[],
        [&relaxed.stretch, &relaxed.stretch_rate],
        &of_stretch,
    );
    let of_shear = |cell: usize| mesh.lengths[cell] * sections.shear[cell];
    add(
        &beam.cells,
        &w.shape.sections.shear,
        &[],
        [&relaxed.shear, &relaxed.shear_rate],
        &of_shear,
    );
    sums
}

/// Sets the branches of a state `y` (SI) to the relaxed strains of a beam with this shape and these pressures. `w` contains the strains,
/// for the same system or for one without branches. A given moment is then entirely elastic.
pub fn settle(system: &System, now: &TimeData, w: &Workspace<f64>, y: &mut [f64]) {
    let own = &system.layout.relaxation;
    for (unknown, strain) in own.stretch.clone().zip(w.shape.strain.iter().cycle()) {
        y[unknown] = *strain;
    }
    for (unknown, strain) in own.shear.clone().zip(w.shape.sections.shear.iter().cycle()) {
        y[unknown] = *strain;
    }
    for (k, unknown) in own.curvature.clone().enumerate() {
        let node = k % system.mesh.nodes;
        let turns = now.end(node).is_some_and(|end| !end.turns());
        let mut curvature = w.shape.kappa[node];
        if let Some(relaxing) = w.forces.relaxing_moment.get(node).filter(|_| turns) {
            let stretch = if system.model.published() {
                node_stretch(&system.mesh, w, node)
            } else {
                1.0
            };
            curvature += match system.sections.laws.get(node) {
                Some(law) => {
                    let moment = w.forces.moment[node];
                    law.inverse(moment + relaxing, 0.0) - law.inverse(moment, 0.0)
                }
                None => relaxing / (system.sections.bending[node] * stretch),
            };
        }
        y[unknown] = curvature - now.rest_curvature(node);
    }
}
