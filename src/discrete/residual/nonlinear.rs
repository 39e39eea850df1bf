//! Sections at finite strain: contributions of their energy to forces and areas.

use super::rows::mean_of_nodes;
use crate::discrete::ledger::pressure_rates;
use crate::discrete::{System, Workspace};
use crate::model::{ROWS, Wet};
use crate::numerics::{Dual, Scalar};

/// Energy of [`crate::model::StrainEnergy`] on the mesh: a segment is one cell of the section, with the means of [E16] as strains,
///
/// ```text
/// y = (Nbar/EA, Mbar/EI, p_u, p_d)      E gains Σ l_seg P      Nbar, Mbar the means of what is linear in N and M
/// N gains P_1 of its segment      M gains P_2 of its segment, at a node between two segments the mean of both
/// a1_R gains R am mean(M) + an N of these, and loses (∂P/∂p_R)/(φ_b l_b)
/// ```
///
/// The weights are those of bending by pressure, and their transpose: all contributions are derivatives of one energy.
pub fn forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let Some((wet, law)) = system.model.strain_energy() else {
        return;
    };
    let mesh = &system.mesh;
    let k = mesh.cells_per_segment;
    w.forces.nonlinear_moment.fill(T::zero());
    for j in 0..wet.per_row {
        let per_area = 1.0 / wet.length_ratio_of(j, system.model.length);
        let slopes = law.at(state(system, wet, w, j));
        w.coupling.nonlinear_energy[j] = slopes.energy * mesh.segment_lengths[j];
        w.forces.nonlinear_normal[j * k..(j + 1) * k].fill(slopes.force);
        for i in 0..=k {
            let share = mesh.moment_weight(i) * mesh.segment_lengths[j] / mesh.node_lengths[j * k + i];
            w.forces.nonlinear_moment[j * k + i] += slopes.moment * share;
        }
        for (bladder, by) in wet.pair(j).into_iter().zip(slopes.by_pressure) {
            w.coupling.nonlinear_area[bladder] = wet.area_of(bladder).of_force(slopes.force) - by * per_area;
        }
    }
    for j in 0..wet.per_row {
        let moment = mean_of_nodes(system, &w.forces.nonlinear_moment, j);
        for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
            w.coupling.nonlinear_area[bladder] += wet.area_of(bladder).of_moment(moment, row);
        }
    }
}

/// Equations of the unknown areas, which must equal those of [`forces`].
pub fn areas<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    for (bladder, row) in system.layout.coupling.nonlinear_area.clone().enumerate() {
        r[row] = w.coupling.excess_area[bladder] - w.coupling.nonlinear_area[bladder];
    }
}

/// Energy of the section beyond its quadratic part [J]: `Σ l_seg P + l_b Σ p a_x`, with its contribution `a_x` to
/// areas.
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let Some((wet, _)) = system.model.strain_energy() else {
        return 0.0;
    };
    let pressures = w.fluid.mean_pressure.iter().zip(&w.coupling.nonlinear_area);
    w.coupling.nonlinear_energy.iter().sum::<f64>() + wet.bladder_length * pressures.map(|(p, a)| p * a).sum::<f64>()
}

/// Strains and pressures y of a segment.
fn state<T: Scalar>(system: &System, wet: &Wet, w: &Workspace<T>, j: usize) -> [T; 4] {
    let section = &system.model.section;
    let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
    [
        w.coupling.mean_force[j] * (1.0 / section.axial_stiffness),
        w.coupling.mean_moment[j] * (1.0 / section.bending_stiffness),
        upper,
        lower,
    ]
}

/// Rate of y; requires [`crate::discrete::ledger::complete`].
fn rate(system: &System, wet: &Wet, w: &Workspace<f64>, j: usize) -> [f64; 4] {
    let section = &system.model.section;
    let [upper, lower] = pressure_rates(system, wet, w, j);
    [
        w.coupling.mean_force_rate[j] / section.axial_stiffness,
        w.coupling.mean_moment_rate[j] / section.bending_stiffness,
        upper,
        lower,
    ]
}

/// Contribution of finite strain to the rate of curvature of an end with given moment [1/(m s)].
pub fn end_rate(system: &System, w: &Workspace<f64>, node: usize) -> f64 {
    let Some((wet, law)) = system.model.strain_energy() else {
        return 0.0;
    };
    let j = system.mesh.segments_of_node(node).0;
    let (state, rate) = (state(system, wet, w, j), rate(system, wet, w, j));
    let moving = std::array::from_fn(|i| Dual {
        value: state[i],
        derivative: [rate[i]],
    });
    -law.at(moving).moment.derivative[0] / system.model.section.bending_stiffness
}

/// Largest distance of a segment from the origin of its strain ellipsoid, 1 at the limit of the section's energy, and its rate.
/// Requires [`crate::discrete::ledger::complete`].
pub fn outermost(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let Some((wet, law)) = system.model.strain_energy() else {
        return [0.0; 2];
    };
    let (mut out, mut most) = (0.0, 0);
    for j in 0..wet.per_row {
        let here = law.out(&state(system, wet, w, j));
        if here > out {
            (out, most) = (here, j);
        }
    }
    let (state, rate) = (state(system, wet, w, most), rate(system, wet, w, most));
    [out, law.out_rate(&state, &rate)]
}
