//! The section at finite strain: what its energy adds to forces and areas.

use crate::discrete::ledger::pressure_rates;
use crate::discrete::{System, Workspace};
use crate::model::ROWS;
use crate::numerics::{Dual, Scalar};

/// The energy of [`crate::model::StrainEnergy`] on the mesh: a segment is one cell of the section, with the means of [E16] for its strains,
///
/// ```text
/// y = (Nbar/EA, Mbar/EI, p_u, p_d)      E gains Σ l_seg P      Nbar, Mbar the means of what is linear in N and M
/// N gains P_1 of its segment      M gains P_2 of its segment, at a node between two segments the mean of both
/// a1_R gains R am mean(M) + an N of these, and loses (∂P/∂p_R)/(φ_b l_b)
/// ```
///
/// the weights those with which pressure bends the beam, and their transpose: so all are derivatives of one energy.
pub fn forces<T: Scalar>(system: &System, w: &mut Workspace<T>) {
    let Some((wet, law)) = system.model.strain_energy() else {
        return;
    };
    let (mesh, section) = (&system.mesh, &system.model.section);
    let k = mesh.cells_per_segment;
    let per_area = 1.0 / wet.length_ratio(system.model.length);
    w.forces.nonlinear_moment.fill(T::zero());
    for j in 0..wet.per_row {
        let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
        let slopes = law.at([
            w.coupling.mean_force[j] * (1.0 / section.axial_stiffness),
            w.coupling.mean_moment[j] * (1.0 / section.bending_stiffness),
            upper,
            lower,
        ]);
        w.coupling.nonlinear_energy[j] = slopes.energy * mesh.segment_length;
        w.forces.nonlinear_normal[j * k..(j + 1) * k].fill(slopes.force);
        for i in 0..=k {
            let share = mesh.moment_weight(i) * mesh.segment_length / mesh.node_length(j * k + i);
            w.forces.nonlinear_moment[j * k + i] += slopes.moment * share;
        }
        for (bladder, by) in wet.pair(j).into_iter().zip(slopes.by_pressure) {
            w.coupling.nonlinear_area[bladder] = wet.area.of_force(slopes.force) - by * per_area;
        }
    }
    for j in 0..wet.per_row {
        let mut moment = T::zero();
        for i in 0..=k {
            moment += w.forces.nonlinear_moment[j * k + i] * mesh.moment_weight(i);
        }
        for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
            w.coupling.nonlinear_area[bladder] += wet.area.of_moment(moment, row);
        }
    }
}

/// The areas that are unknown with those that follow, [`forces`].
pub fn areas<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    for (bladder, row) in system.layout.coupling.nonlinear_area.clone().enumerate() {
        r[row] = w.coupling.excess_area[bladder] - w.coupling.nonlinear_area[bladder];
    }
}

/// Energy of the section beyond its quadratic part [J]: `Σ l_seg P + l_b Σ p a_x`, `a_x` what it does to areas.
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let Some((wet, _)) = system.model.strain_energy() else {
        return 0.0;
    };
    let pressures = w.fluid.mean_pressure.iter().zip(&w.coupling.nonlinear_area);
    w.coupling.nonlinear_energy.iter().sum::<f64>() + wet.bladder_length * pressures.map(|(p, a)| p * a).sum::<f64>()
}

/// State of a segment with its rate; needs [`crate::discrete::ledger::complete`].
fn moving(system: &System, w: &Workspace<f64>, j: usize) -> [Dual<1>; 4] {
    let (section, own) = (&system.model.section, &w.coupling);
    let dual = |value: f64, rate: f64, size: f64| Dual {
        value: value / size,
        derivative: [rate / size],
    };
    let mut pressures = [dual(0.0, 0.0, 1.0); 2];
    if let Some(wet) = &system.model.wet {
        let rates = pressure_rates(system, wet, w, j);
        pressures = [0, 1].map(|row| dual(w.fluid.mean_pressure[wet.pair(j)[row]], rates[row], 1.0));
    }
    [
        dual(own.mean_force[j], own.mean_force_rate[j], section.axial_stiffness),
        dual(own.mean_moment[j], own.mean_moment_rate[j], section.bending_stiffness),
        pressures[0],
        pressures[1],
    ]
}

/// What finite strain adds to the rate of curvature of an end with a given moment [1/(m s)].
pub fn end_rate(system: &System, w: &Workspace<f64>, node: usize) -> f64 {
    let Some((_, law)) = system.model.strain_energy() else {
        return 0.0;
    };
    let slopes = law.at(moving(system, w, system.mesh.segments_of_node(node).0));
    -slopes.moment.derivative[0] / system.model.section.bending_stiffness
}

/// How far the segment that is farthest out lies in what is known of the section's energy, 1 at the border, with its rate.
/// Needs [`crate::discrete::ledger::complete`].
pub fn outermost(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let Some((wet, law)) = system.model.strain_energy() else {
        return [0.0; 2];
    };
    let section = &system.model.section;
    let state = |j: usize| {
        let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
        let (force, moment) = (w.coupling.mean_force[j], w.coupling.mean_moment[j]);
        [
            force / section.axial_stiffness,
            moment / section.bending_stiffness,
            upper,
            lower,
        ]
    };
    let (mut out, mut most) = (0.0, 0);
    for j in 0..wet.per_row {
        let here = law.out(&state(j));
        if here > out {
            (out, most) = (here, j);
        }
    }
    [
        out,
        law.out_rate(&state(most), &moving(system, w, most).map(|y| y.derivative[0])),
    ]
}
