//! The section at finite strain: what its energy adds to forces and areas.

use crate::discrete::ledger::{PressureRates, pressure_rates};
use crate::discrete::{System, TimeData, Workspace};
use crate::numerics::{Dual, Scalar};

/// `[E48]` on the mesh: each cell has its stretch and the mean curvature of its nodes, so that one potential has
///
/// ```text
/// l_seg mean P = Σ h P(y_1, y_2, p_u, p_d)      over the cells of a segment
/// N gains P_1 of the cell, M the mean of P_2 of the cells beside the node, φ_b l_b a1_R loses the mean of ∂P/∂p_R over the segment
/// ```
///
/// Where the moment is given, curvature follows from `EI y_2 + P_2 = M`.
pub fn forces<T: Scalar>(system: &System, now: &TimeData, w: &mut Workspace<T>) {
    let Some((wet, law)) = system.model.strain_energy() else {
        return;
    };
    let (mesh, section) = (&system.mesh, &system.model.section);
    let (k, last) = (mesh.cells_per_segment, mesh.nodes - 1);
    // strains by a pressure of 1 in each bladder
    let unit = [(1.0, 0.0), (0.0, 1.0)].map(|(upper, lower)| {
        let stretch = wet.coupling.stretch(&wet.strains, 0.0, upper, lower);
        (stretch, wet.coupling.curvature(&wet.strains, 0.0, upper, lower))
    });
    w.forces.nonlinear_moment.fill(T::zero());
    for j in 0..wet.per_row {
        let at = law.at_pressures(wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]));
        let (mut sums, mut normals, mut moments) = (law.none(), T::zero(), T::zero());
        for c in j * k..(j + 1) * k {
            let of_stretch = law.of_stretch(w.forces.normal[c] * (1.0 / section.axial_stiffness));
            for (node, end) in [(0, &now.ends[0]), (last, &now.ends[1])] {
                if (c == node || c + 1 == node) && end.slope.is_none() {
                    let other = w.shape.kappa[2 * c + 1 - node] - w.coupling.pressure_curvature[j];
                    let moment = T::constant(end.moment.value);
                    let curvature = law.curvature_under(&at, &of_stretch, other, moment, section.bending_stiffness);
                    w.shape.kappa[node] = curvature + w.coupling.pressure_curvature[j];
                    w.forces.moment[node] = curvature * section.bending_stiffness;
                }
            }
            let curvature = (w.shape.kappa[c] + w.shape.kappa[c + 1]) * 0.5 - w.coupling.pressure_curvature[j];
            let values = law.values(&of_stretch, &law.of_curvature(curvature));
            let (normal, moment) = (at.normal(&values), at.moment(&values));
            w.forces.nonlinear_normal[c] = normal;
            for node in [c, c + 1] {
                w.forces.nonlinear_moment[node] += moment * (0.5 * mesh.h / mesh.node_length(node));
            }
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            normals += normal;
            moments += moment;
        }
        let cells = 1.0 / k as f64;
        let of_segment = law.sums(&at, &sums);
        w.coupling.nonlinear_energy[j] = of_segment.energy * (cells * mesh.segment_length);
        let per_area = -cells / wet.length_ratio(system.model.length);
        // at given strains of the beam, where pressure moves y_1 and y_2 by those that it makes
        for ((bladder, by), (stretch, curvature)) in wet.pair(j).into_iter().zip(of_segment.by_pressure).zip(unit) {
            w.coupling.nonlinear_area[bladder] = (by - normals * stretch - moments * curvature) * per_area;
        }
    }
}

/// The areas that are unknown with those that follow, [`forces`].
pub fn areas<T: Scalar>(system: &System, w: &Workspace<T>, r: &mut [T]) {
    for (bladder, row) in system.layout.coupling.nonlinear_area.clone().enumerate() {
        r[row] = w.coupling.excess_area[bladder] - w.coupling.nonlinear_area[bladder];
    }
}

/// What finite strain adds to the rate of curvature of an end with a given moment, beyond those of `M/EI` and `alpha_p` [1/(m s)].
pub fn end_rate(system: &System, now: &TimeData, w: &Workspace<f64>, node: usize, rates: &PressureRates) -> f64 {
    let Some((wet, law)) = system.model.strain_energy() else {
        return 0.0;
    };
    let (j, at_tip) = (system.mesh.segments_of_node(node).0, node > 0);
    let cell = node - usize::from(at_tip);
    let moment = now.ends[usize::from(at_tip)].moment;
    // what no moment turns takes no work
    if moment.value == 0.0 {
        return 0.0;
    }
    let moving = |value: f64, rate: f64| Dual {
        value,
        derivative: [rate],
    };
    let mean = |row: usize| moving(w.fluid.mean_pressure[wet.pair(j)[row]], rates.pressures[row]);
    let stretch = w.forces.normal[cell] / system.model.section.axial_stiffness;
    let other = 2 * cell + 1 - node;
    let curvature = law.curvature_under(
        &law.at_pressures([mean(0), mean(1)]),
        &law.of_stretch(moving(stretch, w.shape.stretch_rate[cell] - rates.stretch)),
        moving(
            w.shape.kappa[other] - w.coupling.pressure_curvature[j],
            w.shape.kappa_rate[other] - rates.curvature,
        ),
        moving(moment.value, moment.rate),
        system.model.section.bending_stiffness,
    );
    curvature.derivative[0] - moment.rate / system.model.section.bending_stiffness
}

/// How far the cell that is farthest out lies in what is known of the section's energy, 1 at the border, with its rate.
/// Needs [`crate::discrete::ledger::complete`].
pub fn outermost(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let Some((wet, law)) = system.model.strain_energy() else {
        return [0.0; 2];
    };
    let k = system.mesh.cells_per_segment;
    let mean = |of: &[f64], c: usize| 0.5 * (of[c] + of[c + 1]);
    let state = |c: usize| {
        let [upper, lower] = wet.pair(c / k).map(|bladder| w.fluid.mean_pressure[bladder]);
        let stretch = w.forces.normal[c] / system.model.section.axial_stiffness;
        let curvature = mean(&w.shape.kappa, c) - w.coupling.pressure_curvature[c / k];
        [stretch, curvature, upper, lower]
    };
    let (mut out, mut cell) = (0.0, 0);
    for c in 0..system.mesh.cells {
        let here = law.out(&state(c));
        if here > out {
            (out, cell) = (here, c);
        }
    }
    let rates = pressure_rates(system, wet, w, cell / k);
    let [upper, lower] = rates.pressures;
    let stretch = w.shape.stretch_rate[cell] - rates.stretch;
    let curvature = mean(&w.shape.kappa_rate, cell) - rates.curvature;
    [out, law.out_rate(&state(cell), &[stretch, curvature, upper, lower])]
}
