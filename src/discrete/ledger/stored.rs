//! Energy and volume stored in the parts of the fluid system.

use crate::discrete::{System, Workspace};
use crate::model::ROWS;

/// Energy stored in the bladders, including touching walls, [E71], for both couplings; p is the pressure on the walls:
///
/// ```text
/// l_b Σ_{j,R} [ mean_k(a_p p_k²/2) + pbar (Nbar A_N'(Nbar) + Mbar (R A_M)'(Mbar)) ] + l_b Σ_j a_x pbar_u pbar_d
/// ```
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return 0.0;
    };
    let mut sum = 0.0;
    for j in 0..wet.per_row {
        let [upper, lower] = wet.pair(j).map(|bladder| w.fluid.mean_pressure[bladder]);
        sum += wet.per_other_pressure_of(j) * upper * lower;
        for (bladder, row) in wet.pair(j).into_iter().zip(ROWS) {
            let cells = fluid.cells_of(bladder);
            let law = wet.area_of(bladder);
            let (mut squares, mut closed) = (0.0, 0.0);
            for cell in cells.clone() {
                let mut in_walls = w.fluid.pressure[cell];
                if let Some(closing) = &wet.closing {
                    let area = w.fluid.area_changes()[cell];
                    in_walls += closing.at(law, area).0;
                    closed += closing.energy(law, area);
                }
                squares += in_walls * in_walls;
            }
            let mixed = w.coupling.mean_force[j] * law.force_slope(w.coupling.mean_force[j])
                + w.coupling.mean_moment[j] * law.moment_slope(w.coupling.mean_moment[j], row);
            let in_walls = 0.5 * law.per_pressure * squares + closed;
            sum += in_walls / cells.len() as f64 + w.fluid.mean_pressure[bladder] * mixed;
        }
    }
    wet.bladder_length * sum
}

/// Energies of accumulators, [E60], and of compressed fluid in them, [E67].
pub fn in_vessels(system: &System, w: &Workspace<f64>) -> [f64; 2] {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return [0.0; 2];
    };
    let mut sums = [0.0; 2];
    for (one, &content) in fluid.accumulators.iter().zip(&w.fluid.accumulated) {
        let pressure = w.fluid.junction[one.junction];
        let energies = wet.vessel_energy(&one.law, content, pressure);
        sums = [sums[0] + energies[0], sums[1] + energies[1]];
    }
    sums
}

/// Volume change stored in each component of the network.
pub fn volumes(system: &System, w: &Workspace<f64>) -> Vec<f64> {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return vec![];
    };
    let mut volumes = vec![0.0; wet.network.components];
    for bladder in 0..fluid.bladders {
        let stored: f64 = w.fluid.area[fluid.cells_of(bladder)].iter().sum();
        volumes[wet.network.component_of_bladder[bladder]] += stored * fluid.ds;
    }
    for (one, volume) in fluid.accumulators.iter().zip(&w.fluid.accumulated) {
        volumes[one.component] += volume;
    }
    volumes
}
