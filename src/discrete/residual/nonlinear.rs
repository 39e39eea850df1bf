//! Sections at finite strain: contributions of their energy to forces and areas. Areas by the pressure of the other bladder.

use super::rows::mean_of_nodes;
use crate::discrete::ledger::pressure_rates;
use crate::discrete::{System, Workspace};
use crate::model::{ROWS, StrainPotential, Wet};
use crate::numerics::{Dual, Scalar};

/// Energy of [`crate::model::StrainEnergy`] on the mesh: a segment is one cell of the section, with the means of [E16] as strains,
///
/// ```text
/// y = (Nbar/EA, Mbar/EI, p_u, p_d)      E gains Σ l_seg P      Nbar, Mbar the means of what is linear in N and M
/// N gains P_1 of its segment      M gains EI_i/EI P_2 of its segment, at a node between two segments the mean of both
/// a1_R gains R am mean(M) + an N of these, and loses (∂P/∂p_R)/(φ_b l_b)
/// ```
///
/// The weights are those of bending by pressure, and their transpose: all contributions are derivatives of one energy. `EI_i/EI` is 1
/// except at a node between two segments of different stiffness, [E83], of which one has no bladders and no P.
pub fn forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let Some((wet, _)) = system.model.strain_energy() else {
        return;
    };
    let mesh = &system.mesh;
    let k = mesh.cells_per_segment;
    w.forces.nonlinear_moment.fill(T::zero());
    for (j, law) in segments(wet) {
        let per_area = 1.0 / wet.length_ratio_of(j, system.model.length);
        let slopes = law.at(state(system, wet, w, j));
        w.coupling.nonlinear_energy[j] = slopes.energy * mesh.segment_lengths[j];
        let cells = mesh.cells_of(j);
        w.forces.nonlinear_normal[cells.clone()].fill(slopes.force);
        let stiffness = system.model.section_of(j).bending_stiffness;
        for i in 0..=k {
            let node = cells.start + i;
            let share = mesh.moment_weight(i) * mesh.segment_lengths[j] / mesh.node_lengths[node];
            let ratio = system.sections.bending[node] / stiffness;
            w.forces.nonlinear_moment[node] += slopes.moment * (share * ratio);
        }
        for (bladder, by) in wet.pair(j).into_iter().zip(slopes.by_pressure) {
            w.coupling.nonlinear_area[bladder] = wet.area_of(bladder).of_force(slopes.force) - by * per_area;
        }
    }
    for (j, _) in segments(wet) {
        let moment = mean_of_nodes(system, &w.forces.nonlinear_moment, j);
        for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
            w.coupling.nonlinear_area[bladder] += wet.area_of(bladder).of_moment(moment, row);
        }
    }
}

/// Segments with an energy, each with it.
fn segments(wet: &Wet) -> impl Iterator<Item = (usize, &StrainPotential)> {
    (0..wet.per_row).filter_map(|j| Some((j, wet.strain_energy_of(j)?)))
}

/// `[E90]` Area of a bladder beyond its own law: by finite strain, [`forces`], and by the mean pressure of the other bladder of its segment,
///
/// ```text
/// a1_R = a_p p_R + a_x pbar_(-R) + R A_M + A_N      E gains l_b a_x pbar_u pbar_d
/// ```
pub fn excess_area<T: Scalar>(wet: &Wet, w: &Workspace<T>, bladder: usize) -> T {
    let j = wet.place(bladder).0;
    let [upper, lower] = wet.pair(j);
    let other = if bladder == upper { lower } else { upper };
    let by_pressure = w.fluid.mean_pressure[other] * wet.per_other_pressure_of(j);
    let by_strain = w.coupling.nonlinear_area.get(bladder);
    by_strain.map_or(by_pressure, |area| *area + by_pressure)
}

/// Equations of the unknown areas, which must equal [`excess_area`].
pub fn areas<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    let Some(wet) = &system.model.wet else { return };
    for (bladder, row) in system.layout.coupling.excess() {
        r[row] = w.coupling.excess_area[bladder] - excess_area(wet, w, bladder);
    }
}

/// Energy of the section beyond its quadratic part [J]: `Σ l_seg P + l_b Σ p a_P`, with its contribution `a_P` to
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
    let section = system.model.section_of(j);
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
    let section = system.model.section_of(j);
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
    let j = system.mesh.segments_of_node(node).0;
    let wet = system.model.wet.as_ref();
    let Some((wet, law)) = wet.and_then(|wet| Some((wet, wet.strain_energy_of(j)?))) else {
        return 0.0;
    };
    let (state, rate) = (state(system, wet, w, j), rate(system, wet, w, j));
    let moving = std::array::from_fn(|i| Dual {
        value: state[i],
        derivative: [rate[i]],
    });
    -law.at(moving).moment.derivative[0] / system.model.section_of(j).bending_stiffness
}

/// Largest distance of a segment from the origin of its strain ellipsoid, 1 at the limit of the section's energy, and its rate.
/// Requires [`crate::discrete::ledger::complete`].
pub fn outermost(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let wet = system.model.wet.iter();
    let all = wet.flat_map(|wet| segments(wet).map(move |(j, law)| (wet, j, law)));
    let all = all.map(|(wet, j, law)| (law.out(&state(system, wet, w, j)), (wet, j, law)));
    let Some((out, (wet, j, law))) = all.reduce(|most, one| if one.0 > most.0 { one } else { most }) else {
        return [0.0; 2];
    };
    [out, law.out_rate(&state(system, wet, w, j), &rate(system, wet, w, j))]
}
