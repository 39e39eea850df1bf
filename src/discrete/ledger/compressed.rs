//! Energy flow, dissipation and storage of a compressible fluid, [E56]; without compression `h = p`.

use std::ops::Range;

use super::fluid::imposed_rate;
use crate::discrete::{FluidMesh, System, Workspace};
use crate::model::{AreaLaw, Compression, Storage, Wet};

/// Area law of a bladder.
fn law_of(wet: &Wet, bladder: usize) -> &AreaLaw {
    wet.area_of(bladder)
}

/// Rates of a cell's pressure [Pa/s], of the pressure on its walls, and of its area [m^2/s], from the rate of its content.
fn rates(wet: &Wet, law: &AreaLaw, w: &Workspace<f64>, cell: usize, stored: f64, imposed: f64) -> [f64; 3] {
    let closing = wet.closing.as_ref();
    let contact = |area: f64, rate: f64| closing.map_or(0.0, |closing| closing.at(law, area).1 * rate);
    match (&wet.compression, closing) {
        (Some(compression), None) => {
            let state = [w.fluid.pressure[cell], w.fluid.swelling[cell]];
            let pressure = compression.pressure_rate(law, state, stored, imposed);
            [pressure, pressure, law.per_pressure * pressure + imposed]
        }
        (compression, _) => {
            let area = w.fluid.area_changes()[cell];
            let rate = match (compression, closing) {
                (Some(compression), Some(closing)) => {
                    let held = area - law.per_pressure * (w.fluid.pressure[cell] + closing.at(law, area).0);
                    let (_, [by_area, by_imposed]) = closing.missing(law, compression, area, held);
                    (stored - by_imposed * imposed) / by_area
                }
                _ => stored,
            };
            let in_walls = (rate - imposed) / law.per_pressure;
            [in_walls - contact(area, rate), in_walls, rate]
        }
    }
}

/// Rates of a cell in a bladder of a lumped network, from the rate of its pressure: of the pressure on its walls [Pa/s], and of its
/// content [m^2/s].
pub fn shared_rates(
    wet: &Wet,
    law: &AreaLaw,
    w: &Workspace<f64>,
    cell: usize,
    pressure: f64,
    imposed: f64,
) -> [f64; 2] {
    let a_p = law.per_pressure;
    let area = w.fluid.area_changes()[cell];
    let slope = wet.closing.as_ref().map_or(0.0, |closing| closing.at(law, area).1);
    let rate = (a_p * pressure + imposed) / (1.0 - a_p * slope);
    let stored = match &wet.compression {
        None => rate,
        Some(compression) => compression.content_rate(law, [w.fluid.pressure[cell], area], pressure, rate),
    };
    [pressure + slope * rate, stored]
}

/// Unknown pressures of lumped networks, and the derivatives of the networks' contents by these pressures, all else
/// constant [m^3/Pa].
pub fn lumped_slopes<'a>(system: &'a System, w: &'a Workspace<f64>) -> impl Iterator<Item = (usize, f64)> + 'a {
    let wet = system.model.wet.as_ref().zip(system.fluid.as_ref());
    wet.into_iter().flat_map(move |(wet, fluid)| {
        let unknowns = system.layout.network.lumped_pressure.iter().zip(&wet.lumped);
        unknowns.filter_map(move |(unknown, lumped)| {
            let taken = lumped.bladders.iter().map(|&bladder| {
                let [_, stored] = shared_rates(wet, law_of(wet, bladder), w, fluid.cells_of(bladder).start, 1.0, 0.0);
                stored * wet.bladder_length
            });
            unknown.map(|unknown| (unknown, taken.sum()))
        })
    })
}

/// Rate of a cell's pressure [Pa/s]; requires [`super::complete`].
pub fn pressure_rate(wet: &Wet, fluid: &FluidMesh, w: &Workspace<f64>, cell: usize) -> f64 {
    let bladder = cell / fluid.cells_per_bladder;
    match wet.storage[bladder] {
        Storage::Shared(lumped) => w.fluid.lumped_rate[lumped],
        Storage::Flowing | Storage::Kept => {
            let imposed = imposed_rate(wet, w, bladder);
            rates(wet, law_of(wet, bladder), w, cell, w.fluid.area_rate[cell], imposed)[0]
        }
        Storage::Absent => 0.0,
    }
}

/// Mean rate of the pressure on the walls of a bladder.
pub fn mean_pressure_rate(wet: &Wet, w: &Workspace<f64>, bladder: usize, cells: Range<usize>) -> f64 {
    if !wet.has(bladder) {
        return 0.0;
    }
    let (count, imposed) = (cells.len() as f64, imposed_rate(wet, w, bladder));
    let law = law_of(wet, bladder);
    if let Storage::Shared(lumped) = wet.storage[bladder] {
        return shared_rates(wet, law, w, cells.start, w.fluid.lumped_rate[lumped], imposed)[0];
    }
    let each = cells.map(|cell| rates(wet, law, w, cell, w.fluid.area_rate[cell], imposed)[1]);
    each.sum::<f64>() / count
}

/// Rate of a cell's area [m^2/s]; requires [`super::complete`].
pub fn area_rate(wet: &Wet, fluid: &FluidMesh, w: &Workspace<f64>, cell: usize) -> f64 {
    if wet.compression.is_none() {
        return w.fluid.area_rate[cell];
    }
    let bladder = cell / fluid.cells_per_bladder;
    let imposed = imposed_rate(wet, w, bladder);
    rates(wet, law_of(wet, bladder), w, cell, w.fluid.area_rate[cell], imposed)[2]
}

/// Dissipation between two neighboring cells [W].
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

/// Enthalpy `h` for a value of the potential Ψ.
fn behind(compression: &Compression, potential: f64) -> f64 {
    compression.enthalpy(compression.pressure_of_potential(potential))
}

/// Power of a flow into a cell through half of its resistance, `half`, or directly into a junction, and the dissipation in it [W].
pub fn fed(wet: &Wet, pressure: f64, half: f64, q: f64) -> [f64; 2] {
    match &wet.compression {
        None => [(pressure + half * q) * q, half * q * q],
        Some(compression) => {
            let outside = behind(compression, compression.potential(pressure) + half * q);
            [outside * q, (outside - compression.enthalpy(pressure)) * q]
        }
    }
}

/// Energy of compressed fluid in cells, [E56].
pub fn energy(system: &System, w: &Workspace<f64>) -> f64 {
    let (Some(wet), Some(fluid)) = (&system.model.wet, &system.fluid) else {
        return 0.0;
    };
    let Some(compression) = &wet.compression else {
        return 0.0;
    };
    let cells = w.fluid.pressure.iter().zip(&w.fluid.swelling).enumerate();
    let law = |cell: usize| law_of(wet, cell / fluid.cells_per_bladder);
    cells
        .map(|(cell, (&p, &area))| compression.energy(law(cell), p, area))
        .sum::<f64>()
        * fluid.ds
}
