//! What flow brings along and loses, and what fluid stores that is compressed, [E56]; without compression `h = p`.

use std::ops::Range;

use super::fluid::imposed_rate;
use crate::discrete::{FluidMesh, System, Workspace};
use crate::model::{Compression, Storage, Wet};

/// Rate of what a cell stores [m^2/s], from those of its pressure and of what is imposed on its area.
pub fn stored_rate(wet: &Wet, w: &Workspace<f64>, cell: usize, pressure_rate: f64, imposed_rate: f64) -> f64 {
    match &wet.compression {
        None => wet.area.per_pressure * pressure_rate + imposed_rate,
        Some(compression) => {
            let state = [w.fluid.pressure[cell], w.fluid.swelling[cell]];
            compression.content_rate(&wet.area, state, pressure_rate, imposed_rate)
        }
    }
}

/// Rate of a cell's pressure [Pa/s]; needs [`super::complete`].
pub fn pressure_rate(wet: &Wet, fluid: &FluidMesh, w: &Workspace<f64>, cell: usize) -> f64 {
    let bladder = cell / fluid.cells_per_bladder;
    match wet.storage[bladder] {
        Storage::Shared(lumped) => w.fluid.lumped_rate[lumped],
        Storage::Flowing | Storage::Kept => of_content(wet, w, cell, imposed_rate(wet, w, bladder)),
    }
}

/// Mean of the cells of a bladder that does not share its pressure.
pub fn mean_pressure_rate(wet: &Wet, w: &Workspace<f64>, bladder: usize, cells: Range<usize>) -> f64 {
    let (count, imposed) = (cells.len() as f64, imposed_rate(wet, w, bladder));
    match &wet.compression {
        None => (w.fluid.area_rate[cells].iter().sum::<f64>() / count - imposed) / wet.area.per_pressure,
        Some(_) => cells.map(|cell| of_content(wet, w, cell, imposed)).sum::<f64>() / count,
    }
}

fn of_content(wet: &Wet, w: &Workspace<f64>, cell: usize, imposed_rate: f64) -> f64 {
    match &wet.compression {
        None => (w.fluid.area_rate[cell] - imposed_rate) / wet.area.per_pressure,
        Some(compression) => {
            let state = [w.fluid.pressure[cell], w.fluid.swelling[cell]];
            compression.pressure_rate(&wet.area, state, w.fluid.area_rate[cell], imposed_rate)
        }
    }
}

/// Rate of a cell's area [m^2/s]; needs [`super::complete`].
pub fn area_rate(wet: &Wet, fluid: &FluidMesh, w: &Workspace<f64>, cell: usize) -> f64 {
    match &wet.compression {
        None => w.fluid.area_rate[cell],
        Some(_) => {
            let imposed = imposed_rate(wet, w, cell / fluid.cells_per_bladder);
            wet.area.per_pressure * pressure_rate(wet, fluid, w, cell) + imposed
        }
    }
}

/// Lost between two neighbouring cells [W].
pub fn lost_between(wet: &Wet, w: &Workspace<f64>, conductance: f64, [a, b]: [usize; 2]) -> f64 {
    let drop = w.fluid.pressure[a] - w.fluid.pressure[b];
    match &wet.compression {
        None => conductance * drop * drop,
        Some(compression) => {
            let flow = conductance * (w.fluid.potential[a] - w.fluid.potential[b]);
            flow * (compression.enthalpy(w.fluid.pressure[a]) - compression.enthalpy(w.fluid.pressure[b]))
        }
    }
}

/// `h` where Ψ has a value.
fn behind(compression: &Compression, potential: f64) -> f64 {
    compression.enthalpy(compression.pressure_of_potential(potential))
}

/// Power of a flow that enters a cell through half of it, resistance `half`, or a junction at once, and what is lost on the way [W].
pub fn fed(wet: &Wet, pressure: f64, half: f64, q: f64) -> [f64; 2] {
    match &wet.compression {
        None => [(pressure + half * q) * q, half * q * q],
        Some(compression) => {
            let outside = behind(compression, compression.potential(pressure) + half * q);
            [outside * q, (outside - compression.enthalpy(pressure)) * q]
        }
    }
}

/// Energy of compressed fluid, [E56].
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return 0.0;
    };
    let Some(compression) = &wet.compression else {
        return 0.0;
    };
    let cells = w.fluid.pressure.iter().zip(&w.fluid.swelling);
    let in_cells: f64 = cells.map(|(&p, &area)| compression.energy(p, area)).sum();
    let [_, in_vessels] = super::stored::in_vessels(system, w);
    in_cells * fluid.ds + in_vessels
}
